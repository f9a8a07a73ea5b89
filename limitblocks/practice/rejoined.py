"""Contacts of displaced blocks brought together and found anew."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import lsmr

from limitblocks.arrays import Array
from limitblocks.errors import SolveError
from limitblocks.geometry import find_interfaces
from limitblocks.geometry.overlap import find_overlaps
from limitblocks.practice.displaced import (
    CLOSED,
    Assembly,
    Contact,
    Truths,
    contact,
    moved,
    placed,
)

MEETS = 1e-6  # of the size of the structure: a deeper overlap of blocks counts
ROUNDS = 20  # of Newton's method for the gaps; it converges quadratically
PARALLEL = 1e-6  # cosine from one of faces that slide on one another all over


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
        rows = rows_of(assembly)[wanted.ravel()] @ sparse.diags_array(scale.ravel())
        step = lsmr(rows, -way[wanted], atol=1e-15, btol=1e-15, maxiter=20 * rows.shape[1])[0]
        assembly = moved(assembly, (scale.ravel() * step).reshape(-1, 6))
    return assembly, left


def rows_of(assembly: Assembly) -> sparse.csr_array:
    """Return the rates of the ways of all contacts in the rates of the blocks, shape (3 k, 6 n)."""
    centres = np.stack([block.centroid for block in assembly.model.blocks])
    parts = [
        (sign, own.ends[side], points, own.half_way)
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

    Raises
    ------
    SolveError
        If they share none any more, or in other parts.
    """
    contacts = tuple(
        _found_anew(assembly, own) if slides and not own.tied else own
        for own, slides in zip(assembly.contacts, sliding, strict=True)
    )
    model = replace(assembly.model, interfaces=tuple(own.interface for own in contacts))
    return Assembly(model, contacts)


def _found_anew(assembly: Assembly, own: Contact) -> Contact:
    if not _parallel(own.axes_i, own.axes_j) or np.ptp(own.ways[:, 2]) > CLOSED * assembly.size:
        moved_on = replace(own, on_i=own.on_j - own.ways[:, 2:] * own.half_way[2])
        return replace(moved_on, interface=placed(moved_on))
    now = own.interface
    blocks = assembly.model.blocks
    faces = find_interfaces([blocks[k] for k in own.ends], now.joint)
    shared = [face for face in faces if _parallel(face.axes, now.axes)]
    parts = [
        one for one in assembly.contacts if one.ends == own.ends and _parallel(one.interface.axes, now.axes)
    ]
    if not shared:
        raise SolveError(f"{now.block_j!r} slides off {now.block_i!r}")
    if len(shared) != len(parts):
        raise SolveError(f"{now.block_j!r} slides on {now.block_i!r} to an area of {len(shared)} parts")
    return contact(shared[parts.index(own)], {block.name: k for k, block in enumerate(blocks)})


def _parallel(axes: Array, others: Array) -> bool:
    return bool(axes[2] @ others[2] > 1.0 - PARALLEL)
