"""What is known of a model already: an analysis solves no program twice.

Models and limit problems are frozen, so that an answer of theirs stays true. It is kept beside them, for as
long as they live: copies, also pickled ones, and changed models start without.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Any, TypeVar
from weakref import WeakKeyDictionary

Answer = TypeVar("Answer")

_KNOWN: WeakKeyDictionary[Hashable, dict[Hashable, Any]] = WeakKeyDictionary()


def known(of: Hashable, name: Hashable, solve: Callable[[], Answer]) -> Answer:
    """Return the answer `name` of a model or a problem, solved where it is asked for first.

    The answer must be frozen, and must not hold `of`. What is raised is not kept.
    """
    answers = _KNOWN.setdefault(of, {})
    if name not in answers:
        answers.setdefault(name, solve())  # two threads may solve, and get one answer
    answer: Answer = answers[name]
    return answer
