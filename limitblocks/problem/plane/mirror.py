"""Mirror planes found in the numbers of a limit problem.

A mirror maps a free block to itself or to another: rates (du, w) of the one to (R du, -R w) of the other,
R = 1 - 2 m m^T, m the normal of the plane. A place where forces act, an interface or a point of one, is
mapped to a place between the images of its blocks. docs/planar.md has the proofs of what follows from it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from limitblocks.arrays import Array, Flags, Indices
from limitblocks.known import known
from limitblocks.problem.limit_problem import LimitProblem
from limitblocks.problem.plane.alike import alike
from limitblocks.problem.plane.candidates import candidates, images
from limitblocks.problem.plane.places import Place, kinds_of
from limitblocks.problem.plane.rounding import EXACT, classes, close

SNAP = 1e-10  # distance of a normal from an axis that is rounding


@dataclass(frozen=True, eq=False)
class Mirrored:
    """Places of one kind under the mirror.

    Attributes
    ----------
    places : Place
        The places.
    image : Indices, shape (K,)
        Where each one goes.
    turn : Array, shape (K, c, c)
        The stresses there per stress.
    own : Flags, shape (K,)
        Whether the place is symmetric about a plane of its own, between blocks that are their own images.
    partner : Indices, shape (K, members)
        The linear row or cone that the mirror makes of each: of the place itself where it has a plane of its
        own, else of its image.
    sort : Indices, shape (K,)
        Equal for places with the same rows and the same turn.
    """

    places: Place
    image: Indices
    turn: Array
    own: Flags
    partner: Indices
    sort: Indices

    @property
    def paired(self) -> Flags:
        """Whether the place is one of two that are each other's images, and have no planes of their own."""
        return np.asarray(~self.own & (self.image != np.arange(len(self.image))))


@dataclass(frozen=True, eq=False)
class Mirror:
    """The mirror plane of a limit problem.

    Attributes
    ----------
    frame : Array, shape (3, 3)
        Orthonormal columns: the normal of the plane is column `axis`, the others lie in it.
    axis : int
        Which one.
    image : Indices, shape (n,)
        Where each free block goes.
    kinds : tuple of Mirrored
        All places, kind by kind.
    """

    frame: Array
    axis: int
    image: Indices
    kinds: tuple[Mirrored, ...]

    @property
    def rates(self) -> Array:
        """Rates (6, 6) of the image of a block per rate of the block."""
        sides = np.ones(3)
        sides[self.axis] = -1.0
        reflected = (self.frame * sides) @ self.frame.T
        rates = np.zeros((6, 6))
        rates[:3, :3], rates[3:, 3:] = reflected, -reflected
        return rates

    @property
    def flat(self) -> bool:
        """Whether everything acts parallel to the plane: no block or place is paired with another's."""
        return bool((self.image == np.arange(len(self.image))).all() and all(k.own.all() for k in self.kinds))


def mirror_of(problem: LimitProblem) -> Mirror | None:
    """Return a plane about which the problem is symmetric; None where none is found up to EXACT.

    The plane parallel to which everything acts comes first. A problem is frozen, and its mirror sought once.
    """
    return known(problem, "mirror", lambda: _mirror_of(problem))


def _mirror_of(problem: LimitProblem) -> Mirror | None:
    if problem.C.shape[1] != 6 * len(problem.blocks) or not len(problem.blocks):
        return None
    strain = _strain_by_end(problem)
    for normal, image in candidates(problem, strain):
        found = _mirror(problem, strain, Mirror(*_frame(normal), image, ()))
        if found is not None:
            return found
    return None


def _mirror(problem: LimitProblem, strain: Array, empty: Mirror) -> Mirror | None:
    """The mirror with all places; None where the loads or a place are not symmetric."""
    image = empty.image
    if not _loaded_alike(problem, image, empty.rates):
        return None
    kinds = []
    for kind in kinds_of(problem, strain):
        mirrored = _mirrored(kind, image, empty.rates)
        if mirrored is None or not _same_units(problem, mirrored):
            return None
        kinds.append(mirrored)
    return replace(empty, kinds=tuple(kinds))


