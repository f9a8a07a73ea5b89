"""The solution that the bounds are proven from, by one accurate solve; of one half if it has a mirror."""

from __future__ import annotations

import numpy as np

from limitblocks.analysis.direct import Programs
from limitblocks.analysis.forms import Stresses, form_of
from limitblocks.analysis.in_plane import in_plane
from limitblocks.analysis.programs import DIRECT, PLANAR
from limitblocks.analysis.scales import with_rates_near_one
from limitblocks.problem import LimitProblem, State
from limitblocks.problem.plane import Planar

IN_HALF = " in one half"  # of a problem with a mirror plane


def programs_of(problem: LimitProblem) -> tuple[Programs, ...]:
    """Return the programs of a problem, reduced by its mirror if it has one: the later where the first fails.

    With Clarabel's own settings of its linear equations stresses take longest, and leave least.
    """
    plane = in_plane(problem)
    if plane is not None and plane.flat:
        return (Programs(Stresses(with_rates_near_one(plane.problem), planar=True)),)
    reduced = problem if plane is None else plane.problem
    first = form_of(reduced)
    return Programs(first), Programs(Stresses(first.problem, refined=True))


def limit_state(programs: Programs, plane: Planar | None) -> tuple[State, str] | None:
    """A solution of the whole problem by one of the programs of `programs_of`, and who found it."""
    solver, where = (DIRECT, IN_HALF * (plane is not None))
    if plane is not None and plane.flat:
        solver, where = PLANAR, " in the plane"
    state = programs.limit_state(solver)
    if not all(np.isfinite(part).all() for part in (state.load_factor, state.x, state.u, state.y)):
        return None
    state = programs.form.problem.in_problem(state)
    return (state if plane is None else plane.lifted(state)), solver.name + where


def in_units_of(programs: Programs, problem: LimitProblem, state: State) -> tuple[Programs, ...]:
    """Return the program in stresses in units of a state of the whole problem; none where they are so."""
    plane = in_plane(problem)
    measured = programs.form.problem.measured(state if plane is None else plane.averaged(state))
    return () if measured is None else (Programs(Stresses(measured, refined=True)),)
