"""Blocks moved by finite displacements with their contacts held together, for capacity curves."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from scipy import sparse
from scipy.sparse.linalg import lsmr
from scipy.spatial.transform import Rotation

from limitblocks.arrays import Array, read_only
from limitblocks.geometry import Block, Interface, find_interfaces
from limitblocks.geometry.overlap import find_overlaps
from limitblocks.joints import Tie
from limitblocks.mechanics import Load
from limitblocks.mechanics.loads.forces import AddedMass, PointForce
from limitblocks.mechanics.loads.load import Term
from limitblocks.model import Model

CLOSED = 1e-9  # gap over the size of the structure that counts as none
MEETS = 1e-6  # of the size of the structure: a deeper overlap of blocks counts
ROUNDS = 20  # of Newton's method for the gaps; it converges quadratically
PARALLEL = 1e-6  # cosine from one of faces that slide on one another all over

Truths = npt.NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Contact:
    """An interface as each of its blocks sees it.

    Attributes
    ----------
    interface : Interface
        With its polygon and joint; half way between both blocks.
    ends : tuple of int
        Blocks i and j, in model order.
    on_i, on_j : Array, shape (k, 3)
        Its corners as material points of block i and of block j, global axes, m; they coincide where it is
        closed. A tie has its two anchors.
    axes_i, axes_j : Array, shape (3, 3)
        Its axes as they turn with block i and with block j.
    """

    interface: Interface
    ends: tuple[int, int]
    on_i: Array
    on_j: Array
    axes_i: Array
    axes_j: Array

    @property
    def ways(self) -> Array:
        """Way from the corners on i to those on j, local axes, m, shape (k, 3); the gap comes last."""
        return np.asarray((self.on_j - self.on_i) @ _half_way(self.axes_i, self.axes_j).T)

    @property
    def tied(self) -> bool:
        """True of a tie."""
        return isinstance(self.interface.joint, Tie)


@dataclass(frozen=True, eq=False)
class Assembly:
    """A displaced structure: its model as it is now, and the contacts of the model's interfaces, in order."""

    model: Model
    contacts: tuple[Contact, ...]

    @property
    def size(self) -> float:
        """Size of the structure, m."""
        return float(max(np.ptp(np.concatenate([b.vertices for b in self.model.blocks]), axis=0)))


def assembly_of(model: Model) -> Assembly:
    """Return the structure where it is first."""
    place = {block.name: k for k, block in enumerate(model.blocks)}
    return Assembly(model, tuple(_contact(own, place) for own in model.interfaces))


def _contact(own: Interface, place: dict[str, int]) -> Contact:
    half = own.joint.length / 2.0 * own.axes[2] if isinstance(own.joint, Tie) else None
    corners = own.centroid + own.polygon @ own.axes[:2]
    on_i = corners if half is None else (own.centroid - half)[None]
    on_j = corners if half is None else (own.centroid + half)[None]
    return Contact(own, (place[own.block_i], place[own.block_j]), on_i, on_j, own.axes, own.axes)


def _half_way(axes_i: Array, axes_j: Array) -> Array:
    """Axes half way between two sets of axes (3, 3), rows."""
    turn = Rotation.from_matrix(axes_j.T @ axes_i).as_rotvec()
    return np.asarray(axes_i @ Rotation.from_rotvec(turn / 2.0).as_matrix().T)


