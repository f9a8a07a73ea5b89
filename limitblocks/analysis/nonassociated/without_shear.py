"""The lower end of the bracket: the load factor of stresses without shear, by one linear program.

No solution lies below the load factor of a stress state within yield that no sliding feels (Drucker 1954);
docs/nonassociated.md, "The bracket", has the proof.
"""

from __future__ import annotations

from dataclasses import replace

import cvxpy as cp
import numpy as np

from limitblocks.analysis.programs import Program, Solution, Solver, in_cone, solved, solvers
from limitblocks.arrays import Indices
from limitblocks.evidence.residuals import TOLERANCE, Residuals, static_residuals
from limitblocks.problem import LimitProblem

FALLS = "without friction the dead loads do not stand, and nothing is known below"
UNSOLVED = "the load factor without friction was not to be had"


def load_factor_without_shear(p: LimitProblem, limited: bool) -> tuple[float, str]:
    """Return the largest load factor of stresses without shear and torsion, or NaN and why there is none.

    Parameters
    ----------
    p : LimitProblem
        The model's.
    limited : bool
        Whether the associated load factor is finite. If not, stresses without shear that balance the live
        load alone, however large, make this one infinite, too.
    """
    alone = replace(p, dead=np.zeros_like(p.dead), g=np.zeros_like(p.g))
    if not limited and _best(alone, 1.0)[0] > 0.5:  # such stresses grow with their load: all of it, or none
        return np.inf, ""
    load_factor, why = _best(p, None)
    return load_factor / p.units.live, why


def _best(p: LimitProblem, most: float | None) -> tuple[float, str]:
    """Largest load factor, at most `most`, of stresses within the tolerance, or NaN and why there is none."""
    for solver in solvers(bool(p.cones.second_order)):
        found = _solved(p, most, solver)
        if "infeasible" in found.status:
            return np.nan, FALLS
        load_factor, x = float(found.values[0]), np.zeros(p.C.shape[0])
        x[_unsheared(p)] = found.values[1]
        if Residuals(static_residuals(p, load_factor, x)).worst.value <= TOLERANCE:
            return load_factor, ""
    return np.nan, UNSOLVED


def _unsheared(p: LimitProblem) -> Indices:
    """Stresses that do no work on what flows otherwise than normal to yield."""
    turned = np.bincount(p.cones.member, weights=abs(p.F - p.G).sum(axis=1)) > 0.0
    return np.flatnonzero(abs(p.G)[turned[p.cones.member]].sum(axis=0) == 0.0)


def _solved(p: LimitProblem, most: float | None, solver: Solver) -> Solution:
    """Load factor and stresses of the program."""
    kept = _unsheared(p)
    C, F = p.C[kept], p.F[:, kept]
    load_factor, x = cp.Variable(), cp.Variable(len(kept))
    rows, cones = F @ x + p.g, p.cones
    tails = np.setdiff1d(np.arange(cones.height), cones.heads)
    straight = not (F[tails].nnz or p.g[tails].any())  # all cones are left without a tail
    inside = [rows[cones.heads] >= 0] if straight else in_cone(rows, cones)
    capped = [] if most is None else [load_factor <= most]
    balance = C.T @ x == p.dead + load_factor * p.live
    return solved(
        Program(cp.Problem(cp.Maximize(load_factor), [balance, *inside, *capped]), (load_factor, x)), solver
    )
