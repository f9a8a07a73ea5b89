"""The dimensionless limit problem: all that the analyses and the checks work with."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy import sparse

from limitblocks.arrays import Array, Indices, read_only, tied
from limitblocks.problem.cones import Cones


@dataclass(frozen=True, eq=False)
class Units:
    """Units of the dimensionless numbers: each block and each interface has its own.

    `block_force` (n,) and `block_length` (n,) measure what acts on a block, `interface_force` (m,) and
    `interface_length` (m,) what an interface carries, N and m. `live` is the sum of the live loads over their
    blocks' forces at load factor one. `row` (R,) multiplies a row's unit of force.
    """

    block_force: Array
    block_length: Array
    interface_force: Array
    interface_length: Array
    live: float
    row: Array

    def of(self, blocks: Indices, interfaces: Indices, rows: Indices) -> Units:
        """Return those of some blocks, interfaces and rows, by their places."""
        force, length = self.interface_force[interfaces], self.interface_length[interfaces]
        block = self.block_force[blocks], self.block_length[blocks]
        return Units(*block, force, length, self.live, self.row[rows])

    @cached_property
    def loads(self) -> Array:
        """Units of forces and moments on the blocks, N and N m, shape (6 n,)."""
        return _six(self.block_force, self.block_length)

    @cached_property
    def resultants(self) -> Array:
        """Units of the stress resultants (V1, V2, N, M1, M2, T), N and N m, shape (6 m,)."""
        return _six(self.interface_force, self.interface_length)


def _six(force: Array, length: Array) -> Array:
    return np.repeat(force, 6) * np.stack([np.ones_like(length)] * 3 + [length] * 3, axis=1).ravel()


def power_of_two(values: Any) -> Any:
    """Return the nearest powers of two: units that change no digit, and that many blocks share."""
    return np.exp2(np.round(np.log2(values)))


def in_units(matrix: sparse.csr_array, rows: Array, columns: Array) -> sparse.csr_array:
    """Return a matrix with its rows and columns multiplied by numbers of their own."""
    data = matrix.data * np.repeat(rows, np.diff(matrix.indptr)) * columns[matrix.indices]
    return sparse.csr_array((data, matrix.indices.copy(), matrix.indptr.copy()), shape=matrix.shape)


def parts_of(ends: Indices, count: int) -> Indices:
    """Number the parts of `count` blocks that chains of interfaces tie together, shape (count,).

    `ends` (m, 2) holds the blocks of each interface, -1 for a support; supports tie nothing.
    """
    return tied(ends[(ends >= 0).all(axis=1)], count)


@dataclass(frozen=True, eq=False)
class State:
    """Load factor, generalised stresses x (s,), displacement rates u (6 n,) and multipliers y (R,).

    Dimensionless, or in SI units where :meth:`LimitProblem.in_si` made it.
    """

    load_factor: float
    x: Array
    u: Array
    y: Array


@dataclass(frozen=True, eq=False)
class LimitProblem:
    """Limit analysis of n free blocks and m interfaces as numbers; lengths and forces dimensionless.

    With x the generalised stresses (s numbers), u the displacement rates and y the flow multipliers
    (R numbers): equilibrium ``dead + load_factor live = C^T x``, yield ``F x + g in K``, flow
    ``C u = -G(x)^T y, y in K*``, normalisation ``live . u = 1``; Eqs (54)-(59). G is
    :class:`~limitblocks.problem.flow.Flow`'s; the associated flow has G = F.

    Attributes
    ----------
    C : csr_array, shape (s, 6 n)
        Compatibility matrix in generalised strain rates.
    dead, live : Array, shape (6 n,)
        Forces and moments at the centroids of the free blocks.
    F, G : csr_array, shape (R, s)
        Yield rows, and plastic potential for zero dilatancy that twists about the centroid.
    g : Array, shape (R,)
        Constant terms of the yield rows.
    cones : Cones
        The cone K; it is self-dual, K* = K.
    pivot, half_sides : Array, shapes (R,) and (m, 2)
        Rows that Table 5 turns about (e1, e2), and the half sides that limit |e1|, |e2|.
    resultants : csr_array, shape (6 m, s)
        Stress resultants Q = resultants x.
    compliance : Array, shape (s,)
        Strain per generalised stress of joints of unit stiffness: 1/area for forces, 1/second moment of
        area for moments; the metric in which stresses are compared.
    ends : Indices, shape (m, 2)
        Free blocks i and j of each interface, -1 for a support.
    row_interface : Indices, shape (R,)
        Interface of each row.
    row_mode : array of Mode, shape (R,)
        Failure mode of each row.
    friction : Array, shape (m,)
        Friction coefficient of each interface.
    units : Units
        Units of the numbers.
    blocks, interfaces : tuple of str
        Names of the free blocks and of the interfaces, for messages.
    centroids : Array, shape (n, 3)
        Of the free blocks, m: where to look for a symmetry. No equation has them.
    left_out : tuple of str
        Parts of the model's file that are no blocks, for messages.
    """

    C: sparse.csr_array
    dead: Array
    live: Array
    F: sparse.csr_array
    g: Array
    G: sparse.csr_array
    cones: Cones
    pivot: Array
    half_sides: Array
    resultants: sparse.csr_array
    compliance: Array
    ends: Indices
    row_interface: Indices
    row_mode: npt.NDArray[np.object_]
    friction: Array
    units: Units
    blocks: tuple[str, ...]
    interfaces: tuple[str, ...]
    centroids: Array
    left_out: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        # scipy sorts entries in place where it first needs to: sums would come in another order from then on
        for part in (self.C, self.F, self.G, self.resultants):
            part.sum_duplicates()

    @cached_property
    def stress_interface(self) -> Indices:
        """Interface of each generalised stress, shape (s,)."""
        Q, m = self.resultants, len(self.interfaces)
        interface = np.zeros(Q.shape[1], dtype=np.int64)
        interface[Q.indices] = np.repeat(np.arange(m), np.diff(Q.indptr[::6]))
        return interface

    @cached_property
    def balance(self) -> sparse.csc_array:
        """C^T: the loads that stresses balance, shape (6 n, s)."""
        return self.C.T

    @cached_property
    def acting(self) -> sparse.csc_array:
        """|C|^T: the sum of sizes in each equation of equilibrium per size of each stress, shape (6 n, s)."""
        return abs(self.C).T

    @cached_property
    def parts(self) -> Indices:
        """Number of the part each free block belongs to, shape (n,); interfaces tie the blocks of a part."""
        return parts_of(self.ends, len(self.blocks))

    @cached_property
    def member_interface(self) -> Indices:
        """Interface of each linear row and each cone, shape (degree,)."""
        return np.asarray(self.row_interface[self.cones.heads])

    @cached_property
    def stress_units(self) -> Array:
        """Units of the generalised stresses, N or N m, shape (s,)."""
        forces, k = np.tile([1.0, 1.0, 1.0, 0.0, 0.0, 0.0], len(self.interfaces)), self.stress_interface
        length = np.where(abs(self.resultants).T @ forces > 0.0, 1.0, self.units.interface_length[k])
        return np.asarray(self.units.interface_force[k] * length)

    @cached_property
    def rate_units(self) -> Array:
        """Units of the displacement rates (m, rad): the live load does the work 1 N m, Eq. (55); (6 n,)."""
        return 1.0 / (self.units.live * self.units.loads)

    @cached_property
    def multiplier_units(self) -> Array:
        """Units of the flow multipliers, m, shape (R,)."""
        force = self.units.interface_force[self.row_interface] * self.units.row
        return np.asarray(1.0 / (self.units.live * force))

    def in_si(self, state: State) -> State:
        """Return the state in SI units; the live load of the model does the work 1 N m on its rates."""
        return State(
            float(state.load_factor / self.units.live),
            state.x * self.stress_units,
            state.u * self.rate_units,
            state.y * self.multiplier_units,
        )

    def dimensionless(self, state: State) -> State:
        """Return a state given in SI units as numbers of this problem; the inverse of `in_si`."""
        return State(
            state.load_factor * self.units.live,
            state.x / self.stress_units,
            state.u / self.rate_units,
            state.y / self.multiplier_units,
        )

    @np.errstate(over="ignore")  # of a state that ran away
    def measured(self, block_force: Array) -> LimitProblem:
        """Return the same problem with other units of force: block by block, and by the lesser at interfaces.

        Parameters
        ----------
        block_force : Array, shape (n,)
            Forces to measure the blocks by, in N, positive.
        """
        old = self.units
        block = power_of_two(block_force)  # changes no digit of any number
        at_ends = np.where(self.ends >= 0, block[self.ends], np.inf).min(axis=1)
        live = power_of_two(old.live * float(np.abs(self.live * np.repeat(old.block_force / block, 6)).sum()))
        units = replace(old, block_force=block, interface_force=at_ends, live=live)
        loads, stresses = old.loads / units.loads, at_ends / old.interface_force
        columns, rows = stresses[self.stress_interface], stresses[self.row_interface]  # F and G stay
        live_share = old.live / live
        found = replace(
            self,
            C=in_units(self.C, columns, loads),
            dead=read_only(self.dead * loads),
            live=read_only(self.live * loads * live_share),
            g=read_only(self.g / rows),
            compliance=read_only(self.compliance * columns**2),
            units=units,
        )
        same = ("stress_interface", "parts", "member_interface")  # in all units
        vars(found).update({key: vars(self)[key] for key in same if key in vars(self)})
        return found
