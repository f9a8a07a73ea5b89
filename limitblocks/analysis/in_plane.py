"""The limit problem reduced by its mirror plane."""

from __future__ import annotations

from limitblocks.known import known
from limitblocks.problem import LimitProblem
from limitblocks.problem.plane import Choice, Planar, mirror_of, reduced


def in_plane(problem: LimitProblem, choice: Choice = Choice.FEW) -> Planar | None:
    """Return the problem reduced by its mirror plane, to it or to one half; None where there is none.

    Parameters
    ----------
    problem : LimitProblem
        The whole problem.
    choice : Choice
        FEW rows serve the associated flow, FLOWING ones any, EVERY one margins.
    """
    mirror = mirror_of(problem)
    if mirror is None:
        return None
    return known(problem, ("plane", choice), lambda: reduced(problem, mirror, choice))
