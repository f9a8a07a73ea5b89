"""The programs of one form: compiled by cvxpy, solved by Clarabel itself."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from dataclasses import dataclass

import clarabel
import numpy as np
from scipy import sparse

from limitblocks.analysis.conic import Conic, compiled
from limitblocks.analysis.forms import Rates, Stresses
from limitblocks.analysis.programs import Program, Solver
from limitblocks.arrays import Array
from limitblocks.problem import State

log = logging.getLogger(__name__)

NOTHING = ("PrimalInfeasible", "DualInfeasible", "AlmostPrimalInfeasible", "AlmostDualInfeasible")
FIXED = {"verbose": False, "presolve_enable": False, "direct_solve_method": "qdldl"}


@dataclass(frozen=True, eq=False)
class Programs:
    """The program of one form and its answer."""

    form: Stresses | Rates

    def limit_state(self, solver: Solver) -> State:
        """The state of the largest load factor, NaN where there is none."""
        return self.form.limit_state(*self.solved(self.form.limit(), solver))

    def solved(self, one: Program, solver: Solver) -> tuple[Array, Array]:
        """Variables and duals of a program of the form, NaN where there is no solution."""
        program = compiled(one.problem)
        try:
            found = solution(program, {**self.form.equations, **solver.settings, **FIXED})
        except (ValueError, ArithmeticError) as error:
            log.info("CLARABEL: %s: %s", type(error).__name__, error)
            return np.full_like(program.c, np.nan), np.full_like(program.b, np.nan)
        v, w, status = np.array(found.x), np.array(found.z), str(found.status)
        log.info("CLARABEL: %s", status)
        return (np.full_like(v, np.nan), np.full_like(w, np.nan)) if status in NOTHING else (v, w)


def solution(program: Conic, settings: Mapping[str, object]) -> clarabel.DefaultSolution:
    """Return what Clarabel says of a program."""
    options, K, n = clarabel.DefaultSettings(), program.cones, len(program.c)
    for name, value in settings.items():
        if name != "accept_unknown":  # a word of cvxpy's
            setattr(options, name, value)
    cones = [clarabel.ZeroConeT(len(program.b) - K.height)]
    cones += [clarabel.NonnegativeConeT(K.linear)] * (K.linear > 0)
    cones += [cone for count, size in K.second_order for cone in [clarabel.SecondOrderConeT(size)] * count]
    W = sparse.csc_matrix((n, n)) if program.W is None else sparse.csc_matrix(sparse.diags_array(program.W))
    A = sparse.csc_matrix(program.A)
    return clarabel.DefaultSolver(W, program.c, A, program.b, cones, options).solve()
