"""How the non-associated analysis ends."""

from __future__ import annotations

from enum import Enum

UNBOUNDED = (
    "the live load can grow without limit under associated flow, so that nothing bounds the load factor, and "
    "a solution without dilatancy need not exist: the blocks may jam"
)

BELOW_ZERO = (
    "the load factor is below zero: in this state the structure falls with the live load acting the other "
    "way, or under its dead loads before that; stability says whether it stands under them by itself"
)


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
    UNSETTLED = (
        "not converged: the residuals of the state shown are within the tolerance, but the load factor "
        "still changed as its path was followed on"
    )
    OTHER_WAY = (
        "no collapse under the live load was found: the structure stands under its dead loads, and the state "
        "shown solves the equations with the live load acting the other way"
    )
    NO_SOLUTION = (
        "no solution exists, which is proven: the live load does no work on anything that can flow at yield"
    )
    INTERRUPTED = "interrupted: the state shown is the best one reached until then, and no solution"
