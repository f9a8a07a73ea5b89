"""The program of the load factor in one form: compiled by cvxpy, solved by Clarabel itself."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from dataclasses import dataclass

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
FIXED = {"verbose": False, "presolve_enable": False, "direct_solve_method": "qdldl"}


@dataclass(frozen=True, eq=False)
class Programs:
    """The program of one form: the least c.v with b - A v in K, zero in its first rows."""

    form: Stresses | Rates

    def limit_state(self, solver: Solver) -> State:
        """The state of the largest load factor, NaN where there is none."""
        return self.form.limit_state(*self._solved(solver))

    def _solved(self, solver: Solver) -> tuple[Array, Array]:
        """Variables and duals, NaN where there is no solution."""
        data, _, _ = self.form.limit().problem.get_problem_data(cp.CLARABEL)
        dims, A, b, c = data["dims"], sparse.csc_matrix(data["A"]), data["b"], data["c"]
        cones = [clarabel.ZeroConeT(dims.zero)] * (dims.zero > 0)
        cones += [clarabel.NonnegativeConeT(dims.nonneg)] * (dims.nonneg > 0)
        cones += [clarabel.SecondOrderConeT(size) for size in dims.soc]
        nothing, options = sparse.csc_matrix((len(c), len(c))), self._options(solver.settings)
        try:
            found = clarabel.DefaultSolver(nothing, c, A, b, cones, options).solve()
        except (ValueError, ArithmeticError) as error:
            log.info("CLARABEL: %s: %s", type(error).__name__, error)
            return np.full(len(c), np.nan), np.full(len(b), np.nan)
        v, w, status = np.array(found.x), np.array(found.z), str(found.status)
        log.info("CLARABEL: %s", status)
        return (np.full_like(v, np.nan), np.full_like(w, np.nan)) if status in NOTHING else (v, w)

    def _options(self, settings: Mapping[str, object]) -> clarabel.DefaultSettings:
        options = clarabel.DefaultSettings()
        for name, value in {**self.form.equations, **settings, **FIXED}.items():
            if name != "accept_unknown":  # a word of cvxpy's
                setattr(options, name, value)
        return options
