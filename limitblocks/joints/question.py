"""The yield rows of one interface as closed forms: margins, the way along a direction, flow directions."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse

from limitblocks.arrays import Array
from limitblocks.joints.base import YieldRows
from limitblocks.problem import Cones, LimitProblem, Mode, Units

OUTSIDE = 1e-9  # of the size of a stress state: violations of a yield function below it are rounding
TINY = np.finfo(float).tiny
FLAT = 1e-13  # of a row's size: change along a direction below it is rounding


@dataclass(frozen=True)
class Question:
    """Yield rows F x + g of one interface, in the units of stress resultants `unit` (6,), N and N m."""

    rows: YieldRows
    unit: Array

    @cached_property
    def cones(self) -> Cones:
        """The cone of the rows."""
        return Cones.of_sizes(self.rows.linear, self.rows.cones)

    @cached_property
    def problem(self) -> LimitProblem:
        """The rows as a limit problem of one interface, without loads."""
        rows, B = self.rows, sparse.csr_array(self.rows.resultants[0])
        F, G = sparse.csr_array(rows.F[0]), sparse.csr_array(rows.G[0])
        one, none = np.ones(1), np.zeros(6)
        return LimitProblem(
            C=B.T.tocsr(),
            dead=none,
            live=none,
            F=F,
            g=rows.g[0],
            G=G,
            cones=self.cones,
            pivot=rows.pivot[0],
            half_sides=rows.half_sides,
            resultants=B,
            compliance=np.ones(B.shape[1]),
            ends=np.array([[-1, 0]]),
            row_interface=np.zeros(len(rows.modes), dtype=np.int64),
            row_mode=np.array([Mode(mode) for mode in rows.modes], dtype=object),
            friction=np.array([rows.friction]),
            units=Units(one, one, one, one, 1.0, np.ones(len(rows.modes))),
            blocks=("j",),
            interfaces=("i-j",),
            centroids=np.zeros((1, 3)),
        )

    @cached_property
    def modes(self) -> tuple[Mode, ...]:
        """Failure mode of each linear row and of each cone."""
        return tuple(Mode(self.rows.modes[k]) for k in self.cones.heads.tolist())

    def stresses(self, Q: Array) -> Array:
        """Generalised stresses (s,) of stress resultants Q; NaN where the interface cannot have such Q."""
        R = self.rows.resultants[0]
        x = R.T @ (Q / self.unit)
        return x if np.allclose(R @ x, Q / self.unit, rtol=0.0, atol=OUTSIDE) else np.full_like(x, np.nan)

    def values(self, x: Array) -> Array:
        """F x + g, shape (r,)."""
        return np.asarray(self.rows.F[0] @ x + self.rows.g[0])

    def margins(self, x: Array) -> Array:
        """Value of each linear row and t - ||z|| of each cone (t, z), negative outside."""
        return self.cones.margin(self.values(x))

    def longest(self, x: Array, dx: Array) -> float:
        """Largest t with x + t dx within the yield set, in which x is; infinite if there is none."""
        F = self.rows.F[0]
        slope = F @ dx
        slope[np.abs(slope) <= FLAT * (np.abs(F) @ np.abs(dx))] = 0.0
        return self.cones.longest(self.values(x), slope)

    def flow(self, G: Array, x: Array) -> Array:
        """Flow directions (k, s) by the potential G (r, s): -G of planes, and the normals of cones."""
        value = self.values(x)
        directions = [-G[: self.rows.linear]]
        for k in (place for group in self.cones.groups for place in group):
            t, z = value[k[0]], value[k[1:]]
            if self.rows.modes[k[0]] == Mode.CRUSH:  # (||z||^2 - t^2) / 4 is the yield function of Eq. (39)
                normal = np.concatenate([[t], -z]) / 2
            else:  # ||z|| - t
                normal = np.concatenate([[1.0], -z / max(float(np.linalg.norm(z)), TINY)])
            directions.append((normal @ -G[k])[None])
        return np.concatenate(directions)
