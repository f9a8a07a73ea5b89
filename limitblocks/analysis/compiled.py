"""The programs of the bounds, solved: cvxpy compiles one of them, whose numbers then change.

The program of the load factor and that of a mechanism that opens every joint, whose dual are stresses under
the dead loads, have one matrix, but for the live load, which the second does without.
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
        data = self._data
        return self._made(data["A"], data["b"], data["c"], data["dims"].zero)

    @cached_property
    def _opener(self) -> clarabel.DefaultSolver:
        """Without the live load: the column of its factor, or the equation that it does work."""
        A, b, c, zero = (*(self._data[key] for key in ("A", "b", "c")), self._data["dims"].zero)
        if isinstance(self.form, Stresses):
            return self._made(A[:, 1:], b, c[1:], zero)
        return self._made(A[1:], b[1:], c, 0)

    def _made(self, A: Any, b: Array, c: Array, equations: int) -> clarabel.DefaultSolver:
        dims, n = self._data["dims"], len(c)
        cones = [clarabel.ZeroConeT(equations)] * (equations > 0)
        cones += [clarabel.NonnegativeConeT(dims.nonneg)] * (dims.nonneg > 0)
        cones += [clarabel.SecondOrderConeT(size) for size in dims.soc]
        nothing = sparse.csc_matrix((n, n))
        return clarabel.DefaultSolver(nothing, c, sparse.csc_matrix(A), b, cones, self._options({}))

    def _solved(self, amount: Array | None, solver: Solver) -> tuple[Array, Array]:
        """Variables and duals, NaN where there is no solution; without the live load for an `amount`."""
        try:
            own = self._solver if amount is None else self._opener
            changed = {} if amount is None else self.form.opening(amount)
            own.update(settings=self._options(solver.settings), **changed)
            found = own.solve()
        except (ValueError, ArithmeticError) as error:
            log.info("CLARABEL: %s: %s", type(error).__name__, error)
            m, n = self._data["A"].shape
            if amount is not None:
                m, n = (m, n - 1) if isinstance(self.form, Stresses) else (m - 1, n)
            return np.full(n, np.nan), np.full(m, np.nan)
        v, w, status = np.array(found.x), np.array(found.z), str(found.status)
        log.info("CLARABEL: %s", status)
        return (np.full_like(v, np.nan), np.full_like(w, np.nan)) if status in NOTHING else (v, w)

    def _options(self, settings: Mapping[str, object]) -> clarabel.DefaultSettings:
        options = clarabel.DefaultSettings()
        for name, value in {**self.form.equations, **settings, **FIXED}.items():
            if name != "accept_unknown":  # a word of cvxpy's
                setattr(options, name, value)
        return options
