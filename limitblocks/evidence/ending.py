"""How the non-associated analysis goes and ends."""

from __future__ import annotations

from enum import Enum

from limitblocks.errors import ModelError


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


class Status(Enum):
    """How an analysis ended; the text is for the user."""

    CONVERGED = "converged: every residual is within the tolerance"
    NEARBY = "not converged, but exact for a model as near as was asked for, as its backward error says"
    OUT_OF_STEPS = (
        "not converged: no state within the tolerance was found; the one shown is the best one reached"
    )
    GIVES_POWER = (
        "not converged: the state shown satisfies all equations, but interfaces give power in it, so that "
        "it is no collapse"
    )
    NO_SOLUTION = (
        "no solution exists, which is proven: the live load does no work on anything that can flow at yield"
    )
    INTERRUPTED = "interrupted: the state shown is the best one reached until then, and no solution"
