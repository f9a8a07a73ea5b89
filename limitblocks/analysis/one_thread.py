"""Analyses in one thread of the linear algebra: their products are too small for several to pay.

Threads of BLAS that wait for work spin meanwhile, and the sums they form differ in the last digits.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache, wraps
from typing import Any, ParamSpec, TypeVar

import scipy.sparse.linalg  # noqa: F401 - loads every BLAS that the controller is to find

from limitblocks.model import checked_model

P = ParamSpec("P")
R = TypeVar("R")


@lru_cache(maxsize=1)
def _controller() -> Any:
    """The libraries with threads that are loaded; found once, as that takes 15 ms."""
    from threadpoolctl import ThreadpoolController

    return ThreadpoolController()


def one_thread(analysis: Callable[P, R]) -> Callable[P, R]:
    """Return the analysis of a model in one thread of BLAS; their number is as before when it ends."""

    @wraps(analysis)
    def alone(*args: P.args, **kwargs: P.kwargs) -> R:
        checked_model(args[0] if args else kwargs.get("model"))
        with _controller().limit(limits=1, user_api="blas"):
            return analysis(*args, **kwargs)

    return alone
