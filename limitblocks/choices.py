"""Words that settings choose from; the command line offers them before it loads anything else."""

from __future__ import annotations

from enum import Enum

from limitblocks.errors import ModelError


class Turning(Enum):
    """What an interface twists about when bending limits its torsion, Eq. (30).

    The gradient of Eq. (30) at fixed N, M1, M2 is a twist about the centroid: it never does negative work.
    The paper's Table 5 turns about the point where N acts, (e1, e2) = (-M2/N, M1/N), and can.
    """

    CENTROID = "centroid"
    PRESSURE = "centre of pressure"


def turning_of(word: Turning | str) -> Turning:
    """Return the turning that `word` names, or raise ModelError."""
    try:
        return Turning(word)
    except ValueError:
        choices = " or ".join(repr(turning.value) for turning in Turning)
        raise ModelError(f"turning is {word!r}, expected {choices}") from None


class Method(Enum):
    """How the non-associated analysis looks for a solution: one tracked path, or the outer loop alone."""

    PATH = "path"
    FIXED_POINT = "fixed point"


def method_of(word: Method | str) -> Method:
    """Return the method that `word` names, or raise ModelError."""
    try:
        return Method(word)
    except ValueError:
        choices = " or ".join(repr(method.value) for method in Method)
        raise ModelError(f"method is {word!r}, expected {choices}") from None
