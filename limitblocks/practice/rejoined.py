"""Contacts of displaced blocks brought together and found anew."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import lsmr

from limitblocks.arrays import Array, Indices
from limitblocks.errors import ModelError, SolveError
from limitblocks.geometry import find_contacts
from limitblocks.geometry.neighbours import neighbours
from limitblocks.geometry.overlap import find_overlaps
from limitblocks.joints import Dowel
from limitblocks.model import Model
from limitblocks.practice.contact import CLOSED, Contact, Truths, contact, placed, seated
from limitblocks.practice.displaced import Assembly, moved
from limitblocks.practice.resting import PARALLEL
from limitblocks.practice.trimmed import trimmed

MEETS = 1e-6  # of the size of the structure: a deeper overlap of blocks counts
DAMP = 1e-4  # closes a gap by at most 1 / (2 DAMP) of it: contacts that fit at first order alone move far
ROUNDS = 20  # of Newton's method for the gaps; it converges quadratically


def closed_up(
    assembly: Assembly, held: list[Truths], sliding: list[bool], along: Array | None = None
) -> tuple[Assembly, float]:
    """Return the nearest structure in which the corners `held` have no gap, and the largest that is left, m.

    `held` has an array (k,) a contact. Where a contact does not slide its held corners coincide; a tie keeps
    its length alone. The way back along the displacements `along`, shape (n, 6), is barred unless a support
    led the motion; what then cannot but open opens: rates tell of the first order of a motion alone.
    """
    normal = np.concatenate(held)
    fixed = [not (slides or own.tied) for own, slides in zip(assembly.contacts, sliding, strict=True)]
    stuck = np.repeat(fixed, [len(own) for own in held])
    size = np.array([block.size for block in assembly.model.blocks])
    scale = np.repeat(np.stack([np.ones_like(size), 1.0 / size], axis=1), 3, axis=1)
    supports = ~assembly.model.free
    along = None if along is None or along[supports].any() else along
    barred = np.zeros((0, scale.size)) if along is None else (along / scale).reshape(1, -1)
    barred = barred / np.maximum(np.linalg.norm(barred, axis=1, keepdims=True), 1e-300)
    scale[supports] = 0.0
    while True:
        wanted = np.stack([normal & stuck, normal & stuck, normal], axis=1)
        goal, way, left = _closed(assembly, wanted, scale, barred)
        opens = normal & (way[:, 2] > CLOSED * assembly.size)
        if along is None or not opens.any():
            return goal, left
        normal &= ~opens


def _closed(assembly: Assembly, wanted: Truths, scale: Array, barred: Array) -> tuple[Assembly, Array, float]:
    """Newton's method for the ways `wanted`, shape (k, 3): the structure, its ways and the largest, m."""
    left = np.inf
    for _ in range(ROUNDS):
        way = np.where(wanted, np.concatenate([own.ways for own in assembly.contacts]), 0.0)
        last, left = left, float(np.abs(way).max(initial=0.0))
        if left == 0.0 or left > last / 2.0:  # rounding is reached
            break
        rows = rows_of(assembly)[wanted.ravel()] @ sparse.diags_array(scale.ravel())
        rows = sparse.vstack([rows, sparse.csr_array(barred)])
        lack = np.append(-way[wanted], np.zeros(len(barred)))
        step = lsmr(rows, lack, DAMP, atol=1e-15, btol=1e-15, maxiter=20 * rows.shape[1])[0]
        assembly = moved(assembly, (scale.ravel() * step).reshape(-1, 6))
    return assembly, way, left


def rows_of(assembly: Assembly) -> sparse.csr_array:
    """Return the rates of the ways of all contacts in the rates of the blocks, shape (3 k, 6 n)."""
    centres = np.stack([block.centroid for block in assembly.model.blocks])
    parts = [
        (sign, own.ends[side], own.rest, own.axes)
        for own in assembly.contacts
        for side, sign in ((0, -1.0), (1, 1.0))
    ]
    data, rows, columns, start = [], [], [], 0
    for number, (sign, k, points, axes) in enumerate(parts):
        turn = np.cross((points - centres[k])[:, None, :], axes)  # a . (w x r) = w . (r x a)
        values = sign * np.concatenate([axes, turn], axis=2)
        data.append(values.ravel())
        rows.append(np.repeat(start + np.arange(3 * len(points)), 6))
        columns.append(np.tile(6 * k + np.arange(6), 3 * len(points)))
        start += 3 * len(points) * (number % 2)
    places = np.concatenate(rows), np.concatenate(columns)
    shape = start, 6 * len(assembly.model.blocks)
    return sparse.coo_array((np.concatenate(data), places), shape=shape).tocsr()