def moved(assembly: Assembly, displacements: Array) -> Assembly:
    """Return the structure after screws (n, 6) about the centroids: exact where their axes stay.

    Loads keep their directions; added masses and point forces move with their blocks.
    """
    model = assembly.model
    centres = np.stack([block.centroid for block in model.blocks])
    turns = Rotation.from_rotvec(displacements[:, 3:]).as_matrix()
    shifts = _screw_shift(displacements)

    def at(k: int, points: Array) -> Array:
        return np.asarray(centres[k] + shifts[k] + (points - centres[k]) @ turns[k].T)

    contacts = []
    for own in assembly.contacts:
        i, j = own.ends
        turned = replace(
            own,
            on_i=at(i, own.on_i),
            on_j=at(j, own.on_j),
            axes_i=own.axes_i @ turns[i].T,
            axes_j=own.axes_j @ turns[j].T,
        )
        contacts.append(replace(turned, interface=_placed(turned)))
    place = {block.name: k for k, block in enumerate(model.blocks)}
    blocks = tuple(
        Block(own.name, at(k, own.vertices), own.faces, own.unit_weight) if displacements[k].any() else own
        for k, own in enumerate(model.blocks)
    )

    def carried(load: Load) -> Load:
        terms: list[tuple[float, Term]] = []
        for factor, term in load.terms:
            if isinstance(term, AddedMass | PointForce):
                x, y, z = at(place[term.block], np.array(term.at)).tolist()
                terms.append((factor, replace(term, at=(x, y, z))))
            else:
                terms.append((factor, term))
        return Load(tuple(terms))

    interfaces = tuple(own.interface for own in contacts)
    dead, live = carried(model.dead), carried(model.live)
    now = replace(model, blocks=blocks, interfaces=interfaces, dead=dead, live=live)
    return Assembly(now, tuple(contacts))


def _screw_shift(displacements: Array) -> Array:
    """Displacements of the centroids (n, 3) where the velocities (n, 6) are those of screws that stay."""
    v, w = displacements[:, :3], displacements[:, 3:]
    angle = np.linalg.norm(w, axis=1)
    small = angle < 1e-4  # series, else the difference cancels
    safe = np.where(small, 1.0, angle)
    axis = w / np.where(angle > 0.0, angle, 1.0)[:, None]
    along = np.einsum("na,na->n", axis, v)[:, None] * axis
    sine = np.where(small, 1.0 - angle**2 / 6.0, np.sin(angle) / safe)
    versine = np.where(small, angle / 2.0, (1.0 - np.cos(angle)) / safe)
    return np.asarray(along + sine[:, None] * (v - along) + versine[:, None] * np.cross(axis, v))


def _placed(own: Contact) -> Interface:
    """The interface half way between both blocks, on its closed corners; a tie between its anchors."""
    axes = _half_way(own.axes_i, own.axes_j)
    if own.tied:
        n = own.on_j[0] - own.on_i[0]
        n = n / np.linalg.norm(n)
        s1 = axes[0] - (axes[0] @ n) * n
        s1 = s1 / np.linalg.norm(s1)
        axes = np.stack([s1, np.cross(n, s1), n])
        centroid = (own.on_i[0] + own.on_j[0]) / 2.0
    else:
        gap = own.ways[:, 2]
        kept = gap <= gap.min() + 1e-6 * np.abs(own.interface.polygon).max()
        middle = (own.on_i + own.on_j)[kept].mean(axis=0) / 2.0
        centroid = middle - own.interface.polygon[kept].mean(axis=0) @ axes[:2]
    return replace(own.interface, centroid=read_only(centroid), axes=read_only(axes))


def closed_up(assembly: Assembly, held: list[Truths], sliding: list[bool]) -> tuple[Assembly, float]:
    """Return the nearest structure in which the corners `held` have no gap, and the largest that is left, m.

    `held` has an array (k,) a contact. Where a contact does not slide its held corners coincide.
    """
    wanted = np.concatenate(
        [
            np.stack([own & (not slides)] * 2 + [own], axis=1)
            for own, slides in zip(held, sliding, strict=True)
        ]
    )
    size = np.array([block.size for block in assembly.model.blocks])
    scale = np.repeat(np.stack([np.ones_like(size), 1.0 / size], axis=1), 3, axis=1)
    scale[[block.name in assembly.model.supports for block in assembly.model.blocks]] = 0.0
    left = np.inf
    for _ in range(ROUNDS):
        way = np.where(wanted, np.concatenate([own.ways for own in assembly.contacts]), 0.0)
        last, left = left, float(np.abs(way).max(initial=0.0))
        if left == 0.0 or left > last / 2.0:  # rounding is reached
            break
        rows = _rows(assembly)[wanted.ravel()] @ sparse.diags_array(scale.ravel())
        step = lsmr(rows, -way[wanted], atol=1e-15, btol=1e-15, maxiter=20 * rows.shape[1])[0]
        assembly = moved(assembly, (scale.ravel() * step).reshape(-1, 6))
    return assembly, left


