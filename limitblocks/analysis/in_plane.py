"""The plane of a limit problem, found once; and solutions of its reduced problem in the whole one."""

from __future__ import annotations

from limitblocks.analysis.known import known
from limitblocks.problem import LimitProblem
from limitblocks.problem.plane import Planar, mirror_of, reduced


def in_plane(problem: LimitProblem, *, every_row: bool = False) -> Planar | None:
    """Return the problem reduced to the plane parallel to which everything acts; None where there is none.

    Parameters
    ----------
    problem : LimitProblem
        The whole problem.
    every_row : bool
        Keep rows that others imply: for margins, and for multipliers of every row.
    """
    mirror = known(problem, "mirror", lambda: mirror_of(problem))
    if mirror is None:
        return None
    return known(problem, ("plane", every_row), lambda: reduced(problem, mirror, every_row=every_row))
