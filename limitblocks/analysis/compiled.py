"""The programs of the bounds, solved: cvxpy compiles one of them, whose numbers then change in one solver.

The program of the load factor and that of a mechanism that opens every joint, whose dual are stresses under
the dead loads, have one matrix, but for the entries of the live load, which the second does without.
"""

from __future__ import annotations

import logging
from collections.abc import Mapping
from functools import cached_property
from typing import Any

import clarabel
import cvxpy as cp
import numpy as np
from scipy import sparse

from limitblocks.analysis.forms import Rates, Stresses
from limitblocks.analysis.programs import Solver
from limitblocks.arrays import Array
from limitblocks.problem import State

log = logging.getLogger(__name__)

NOTHING = ("PrimalInfeasible", "DualInfeasible", "AlmostPrimalInfeasible", "AlmostDualInfeasible")
# other numbers may only come to a problem that was not presolved
FIXED = {"verbose": False, "presolve_enable": False, "direct_solve_method": "qdldl"}


class Programs:
    """Both programs of one form: the least c.v with b - A v in K, zero in its first rows."""

    def __init__(self, form: Stresses | Rates) -> None:
        self.form = form

    def limit_state(self, solver: Solver) -> State:
        """The state of the largest load factor, NaN where there is none."""
        return self.form.limit_state(*self._solved(None, solver))

    def opening(self, amount: Array, solver: Solver) -> tuple[Array, Array, Array]:
        """Stresses within yield that carry the dead loads; rates and multipliers that open every joint.

        By at least `amount` (R,), at the least power; NaN where the solver finds none.
        """
        return self.form.opened(*self._solved(amount, solver), amount)

    @cached_property
    def _data(self) -> dict[str, Any]:
        data, _, _ = self.form.limit().problem.get_problem_data(cp.CLARABEL)
        return {**data, "A": sparse.csc_matrix(data["A"])}

    @cached_property
    def _solver(self) -> clarabel.DefaultSolver:
        A, b, c, dims = (self._data[key] for key in ("A", "b", "c", "dims"))
        cones = [clarabel.ZeroConeT(dims.zero)] + [clarabel.NonnegativeConeT(dims.nonneg)] * (dims.nonneg > 0)
        cones += [clarabel.SecondOrderConeT(size) for size in dims.soc]
        n = len(c)
        return clarabel.DefaultSolver(sparse.csc_matrix((n, n)), c, A, b, cones, self._options({}))

    def _solved(self, amount: Array | None, solver: Solver) -> tuple[Array, Array]:
        """Variables and duals, NaN where there is no solution; without the live load for an `amount`."""
        data, form = self._data, self.form
        A, b, c = data["A"], data["b"], data["c"]
        entries = A.data
        if amount is not None:
            entries = np.where(form.of_live(A), 0.0, entries)
            b, c = form.opening(b, c, amount)
        try:
            self._solver.update(A=entries, b=b, q=c, settings=self._options(solver.settings))
            found = self._solver.solve()
            v, w, status = np.array(found.x), np.array(found.z), str(found.status)
        except (ValueError, ArithmeticError) as error:
            v, w, status = c, b, f"{type(error).__name__}: {error}"
        log.info("CLARABEL: %s", status)
        if status in NOTHING or ":" in status:
            return np.full_like(c, np.nan), np.full_like(b, np.nan)
        return v, w

    def _options(self, settings: Mapping[str, object]) -> clarabel.DefaultSettings:
        options = clarabel.DefaultSettings()
        for name, value in {**self.form.equations, **settings, **FIXED}.items():
            if name != "accept_unknown":  # a word of cvxpy's
                setattr(options, name, value)
        return options
