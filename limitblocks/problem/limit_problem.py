"""The dimensionless limit problem: all that the analyses and the checks work with."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from limitblocks.arrays import Array, Indices


@dataclass(frozen=True)
class Scales:
    """Units of the dimensionless numbers.

    `force` is the mean block weight (N), `length` the block length (m), `live` the resultant of the live
    load in mean block weights, at load factor one.
    """

    force: float
    length: float
    live: float

    @property
    def resultants(self) -> Array:
        """Units of (V1, V2, N, M1, M2, T), and of a load (f, m): N and N m; shape (6,)."""
        return self.force * np.array([1.0, 1.0, 1.0, self.length, self.length, self.length])

    @property
    def load_factor(self) -> float:
        """Load factors of the model per dimensionless load factor."""
        return 1.0 / self.live

    @property
    def work(self) -> float:
        """Unit of a displacement rate (m): the live load then does the work 1 N m, Eq. (55)."""
        return 1.0 / (self.force * self.live)


@dataclass(frozen=True)
class Cones:
    """The cone K: `linear` rows of the nonnegative orthant, then (count, size) second-order cones."""

    linear: int
    second_order: tuple[tuple[int, int], ...] = ()

    @property
    def degree(self) -> int:
        """Number of linear rows and cones."""
        return self.linear + sum(count for count, _ in self.second_order)

    @property
    def identity(self) -> Array:
        """The centre of the cone: 1 for linear rows, (1, 0, ...) for second-order cones."""
        parts = [np.ones(self.linear)]
        parts += [np.tile(np.eye(1, size)[0], count) for count, size in self.second_order]
        return np.concatenate(parts)

    @property
    def blocks(self) -> tuple[tuple[int, int, int], ...]:
        """(first row, count, size) of each group of second-order cones."""
        first, found = self.linear, []
        for count, size in self.second_order:
            found.append((first, count, size))
            first += count * size
        return tuple(found)

    def margin(self, rows: Array) -> Array:
        """Return how far each linear row and each cone is inside K: s, or t - ||z||; negative outside."""
        parts = [rows[: self.linear]]
        for first, count, size in self.blocks:
            cone = rows[first : first + count * size].reshape(count, size)
            parts.append(cone[:, 0] - np.linalg.norm(cone[:, 1:], axis=1))
        return np.concatenate(parts)


@dataclass(frozen=True, eq=False)
class LimitProblem:
    """Limit analysis of n free blocks and m interfaces as numbers; lengths and forces dimensionless.

    With x the generalised stresses (s numbers), u the displacement rates and y the flow multipliers
    (R numbers): equilibrium ``dead + load_factor live = C^T x``, yield ``F x + g in K``, flow
    ``C u = -G(x)^T y, y in K*``, normalisation ``live . u = 1``; Eqs (54)-(59). The associated flow has
    G = F. The live load has unit resultant.

    Attributes
    ----------
    C : csr_array, shape (s, 6 n)
        Compatibility matrix in generalised strain rates.
    dead, live : Array, shape (6 n,)
        Forces and moments at the centroids of the free blocks.
    F, G : csr_array, shape (R, s)
        Yield rows, and plastic potential for zero dilatancy without its pivot terms.
    g : Array, shape (R,)
        Constant terms of the yield rows.
    cones : Cones
        The cone K; it is self-dual, K* = K.
    pivot, reach : Array, shapes (R,) and (m, 2)
        Rows that turn about (e1, e2), Table 5, and the half sides that limit |e1|, |e2|.
    resultants : csr_array, shape (6 m, s)
        Stress resultants Q = resultants x.
    compliance : Array, shape (s,)
        Strain per generalised stress of joints of unit stiffness: 1/area for forces, 1/second moment of
        area for moments; the metric in which stresses are compared.
    row_interface : Indices, shape (R,)
        Interface of each row.
    row_mode : tuple of str
        Failure mode of each row.
    friction : Array, shape (m,)
        Friction coefficient of each interface.
    scales : Scales
        Units of the numbers.
    blocks, interfaces : tuple of str
        Names of the free blocks and of the interfaces, for messages.
    """

    C: sparse.csr_array
    dead: Array
    live: Array
    F: sparse.csr_array
    g: Array
    G: sparse.csr_array
    cones: Cones
    pivot: Array
    reach: Array
    resultants: sparse.csr_array
    compliance: Array
    row_interface: Indices
    row_mode: tuple[str, ...]
    friction: Array
    scales: Scales
    blocks: tuple[str, ...]
    interfaces: tuple[str, ...]

    @property
    def stress_units(self) -> Array:
        """Units of the generalised stresses, N or N m, shape (s,)."""
        is_force = abs(self.resultants).T @ np.tile([1.0, 1.0, 1.0, 0.0, 0.0, 0.0], len(self.interfaces)) > 0
        return self.scales.force * np.where(is_force, 1.0, self.scales.length)

    @property
    def rate_units(self) -> Array:
        """Units of the displacement rates (m, rad): the live load does the work 1 N m; shape (6 n,)."""
        unit = self.scales.work * np.repeat([1.0, 1.0 / self.scales.length], 3)
        return np.tile(unit, len(self.blocks))
