"""Contacts of displaced blocks brought together and found anew."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy import sparse

from limitblocks.arrays import Array, Flags, Indices
from limitblocks.errors import ModelError, SolveError
from limitblocks.evidence.factors import diagonal_factors
from limitblocks.geometry import find_contacts
from limitblocks.geometry.neighbours import neighbours
from limitblocks.geometry.overlap import find_overlaps
from limitblocks.joints import Dowel
from limitblocks.model import Model
from limitblocks.practice.contact import CLOSED, DisplacedContacts, contacts_of, seated, together
from limitblocks.practice.displaced import Assembly, Motion, moved, placed
from limitblocks.practice.resting import PARALLEL
from limitblocks.practice.trimmed import trimmed

MEETS = 1e-6  # of the size of the structure: a deeper overlap of blocks counts
DAMP = 1e-4  # closes a gap by at most 1 / (2 DAMP) of it: contacts that fit at first order alone move far
ROUNDS = 20  # of Newton's method for the gaps; it converges quadratically


def closed_up(
    assembly: Assembly, held: Flags, sliding: Flags, displacements: Array | None = None
) -> tuple[Assembly, float]:
    """Return the nearest structure in which the corners `held` have no gap, and the largest that is left, m.

    `held` has shape (k,), `sliding` (m,). Where a contact does not slide its held corners coincide; a tie
    keeps its length alone. It is the nearest to that after `displacements`, shape (n, 6), whose way back is
    barred unless a support led the motion; what then cannot but open opens: rates tell of the first order of
    a motion alone.
    """
    normal, own, motion = held, assembly.contacts, assembly.at_rest
    stuck = ~(sliding | own.tied)[own.of]
    size = np.array([block.size for block in assembly.model.blocks])
    scale = np.repeat(np.stack([np.ones_like(size), 1.0 / size], axis=1), 3, axis=1)
    supports, barred = ~assembly.model.free, np.zeros((0, scale.size))
    if displacements is not None:
        motion = motion.then(displacements)
        if not displacements[supports].any():
            way = (displacements / scale).reshape(1, -1)
            barred = way / np.maximum(np.linalg.norm(way), 1e-300)
    scale[supports] = 0.0
    while True:
        wanted = np.stack([normal & stuck, normal & stuck, normal], axis=1)
        there, ways = _closed(own, motion, wanted, scale, barred)
        opens = normal & (ways[:, 2] > CLOSED * assembly.size)
        if not len(barred) or not opens.any():
            return moved(assembly, there), float(np.abs(ways).max(initial=0.0))
        normal = normal & ~opens


def _closed(
    contacts: DisplacedContacts, motion: Motion, wanted: Flags, scale: Array, barred: Array
) -> tuple[Motion, Array]:
    """Newton's method for the ways `wanted`, shape (k, 3): where blocks then are, and those ways, m."""
    last = np.inf
    for _ in range(ROUNDS):
        own = motion.contacts(contacts)
        ways = np.where(wanted, own.ways, 0.0)
        left = float(np.abs(ways).max(initial=0.0))
        if left == 0.0 or left > last / 2.0:  # rounding is reached
            break
        rows = rows_of(own, motion.at)[wanted.ravel()] @ sparse.diags_array(scale.ravel())
        rows = sparse.vstack([rows, sparse.csr_array(barred)])
        step = _least_squares(rows, np.append(-ways[wanted], np.zeros(len(barred))))
        motion, last = motion.then((scale.ravel() * step).reshape(-1, 6)), left
    return motion, ways


def _least_squares(A: sparse.csr_array, b: Array) -> Array:
    """The x of least |A x - b|^2 + |DAMP x|^2: with y = (b - A x) / DAMP it is A^T y = DAMP x."""
    first, second = (DAMP * sparse.eye_array(size) for size in A.shape)
    K = sparse.csc_array(sparse.block_array([[first, A], [A.T, -second]]))
    factors, right = diagonal_factors(K), np.append(b, np.zeros(A.shape[1]))
    found = factors.solve(right)
    found += factors.solve(right - K @ found)  # without exchanges of rows it is a rough one
    return np.asarray(found[len(b) :])


def rows_of(own: DisplacedContacts, centres: Array) -> sparse.csr_array:
    """Return the rates of the ways of contacts in those of blocks about centres (n, 3), shape (3 k, 6 n)."""
    ends = own.ends[own.of]  # of k corners, as all axes below
    arms = own.rest[:, None] - centres[ends]
    axes = np.stack([-own.axes, own.axes], axis=1)
    turns = np.cross(arms[:, :, None], axes)  # a . (w x r) = w . (r x a)
    data = np.concatenate([axes, turns], axis=3)
    rows = np.arange(own.axes.shape[0] * 3).reshape(-1, 1, 3, 1)
    columns = 6 * ends[:, :, None, None] + np.arange(6)
    places = tuple(np.broadcast_to(place, data.shape).ravel() for place in (rows, columns))
    return sparse.coo_array((data.ravel(), places), shape=(rows.size, 6 * len(centres))).tocsr()