def _same_units(problem: LimitProblem, kind: Mirrored) -> bool:
    """Whether places are measured by what measures their images, and so are the blocks that meet there."""
    interface = problem.stress_interface[kind.places.columns[:, 0]]
    sizes = problem.units.interface_force[interface], problem.units.interface_length[interface]
    return all((part[kind.image] == part).all() for part in sizes)


def _strain_by_end(problem: LimitProblem) -> Array:
    """Strain rates (s, 2, 6) per rate of the block at each end of the interface; zero for a support."""
    C = problem.C
    row, (block, rate) = np.repeat(np.arange(C.shape[0]), np.diff(C.indptr)), np.divmod(C.indices, 6)
    end = (problem.ends[problem.stress_interface[row], 0] != block).astype(int)
    strain = np.zeros((C.shape[0], 2, 6))
    strain[row, end, rate] = C.data
    return strain


def _frame(normal: Array) -> tuple[Array, int]:
    """Orthonormal axes, one of them the normal: a Householder matrix, the global axes where it is one."""
    axis = int(np.abs(normal).argmax())
    v = normal * np.sign(normal[axis]) - np.eye(3)[axis]
    size = float(v @ v)
    return (np.eye(3) if size < SNAP**2 else np.eye(3) - 2.0 * np.outer(v, v) / size), axis


def _loaded_alike(problem: LimitProblem, image: Indices, rates: Array) -> bool:
    loads = [load.reshape(-1, 6) for load in (problem.dead, problem.live)]
    return all(close(load[image] @ rates, load, np.abs(load).max(initial=0.0)) for load in loads)


def _mirrored(kind: Place, blocks: Indices, rates: Array) -> Mirrored | None:
    """Where the mirror takes each place; None where one has no image, or its rows are not symmetric.

    `blocks` (n,) are the images of the blocks.
    """
    image, turn = images(kind, blocks, rates)
    K, c = kind.columns.shape
    back = turn[image]
    if not (image[image] == np.arange(K)).all() or not close(back @ turn, np.eye(c)[None], 1.0):
        return None
    still = (np.where(kind.ends >= 0, blocks[kind.ends], -1) == kind.ends).all(axis=1)
    own = still & (np.abs(back - turn).max(axis=(1, 2)) <= EXACT) & _plane_of_its_own(kind, turn, rates)
    _, sort = classes(kind.sort[:, None].astype(float), turn)
    partner = _partners(kind, image, turn, own, sort)
    if partner is None and own.any():
        own = np.zeros_like(own)  # not by planes of their own, but as pairs
        partner = _partners(kind, image, turn, own, sort)
    return None if partner is None else Mirrored(kind, image, turn, own, partner, sort)


def _plane_of_its_own(kind: Place, turn: Array, rates: Array) -> Flags:
    """Whether the turn leaves the strains of a place by symmetric rates of its blocks as they are."""
    strain = kind.strain @ (np.eye(6) + rates)
    off = np.abs(turn[:, None] @ strain - strain).max(axis=(1, 2, 3))
    return np.asarray(off <= EXACT * np.abs(strain).max(axis=(1, 2, 3)))


def _partners(kind: Place, image: Indices, turn: Array, own: Flags, sort: Indices) -> Indices | None:
    """Partners of all members as in :class:`Mirrored`; None where the rows are not symmetric."""
    first, of_place = classes(np.stack([sort, sort[image], own], axis=1))
    a, b, across, own = kind.sort[first], kind.sort[image[first]], turn[first], own[first]
    partner = np.zeros((len(first), len(kind.members)), dtype=np.int64)
    if own.any():
        within = alike(kind, a[own], a[own], across[own])
        moved = own & (a != b)
        if within is None or (moved.any() and alike(kind, a[moved], b[moved], None) is None):
            return None
        partner[own] = within
    if not own.all():
        its = alike(kind, a[~own], b[~own], across[~own].transpose(0, 2, 1))
        if its is None:
            return None
        partner[~own] = its
    return np.asarray(partner[of_place])
