"""THE flow rule: the plastic potential of a limit problem at a stress state, Tables 3, 5 and 6."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from numbers import Real

import numpy as np
import numpy.typing as npt
from scipy import sparse

from limitblocks.arrays import Array
from limitblocks.choices import Turning
from limitblocks.errors import ModelError
from limitblocks.problem.limit_problem import LimitProblem

FARTHEST = 1.5  # of the half sides: states within the yield set stay below 1, iterates may stray
ASSOCIATED = np.inf  # a dilatancy: at least the friction of every interface


def checked_dilatancy(problem: LimitProblem, dilatancy: float) -> float:
    """Return `dilatancy` if it is 0 to the least friction coefficient, else raise ModelError."""
    frictional = problem.friction[problem.friction > 0.0]  # ties and dowels have none
    least = float(frictional.min(initial=np.inf)) if len(frictional) else 0.0
    if not (isinstance(dilatancy, Real) and 0.0 <= dilatancy <= least):
        raise ModelError(
            f"dilatancy is {dilatancy!r}, expected 0 to the least friction coefficient, {least:g}"
        )
    return float(dilatancy)


@dataclass(frozen=True, eq=False)
class Flow:
    """The flow rule C u = -G(x)^T y, y in K*, of a limit problem.

    Parameters
    ----------
    problem : LimitProblem
        The structure.
    dilatancy : float
        Tangent of the dilatancy angle of sliding and twisting: 0 (Tables 3 and 5), or up to the friction
        coefficient of an interface, from where its flow is associated (G = F). In between the two are
        mixed in proportion.
    turning : Turning
        What twisting under bending turns about.
    softening : float
        The epsilon of Table 5, M / (N - epsilon), over the force of the interface: the quotient is noise
        where N is near zero.
    """

    problem: LimitProblem
    dilatancy: float = 0.0
    turning: Turning = Turning.CENTROID
    softening: float = 1e-12

    @cached_property
    def share(self) -> Array:
        """Dilatancy over friction, at most 1, shape (m,): 0 zero dilatancy, 1 associated."""
        friction = self.problem.friction
        share = np.minimum(self.dilatancy, friction) / np.where(friction > 0.0, friction, 1.0)
        return np.asarray(np.where(friction > 0.0, share, 1.0))

    @property
    def associated(self) -> bool:
        """Whether the flow of every row is its gradient."""
        return bool((self.share == 1.0).all())

    @cached_property
    def pivot(self) -> Array:
        """Normal rotation rate per unit multiplier that a row turns about (e1, e2), shape (R,)."""
        if self.turning is Turning.CENTROID:
            return np.zeros(len(self.problem.pivot))
        return np.asarray(self.problem.pivot * (1.0 - self.share[self.problem.row_interface]))

    @cached_property
    def constant(self) -> bool:
        """Whether G is the same at every state."""
        return not self.pivot.any()

    @property
    def dissipative(self) -> bool:
        """Whether no solution can lie below the associated load factor without friction.

        Twists about the centroid only take up power; docs/nonassociated.md, "The bracket", has the proof.
        Table 5 can give power.
        """
        return self.constant

    @cached_property
    def _centroid(self) -> sparse.csr_array:
        """G of a twist about the centroid."""
        p = self.problem
        if self.associated or not self.share.any():
            return p.F if self.associated else p.G
        share = sparse.diags_array(self.share[p.row_interface])
        return sparse.csr_array(p.G + share @ (p.F - p.G))

    @cached_property
    def _transposed(self) -> sparse.csc_array:
        return self._centroid.T

    def strains(self, x: Array, y: Array) -> Array:
        """Return G(x)^T y: the strain rates of multipliers y (R,), with the other sign, shape (s,)."""
        return np.asarray((self._transposed if self.constant else self.matrix(x).T) @ y)

    def matrix(self, x: Array) -> sparse.csr_array:
        """Return G at the stresses x, shape (R, s)."""
        if self.constant:
            return self._centroid
        p = self.problem
        rows = np.flatnonzero(self.pivot)
        k, turn = p.row_interface[rows], self.pivot[rows]
        _, M1, M2, N = self._held(x)
        farthest = FARTHEST * p.half_sides
        e1, e2 = np.clip(np.stack([-M2 / N, M1 / N], axis=1), -farthest, farthest)[k].T
        entries = np.concatenate([-turn * e2, turn * e1])  # ds = dthn (e2, -e1), Table 5
        places = np.concatenate([rows, rows]), np.concatenate([6 * k, 6 * k + 1])
        shape = (len(p.pivot), p.resultants.shape[0])
        tangential = sparse.coo_array((entries, places), shape=shape).tocsr()
        return sparse.csr_array(self._centroid + tangential @ p.resultants)

    def derivative(self, x: Array, y: Array) -> sparse.csr_array:
        """Return the derivative of -G(x)^T y with respect to x at fixed y, shape (s, s)."""
        p = self.problem
        m, B = len(p.interfaces), p.resultants
        if self.constant:
            return sparse.csr_array((B.shape[1], B.shape[1]))
        spin = np.bincount(p.row_interface, weights=self.pivot * y, minlength=m)
        pressed, M1, M2, N = self._held(x)
        within = np.abs(np.stack([M2, M1], axis=1) / N[:, None]) < FARTHEST * p.half_sides
        spin2, spin1 = (spin[:, None] * within).T  # e1 holds M2, and moves V2
        slope1, slope2 = -spin1 * M1 * pressed / N**2, -spin2 * M2 * pressed / N**2
        entries = np.concatenate([spin1 / N, slope1, spin2 / N, slope2])
        V1, V2, n, m1, m2, _ = np.arange(6 * m).reshape(m, 6).T
        places = np.concatenate([V1, V1, V2, V2]), np.concatenate([m1, n, m2, n])
        derivative = sparse.coo_array((entries, places), shape=(6 * m, 6 * m)).tocsr()
        return sparse.csr_array(B.T @ derivative @ B)

    def _held(self, x: Array) -> tuple[npt.NDArray[np.bool_], Array, Array, Array]:
        """Whether N < 0, M1, M2, and N - epsilon < 0 of each interface."""
        Q = (self.problem.resultants @ x).reshape(-1, 6)
        pressed = Q[:, 2] < 0.0
        return pressed, Q[:, 3], Q[:, 4], np.minimum(Q[:, 2], 0.0) - self.softening

    def dissipation(self, x: Array, y: Array) -> Array:
        """Return the power -x . G(x)^T y that each interface takes up, shape (m,); negative: it gives."""
        power = -x * self.strains(x, y)
        taken = np.zeros(len(self.problem.ends))
        np.add.at(taken, self.problem.stress_interface, power)
        return taken
