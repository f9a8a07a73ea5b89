"""The lower end of the bracket: the load factor of stresses without shear, by one convex program.

No solution lies below the load factor of a stress state within yield that no sliding feels (Drucker 1954);
docs/nonassociated.md, "The bracket", has the proof.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from scipy import sparse

from limitblocks.analysis.conic import Conic
from limitblocks.analysis.direct import FIXED, solution
from limitblocks.analysis.programs import DIRECT
from limitblocks.arrays import Array, Indices
from limitblocks.evidence.residuals import TOLERANCE, Residuals, static_residuals
from limitblocks.problem import Cones, LimitProblem

FALLS = "without friction the dead loads do not stand, and nothing is known below"
UNSOLVED = "the load factor without friction was not to be had"
TIGHT = {"tol_infeas_abs": 1e-10, "tol_infeas_rel": 1e-10}  # of proofs that nothing meets a program
ROUNDING = 1e-12  # of the dead loads: a live load below it is none
CERTIFIED = 1e-7  # largest violation of a mechanism of the dead loads, over their power, that proves a fall


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
    kept = _unsheared(p)
    program = _program(p, kept, most)
    found = solution(program, DIRECT.settings | FIXED | TIGHT)
    if not np.isfinite([*found.x, *found.z]).all():  # it may run away where nothing is strictly within yield
        return np.nan, UNSOLVED
    if _nothing_meets(program, np.array(found.z)):
        return np.nan, FALLS
    load_factor, x = found.x[0], np.zeros(p.C.shape[0])
    if abs(load_factor) * np.linalg.norm(p.live) <= ROUNDING * np.linalg.norm(p.dead):
        load_factor = 0.0  # a block without weight has nothing else to measure what it does not balance by
    x[kept] = found.x[1:]
    good = Residuals(static_residuals(p, load_factor, x)).worst.value <= TOLERANCE
    return (load_factor, "") if good else (np.nan, UNSOLVED)


def _nothing_meets(program: Conic, z: Array) -> bool:
    """Whether z proves that no stresses do (Farkas): A^T z = 0 and z in K, but b . z < 0."""
    gained, cones = -program.b @ z, program.cones
    outside = -cones.margin(z[len(z) - cones.height :]).min()
    return bool(gained > 0.0 and max(abs(program.A.T @ z).max(), outside) <= CERTIFIED * gained)


def _unsheared(p: LimitProblem) -> Indices:
    """Stresses that do no work on what flows otherwise than normal to yield."""
    turned = np.bincount(p.cones.member, weights=abs(p.F - p.G).sum(axis=1)) > 0.0
    return np.flatnonzero(abs(p.G)[turned[p.cones.member]].sum(axis=0) == 0.0)


def _program(p: LimitProblem, kept: Indices, most: float | None) -> Conic:
    """The program of the load factor and the stresses that are kept."""
    F, g, cones = p.F[:, kept], p.g, p.cones
    tails = np.setdiff1d(np.arange(cones.height), cones.heads)
    if not (F[tails].nnz or g[tails].any()):  # all cones are left without a tail
        F, g, cones = F[cones.heads], g[cones.heads], Cones(cones.degree)
    capped = [] if most is None else [most]
    first = sparse.csr_array(np.ones((len(capped), 1)))
    blocks: list[list[Any]] = [[-p.live[:, None], p.C[kept].T], [first, None], [None, -F]]
    A = sparse.csc_array(sparse.block_array(blocks))
    cones = replace(cones, linear=cones.linear + len(capped))
    return Conic(-np.eye(1, A.shape[1])[0], A, np.concatenate([p.dead, capped, g]), cones)
