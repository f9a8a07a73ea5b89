"""Stresses strictly within yield that carry the dead loads: they ask for room, not for accuracy.

A few iterations of an interior-point method that stops as soon as it is nearly feasible give stresses far
within yield; equilibrium is then made exact.
"""

from __future__ import annotations

import numpy as np

from limitblocks.analysis.compiled import Programs
from limitblocks.analysis.in_plane import in_plane
from limitblocks.analysis.known import known
from limitblocks.analysis.limit_state import programs_of
from limitblocks.analysis.programs import NEARLY, ROUGH
from limitblocks.analysis.scales import balanced
from limitblocks.arrays import Array, read_only
from limitblocks.problem import LimitProblem


def carried(problem: LimitProblem, programs: Programs | None = None) -> Array | None:
    """Return stresses strictly within yield that carry the dead loads, (s,); None where none were found.

    Parameters
    ----------
    problem : LimitProblem
        The whole problem.
    programs : Programs, optional
        Of :func:`~limitblocks.analysis.limit_state.programs_of`, where they are at hand.
    """
    return known(
        problem, "stresses within yield", lambda: _carried(problem, programs or programs_of(problem))
    )


def _carried(problem: LimitProblem, programs: Programs) -> Array | None:
    plane = in_plane(problem)  # strictly within its rows is strictly within those that they imply
    p = programs.form.problem
    for solver in (ROUGH, NEARLY):  # from 10,000 blocks the first stops too early
        x, _, _ = programs.opening(np.zeros(len(p.g)), solver)
        if not np.isfinite(x).all():
            return None
        x = p.stress * balanced(p, p.dead, x)
        x = x if plane is None else np.asarray(plane.stresses @ x)
        with np.errstate(over="ignore", invalid="ignore"):  # friction 1e-300: nothing is within
            inside = problem.cones.margin(problem.F @ x + problem.g).min(initial=np.inf) > 0.0
        if inside:
            return read_only(x)
    return None
