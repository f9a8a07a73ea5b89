"""Stresses strictly within yield that carry the dead loads: they ask for room, not for accuracy.

A few iterations of an interior-point method that stops as soon as it is nearly feasible give stresses far
within yield; equilibrium is then made exact.
"""

from __future__ import annotations

import numpy as np

from limitblocks.analysis.forms import form_of
from limitblocks.analysis.in_plane import in_plane
from limitblocks.analysis.known import known
from limitblocks.analysis.programs import ROUGH, solved
from limitblocks.analysis.scales import balanced, scaled
from limitblocks.arrays import Array, read_only
from limitblocks.problem import LimitProblem


def carried(problem: LimitProblem) -> Array | None:
    """Return stresses strictly within yield that carry the dead loads, (s,); None where none were found."""
    return known(problem, "stresses within yield", lambda: _carried(problem))


def _carried(problem: LimitProblem) -> Array | None:
    plane = in_plane(problem, every_row=True)
    form = form_of(scaled(problem if plane is None else plane.problem))
    p = form.problem
    x = form.stresses(solved(form.carrying(), ROUGH.having(form.equations)))
    if not np.isfinite(x).all():
        return None
    x = p.stress * balanced(p, p.dead, x)
    x = x if plane is None else np.asarray(plane.stresses @ x)
    inside = problem.cones.margin(problem.F @ x + problem.g).min(initial=np.inf) > 0.0
    return read_only(x) if inside else None
