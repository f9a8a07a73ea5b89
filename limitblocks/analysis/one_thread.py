"""Analyses in one thread of the linear algebra: their products are too small for several to pay.

Threads of BLAS that wait for work spin meanwhile, and the sums they form differ in the last digits.
Their number is most often one for the whole process, so that one analysis at a time changes it and sets
it back, in its own thread: of two that overlap, each would save what the other has set.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache, wraps
from threading import Lock
from typing import Any, ParamSpec, TypeVar

import scipy.sparse.linalg  # noqa: F401 - loads every BLAS that the controller is to find

from limitblocks.model import checked_model

P = ParamSpec("P")
R = TypeVar("R")

_LIMIT = Lock()  # of the process: held by the analysis that has set the number of threads


@lru_cache(maxsize=1)
def _controller() -> Any:
    """The libraries with threads that are loaded; found once, as that takes 15 ms."""
    from threadpoolctl import ThreadpoolController

    return ThreadpoolController()


def one_thread(analysis: Callable[P, R]) -> Callable[P, R]:
    """Return the analysis in one thread of BLAS; the number of threads is as before when it ends."""

    @wraps(analysis)
    def alone(*args: P.args, **kwargs: P.kwargs) -> R:
        if args:
            checked_model(args[0])
        if not _LIMIT.acquire(blocking=False):  # within another analysis, or beside one
            return analysis(*args, **kwargs)
        try:
            with _controller().limit(limits=1, user_api="blas"):
                return analysis(*args, **kwargs)
        finally:
            _LIMIT.release()

    return alone
