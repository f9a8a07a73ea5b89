"""Stresses strictly within yield that carry the dead loads: they ask for room, not for accuracy."""

from __future__ import annotations

import numpy as np

from limitblocks.analysis.in_plane import in_plane
from limitblocks.analysis.scales import scaled
from limitblocks.analysis.splitting import Splitting
from limitblocks.arrays import Array, read_only
from limitblocks.known import known
from limitblocks.problem import LimitProblem


def carried(problem: LimitProblem, splitting: Splitting | None = None) -> Array | None:
    """Return stresses strictly within yield that carry the dead loads, (s,); None where none were found.

    Parameters
    ----------
    problem : LimitProblem
        The whole problem.
    splitting : Splitting, optional
        Of the problem, reduced by its mirror if it has one, where it is at hand.
    """
    return known(problem, "stresses within yield", lambda: _carried(problem, splitting))


def _carried(problem: LimitProblem, splitting: Splitting | None) -> Array | None:
    plane = in_plane(problem)  # strictly within its rows is strictly within those that they imply
    splitting = splitting or Splitting(scaled(problem if plane is None else plane.problem))
    x, p = splitting.stresses(), splitting.p
    if x is None:
        return None
    x = p.stress * x if plane is None else np.asarray(plane.stresses @ (p.stress * x))
    with np.errstate(over="ignore", invalid="ignore"):  # friction 1e-300: nothing is within
        inside = problem.cones.margin(problem.F @ x + problem.g).min(initial=np.inf) > 0.0
    return read_only(x) if inside else None
