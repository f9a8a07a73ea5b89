"""The solution that the bounds are proven from, by one accurate solve; of one half if it has a mirror."""

from __future__ import annotations

import numpy as np

from limitblocks.analysis.compiled import Programs
from limitblocks.analysis.forms import Stresses
from limitblocks.analysis.programs import DIRECT, PLANAR, solved
from limitblocks.analysis.scales import scaled
from limitblocks.problem import LimitProblem, State, power_of_two
from limitblocks.problem.plane import Planar

IN_HALF = " in one half"  # of a problem with a mirror plane


def limit_state(programs: Programs, plane: Planar | None) -> tuple[State, str] | None:
    """A solution of the whole problem, by its programs or those of its plane or half, and who found it."""
    if plane is None or not plane.flat:
        state, p, name = programs.limit_state(DIRECT), programs.form.problem, DIRECT.name
        name += IN_HALF * (plane is not None)
    else:
        form, name = _planar(plane.problem), f"{PLANAR.name} in the plane"
        state, p = form.limit_state(solved(form.limit(), PLANAR)), form.problem
    if not all(np.isfinite(part).all() for part in (state.load_factor, state.x, state.u, state.y)):
        return None
    state = p.in_problem(state)
    return (state if plane is None else plane.lifted(state)), name


def _planar(problem: LimitProblem) -> Stresses:
    """The static program with rates near one, not over the number of blocks: they lose fewer digits."""
    return Stresses(scaled(problem, float(power_of_two(1.0 / len(problem.blocks)))))
