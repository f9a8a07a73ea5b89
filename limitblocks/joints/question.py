"""The yield rows of one interface as closed forms: margins, reach along a direction, flow directions."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from limitblocks.arrays import Array
from limitblocks.joints.base import YieldRows

OUTSIDE = 1e-9  # of the size of a stress state: violations of a yield function below it are rounding
TINY = np.finfo(float).tiny
FLAT = 1e-13  # of a row's size: change along a direction below it is rounding


@dataclass(frozen=True)
class Question:
    """Yield rows F x + g of one interface, in the units of stress resultants `unit` (6,), N and N m."""

    rows: YieldRows
    unit: Array

    @cached_property
    def cones(self) -> list[slice]:
        """Rows of each second-order cone."""
        ends = self.rows.linear + np.cumsum(self.rows.cones, dtype=int)
        return [slice(int(end) - size, int(end)) for end, size in zip(ends, self.rows.cones, strict=True)]

    @cached_property
    def modes(self) -> tuple[str, ...]:
        """Failure mode of each linear row and of each cone."""
        return self.rows.modes[: self.rows.linear] + tuple(self.rows.modes[k.start] for k in self.cones)

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
        value = self.values(x)
        inside = [value[k.start] - np.linalg.norm(value[k.start + 1 : k.stop]) for k in self.cones]
        return np.concatenate([value[: self.rows.linear], inside])

    def reach(self, x: Array, dx: Array) -> float:
        """Largest t with x + t dx within the yield set, in which x is; infinite if there is none."""
        F = self.rows.F[0]
        value, slope = self.values(x), F @ dx
        slope[np.abs(slope) <= FLAT * (np.abs(F) @ np.abs(dx))] = 0.0
        falling = np.flatnonzero(slope[: self.rows.linear] < 0)
        reaches = [max(value[k], 0.0) / -slope[k] for k in falling]
        reaches += [_cone_reach(value[k], slope[k]) for k in self.cones]
        return float(min(reaches, default=np.inf))

    def flow(self, G: Array, x: Array) -> Array:
        """Flow directions (k, 6) by the potential G (r, 6): -G of planes, and the normals of cones."""
        value = self.values(x)
        directions = [-G[: self.rows.linear]]
        for k in self.cones:
            t, z = value[k][0], value[k][1:]
            if self.rows.modes[k.start] == "crush":  # (||z||^2 - t^2) / 4 is the yield function of Eq. (39)
                normal = np.concatenate([[t], -z]) / 2
            else:  # ||z|| - t
                normal = np.concatenate([[1.0], -z / max(float(np.linalg.norm(z)), TINY)])
            directions.append((normal @ -G[k])[None])
        return np.concatenate(directions)


def _cone_reach(value: Array, slope: Array) -> float:
    """Largest t with value + t slope in the cone t0 >= ||z||, in closed form; `value` is in it."""
    a, z, b, w = value[0], value[1:], slope[0], slope[1:]
    if b >= np.linalg.norm(w):
        return np.inf
    # A t^2 + 2 B t + C, which is at least zero inside
    A, B, C = b**2 - w @ w, a * b - z @ w, max(a**2 - z @ z, 0.0)
    if b < 0 and max(abs(A) / b**2, abs(B) / max(-a * b, TINY), C / max(a**2, TINY)) < FLAT:
        return float(a / -b)  # along the boundary to the apex
    root = np.sqrt(max(B**2 - A * C, 0.0))
    if B > 0.0:  # then A < 0; this form does not cancel
        return float((B + root) / -A)
    return float(C / (root - B)) if root > B else 0.0