def meet(assembly: Assembly) -> bool:
    """Whether blocks that no interface joins overlap."""
    pairs = _apart(assembly, 0.0)
    points = [block.vertices for block in assembly.model.blocks]
    return bool(find_overlaps(assembly.model.blocks, points, pairs, MEETS * assembly.size))


def _apart(assembly: Assembly, reach: float) -> Indices:
    """Pairs of blocks (p, 2) that no interface joins and whose boxes come as near as `reach`, m."""
    joined = {tuple(sorted(own.ends)) for own in assembly.contacts}
    near = neighbours([block.vertices for block in assembly.model.blocks], reach / 2.0)
    return near[[tuple(pair) not in joined for pair in near.tolist()]]


def slid(assembly: Assembly, sliding: list[bool]) -> tuple[Assembly, tuple[str, ...]]:
    """Return the structure with the contacts that slide where they now are, and which were lost or found.

    Faces that slide flat on one another get the areas that they now share: one that shares none any more
    carries nothing, and is left out. A block that slides onto a further face rests on that as well. An opened
    joint that slides keeps the part whose closed corners are on both faces, and is left out once none is. A
    dowel that slides shears off, and is left out.
    """
    kept: list[Contact] = []
    flat: dict[tuple[int, int], list[Contact]] = {}
    said = []
    for own, slides in zip(assembly.contacts, sliding, strict=True):
        if not slides or own.tied:
            kept.append(own)
        elif isinstance(own.interface.joint, Dowel):
            said.append(f"{own.interface.name} shears off")
        elif not parallel(own.axes_i, own.axes_j) or np.ptp(own.ways[:, 2]) > CLOSED * assembly.size:
            gap, of_j = own.ways[:, 2:] * own.axes[:, 2], own.on_face_i[:, None]
            moved_on = replace(own, on_i=own.rest - of_j * gap, on_j=own.rest + ~of_j * gap)
            blocks = assembly.model.blocks
            there = seated(replace(moved_on, interface=placed(moved_on, blocks)), blocks, assembly.size)
            left = trimmed(there, blocks, assembly.size)
            said += [] if left else [f"{own.interface.name} slides off"]
            kept += left
        else:
            shared = [] if own.ends in flat else _shared(assembly, own.ends, [own])
            said += [] if shared or own.ends in flat else [f"{own.interface.name} slides off"]
            kept += [replace(one, pressed=own.pressed) for one in shared]
            flat.setdefault(own.ends, []).append(own)
    for i, j in _apart(assembly, MEETS * assembly.size).tolist() if flat else ():
        supports = not (assembly.model.free[i] or assembly.model.free[j])  # carry nothing between them
        near = (
            [] if supports else [one for ends, group in flat.items() if {i, j} & set(ends) for one in group]
        )
        shared = _shared(assembly, (i, j), near, MEETS) if near else []
        kept += shared
        said += [f"{shared[0].interface.name} touches"] if shared else []
    return Assembly(joined(assembly, kept), tuple(kept)), tuple(said)


def joined(assembly: Assembly, contacts: Iterable[Contact]) -> Model:
    """Return the model with these contacts alone; SolveError where they leave a block in the air."""
    try:
        return replace(assembly.model, interfaces=tuple(own.interface for own in contacts))
    except ModelError as error:
        raise SolveError(f"blocks have lost all that they rest on: {error}") from error


def _shared(
    assembly: Assembly, ends: tuple[int, int], like: list[Contact], exactly: float | None = None
) -> list[Contact]:
    """Contacts of two blocks, found anew, that are parallel to one of others and have its joint."""
    blocks = assembly.model.blocks
    place = {block.name: k for k, block in enumerate(blocks)}
    faces = find_contacts([blocks[k] for k in ends], None, gap=exactly, angle=exactly).interfaces
    found = []
    for face in faces:
        joint = [own.interface.joint for own in like if parallel(own.axes_i, face.axes)]
        found += [contact(replace(face, joint=joint[0]), blocks, place)] if joint else []
    return found


def parallel(axes: Array, others: Array) -> bool:
    """Whether the normals of two sets of axes (3, 3), rows, are."""
    return bool(abs(axes[2] @ others[2]) > 1.0 - PARALLEL)