def _rows(assembly: Assembly) -> sparse.csr_array:
    """Rates of the ways of all contacts in the rates of the blocks, shape (3 k, 6 n)."""
    centres = np.stack([block.centroid for block in assembly.model.blocks])
    parts = [
        (sign, own.ends[side], points, _half_way(own.axes_i, own.axes_j))
        for own in assembly.contacts
        for side, sign, points in ((0, -1.0, own.on_i), (1, 1.0, own.on_j))
    ]
    data, rows, columns, start = [], [], [], 0
    for number, (sign, k, points, axes) in enumerate(parts):
        turn = np.cross((points - centres[k])[:, None, :], axes)  # a . (w x r) = w . (r x a)
        values = sign * np.concatenate([np.broadcast_to(axes, turn.shape), turn], axis=2)
        data.append(values.ravel())
        rows.append(np.repeat(start + np.arange(3 * len(points)), 6))
        columns.append(np.tile(6 * k + np.arange(6), 3 * len(points)))
        start += 3 * len(points) * (number % 2)
    places = np.concatenate(rows), np.concatenate(columns)
    shape = start, 6 * len(assembly.model.blocks)
    return sparse.coo_array((np.concatenate(data), places), shape=shape).tocsr()


def meet(assembly: Assembly) -> bool:
    """Whether blocks that no interface joins overlap."""
    blocks = assembly.model.blocks
    joined = {tuple(sorted(own.ends)) for own in assembly.contacts}
    low, high = (np.array([end(block.vertices, axis=0) for block in blocks]) for end in (np.min, np.max))
    inside = np.triu((low[:, None] < high[None]).all(axis=2) & (low[None] < high[:, None]).all(axis=2), 1)
    pairs = np.array([pair for pair in np.argwhere(inside).tolist() if tuple(pair) not in joined])
    points = [block.vertices for block in blocks]
    return len(pairs) > 0 and bool(find_overlaps(blocks, points, pairs, MEETS * assembly.size))


def slid(assembly: Assembly, sliding: list[bool]) -> Assembly:
    """Return the structure with the contacts that slide where block j now is, and their areas found anew.

    Faces that slide flat on one another get the area that they now share; an opened joint that slides keeps
    its corners on block j.
    """
    contacts: list[Contact] = []
    for own, slides in zip(assembly.contacts, sliding, strict=True):
        contacts += list(_found_anew(assembly, own)) if slides and not own.tied else [own]
    model = replace(assembly.model, interfaces=tuple(own.interface for own in contacts))
    return Assembly(model, tuple(contacts))


def _found_anew(assembly: Assembly, own: Contact) -> Iterator[Contact]:
    i, j = own.ends
    blocks = assembly.model.blocks
    if own.axes_i[2] @ own.axes_j[2] > 1.0 - PARALLEL and np.ptp(own.ways[:, 2]) <= CLOSED * assembly.size:
        place = {block.name: k for k, block in enumerate(blocks)}
        faces = find_interfaces([blocks[i], blocks[j]], own.interface.joint)
        same = [face for face in faces if face.axes[2] @ own.interface.axes[2] > 1.0 - PARALLEL]
        if same:
            yield from (_contact(face, place) for face in same)
            return
    moved_on = replace(own, on_i=own.on_j - own.ways[:, 2:] * _half_way(own.axes_i, own.axes_j)[2])
    yield replace(moved_on, interface=_placed(moved_on))
