"""Words that settings choose from; the command line offers them before it loads anything else."""

from __future__ import annotations

from enum import Enum
from typing import TypeVar

from limitblocks.errors import ModelError

E = TypeVar("E", bound=Enum)


class Turning(Enum):
    """What an interface twists about when bending limits its torsion, Eq. (30).

    The gradient of Eq. (30) at fixed N, M1, M2 is a twist about the centroid: it never does negative work.
    The paper's Table 5 turns about the point where N acts, (e1, e2) = (-M2/N, M1/N), and can.
    """

    CENTROID = "centroid"
    PRESSURE = "centre of pressure"


class Method(Enum):
    """How the non-associated analysis looks for a solution: one tracked path, or the outer loop alone."""

    PATH = "path"
    FIXED_POINT = "fixed point"


def turning_of(word: Turning | str) -> Turning:
    """Return the turning that `word` names, or raise ModelError."""
    return _member(Turning, "turning", word)


def method_of(word: Method | str) -> Method:
    """Return the method that `word` names, or raise ModelError."""
    return _member(Method, "method", word)


def _member(kind: type[E], setting: str, word: E | str) -> E:
    try:
        return kind(word)
    except ValueError:
        choices = " or ".join(repr(one.value) for one in kind)
        raise ModelError(f"{setting} is {word!r}, expected {choices}") from None
