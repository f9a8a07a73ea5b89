"""The programs of the bounds, solved: in rates alone cvxpy compiles but one of them.

The program of the load factor, that of the dead loads and that of a mechanism that opens every joint have one
matrix, but for the row of the live load. The last two differ by what they compare with alone: one solver.
"""

from __future__ import annotations

import logging
from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property

import clarabel
import cvxpy as cp
import numpy as np
from scipy import sparse

from limitblocks.analysis.forms import Rates, Stresses
from limitblocks.analysis.programs import Program, Solution, Solver, solved
from limitblocks.arrays import Array
from limitblocks.problem import State

log = logging.getLogger(__name__)

NOTHING = ("PrimalInfeasible", "DualInfeasible", "AlmostPrimalInfeasible", "AlmostDualInfeasible")


class Compiled:
    """A program compiled by cvxpy, and the one without its equations, whose bounds of K may change."""

    def __init__(self, program: Program, numerics: Mapping[str, object]) -> None:
        data, _, _ = program.problem.get_problem_data(cp.CLARABEL)
        self.A, self.b, self.c = sparse.csc_matrix(data["A"]), data["b"], data["c"]
        self.equations, dims = data["dims"].zero, data["dims"]
        linear = [clarabel.NonnegativeConeT(dims.nonneg)] if dims.nonneg else []
        self.cones = linear + [clarabel.SecondOrderConeT(size) for size in dims.soc]
        self.numerics = dict(numerics)

    def solved(self, solver: Solver) -> Solution:
        """What Clarabel says of the variables, and of the duals of the equations and of the cones."""
        cones = [clarabel.ZeroConeT(self.equations), *self.cones]
        found = self._solver(self.A, self.b, cones, solver.settings).solve()
        solution = _solution(found)
        (z,) = solution.duals
        return replace(solution, duals=(z[: self.equations], z[self.equations :]))

    def exceeding(self, bounds: Array, solver: Solver) -> Solution:
        """The same without the equations, where the rows exceed `bounds` in K."""
        self._rows.update(b=-bounds, settings=self._options(self.numerics | solver.settings))
        return _solution(self._rows.solve())

    @cached_property
    def _rows(self) -> clarabel.DefaultSolver:
        rows = sparse.csc_matrix(self.A[self.equations :])
        return self._solver(rows, self.b[self.equations :], self.cones, {})

    def _solver(
        self, A: sparse.csc_matrix, b: Array, cones: list[object], settings: Mapping[str, object]
    ) -> clarabel.DefaultSolver:
        n, options = len(self.c), self._options(self.numerics | dict(settings))
        return clarabel.DefaultSolver(sparse.csc_matrix((n, n)), self.c, A, b, cones, options)

    @staticmethod
    def _options(settings: Mapping[str, object]) -> clarabel.DefaultSettings:
        options = clarabel.DefaultSettings()
        # other numbers may only come to a problem that was not presolved
        fixed = {"verbose": False, "presolve_enable": False, "direct_solve_method": "qdldl"}
        for name, value in (dict(settings) | fixed).items():
            if name != "accept_unknown":  # a word of cvxpy's
                setattr(options, name, value)
        return options


def _solution(found: clarabel.DefaultSolution) -> Solution:
    """NaN where there is no solution."""
    status, u, z = str(found.status), np.array(found.x), np.array(found.z)
    log.info("CLARABEL: %s", status)
    if status in NOTHING:
        u, z = np.full_like(u, np.nan), np.full_like(z, np.nan)
    return Solution("CLARABEL", status, (u,), (z,))


class Programs:
    """The three programs of one form."""

    def __init__(self, form: Stresses | Rates) -> None:
        self.form = form

    @cached_property
    def _compiled(self) -> Compiled | None:
        return Compiled(self.form.limit(), self.form.equations) if isinstance(self.form, Rates) else None

    def limit_state(self, solver: Solver) -> State:
        """The state of the largest load factor, NaN where there is none."""
        form = self.form
        if self._compiled is not None:
            return form.limit_state(self._compiled.solved(solver))
        return form.limit_state(solved(form.limit(), solver.having(form.equations)))

    def stresses(self, solver: Solver) -> Array:
        """Stresses that carry the dead loads."""
        form = self.form
        if self._compiled is not None and isinstance(form, Rates):
            return form.stresses(self._compiled.exceeding(np.zeros(len(form.kept)), solver))
        return form.stresses(solved(form.carrying(), solver.having(form.equations)))

    def mechanism(self, amount: Array, solver: Solver) -> tuple[Array, Array]:
        """Rates and multipliers of a mechanism that opens every joint by about `amount` (R,)."""
        form = self.form
        if self._compiled is not None and isinstance(form, Rates):
            return form.mechanism(self._compiled.exceeding(form.enough(amount), solver), amount)
        return form.mechanism(solved(form.opening(amount), solver.having(form.equations)), amount)