def meet(assembly: Assembly) -> bool:
    """Whether blocks that no interface joins overlap."""
    pairs = _apart(assembly, 0.0)
    points = [block.vertices for block in assembly.model.blocks]
    return bool(find_overlaps(assembly.model.blocks, points, pairs, MEETS * assembly.size))


def _apart(assembly: Assembly, reach: float) -> Indices:
    """Pairs of blocks (p, 2) that no interface joins and whose boxes come as near as `reach`, m."""
    joined = set(map(tuple, np.sort(assembly.contacts.ends).tolist()))
    near = neighbours([block.vertices for block in assembly.model.blocks], reach / 2.0)
    return near[[tuple(pair) not in joined for pair in near.tolist()]]


def slid(assembly: Assembly, sliding: Flags) -> tuple[Assembly, tuple[str, ...]]:
    """Return the structure with the contacts that slide where they now are, and which were lost or found.

    Faces that slide flat on one another get the areas that they now share: one that shares none any more
    carries nothing, and is left out. A block that slides onto a further face rests on that as well. An opened
    joint that slides keeps the part whose closed corners are on both faces, and is left out once none is. A
    dowel that slides shears off, and is left out.
    """
    blocks, contacts = assembly.model.blocks, assembly.contacts
    numbers = np.flatnonzero(sliding)
    still = np.delete(np.arange(len(contacts)), numbers)
    kept, of = [contacts[still]], [still]  # and the contacts that they come of
    flat: dict[tuple[int, ...], list[DisplacedContacts]] = {}
    said = []
    for k in numbers.tolist():
        own = contacts[k]
        interface, ends = own.interface, tuple(own.ends[0].tolist())
        if isinstance(interface.joint, Dowel):
            said.append(f"{interface.name} shears off")
            continue
        if not parallel(own.axes_i[0], own.axes_j[0]) or np.ptp(own.ways[:, 2]) > CLOSED * assembly.size:
            gap, of_j = own.ways[:, 2:] * own.axes[:, 2], own.on_face_i[:, None]
            moved_on = replace(own, on_i=own.rest - of_j * gap, on_j=own.rest + ~of_j * gap)
            there = seated(placed(moved_on, blocks), blocks, assembly.size)
            left, before = trimmed(there, blocks, assembly.size), False
        else:
            left, before = [], ends in flat
            if not before:
                shared = _shared(assembly, ends, [own])
                left = [replace(one, pressed=np.repeat(own.pressed, len(one))) for one in shared]
            flat.setdefault(ends, []).append(own)
        said += [] if left or before else [f"{interface.name} slides off"]
        kept += left
        of += [np.full(len(one), k) for one in left]
    for i, j in _apart(assembly, MEETS * assembly.size).tolist() if flat else ():
        supports = not (assembly.model.free[i] or assembly.model.free[j])  # carry nothing between them
        near = (
            [] if supports else [one for ends, group in flat.items() if {i, j} & set(ends) for one in group]
        )
        shared = _shared(assembly, (i, j), near, MEETS) if near else []
        kept += shared
        of += [np.full(len(one), len(contacts)) for one in shared]
        said += [f"{one.interfaces[0].name} touches" for one in shared]
    found = together(kept)[np.argsort(np.concatenate(of), kind="stable")]
    return Assembly(joined(assembly, found), found), tuple(said)


def joined(assembly: Assembly, contacts: DisplacedContacts) -> Model:
    """Return the model with these contacts alone; SolveError where they leave a block in the air."""
    try:
        return replace(assembly.model, interfaces=contacts.interfaces)
    except ModelError as error:
        raise SolveError(f"blocks have lost all that they rest on: {error}") from error


def _shared(
    assembly: Assembly, ends: tuple[int, ...], like: list[DisplacedContacts], exactly: float | None = None
) -> list[DisplacedContacts]:
    """Contacts of two blocks, found anew, that are parallel to one of others and have its joint."""
    blocks = assembly.model.blocks
    faces = find_contacts([blocks[k] for k in ends], None, gap=exactly, angle=exactly).interfaces
    found = []
    for face in faces:
        joint = [own.interface.joint for own in like if parallel(own.axes_i[0], face.axes)]
        found += [replace(face, joint=joint[0])] if joint else []
    return [contacts_of(found, blocks)] if found else []


def parallel(axes: Array, others: Array) -> Flags:
    """Whether the normals of two sets of axes (..., 3, 3), rows, are."""
    cosine = np.einsum("...a,...a", axes[..., 2, :], others[..., 2, :])
    return np.asarray(np.abs(cosine) > 1.0 - PARALLEL)
