"""Yield rows on symmetric stresses: merged where they coincide, cones of one direction as two lines.

On stresses that the mirror leaves as they are a row and its mirror image are one row, and a cone t >= ||z||
whose z keeps one direction is t >= |z|. A row of the reduced problem is a sum of rows of the whole one with
weights from the dual cone, symmetric under the mirror: its multiplier times these weights are multipliers of
the whole problem that satisfy the flow rule out of the plane, too.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from functools import cached_property

import numpy as np

from limitblocks.arrays import Array, Flags, Indices, repeated
from limitblocks.problem.plane.alike import in_order, length_of
from limitblocks.problem.plane.mirror import Mirrored
from limitblocks.problem.plane.redundant import redundant
from limitblocks.problem.plane.rounding import EXACT, classes

CHUNK = 1000  # classes of places at a time: keeps the arrays small


class Choice(Enum):
    """Which rows are kept: those that two others do not imply, nor their flow where FLOWING, or every one."""

    FEW = "few"
    FLOWING = "flowing"
    EVERY = "every"


@dataclass(frozen=True, eq=False)
class PlaneRows:
    """Rows of the reduced problem of one `size`: 1 linear, else that of their cones.

    `source` (R',) is the row of the whole problem that each comes from; `weight`, `row`, `column` are
    triplets of the weights of rows of the whole problem in each.
    """

    size: int
    source: Indices
    weight: Array
    row: Indices
    column: Indices


@dataclass(frozen=True, eq=False)
class _Sets:
    """Rows of K places, or of K pairs of a place and its image, on the basis of their symmetric stresses.

    `places` is one or two, `values` (K, r, d + 1) are F x' + g over the largest of the set, `flow` (K, r, d)
    is G in this unit; `members` and `partner` as in :class:`~limitblocks.problem.plane.places.Place` and
    `Mirrored`, the first `linear` of them linear rows.
    """

    places: int
    values: Array
    flow: Array
    members: tuple[slice, ...]
    linear: tuple[bool, ...]
    partner: Indices

    @cached_property
    def start(self) -> Indices:
        """First row of each member."""
        return np.array([member.start for member in self.members])

    @cached_property
    def heads(self) -> Array:
        """Weights (K, members, r) of the head of each member and of its partner: half and half."""
        K, r, _ = self.values.shape
        own = np.broadcast_to(np.eye(r)[self.start], (K, len(self.members), r))
        return np.asarray((own + np.eye(r)[self.start[self.partner]]) / 2.0)


def plane_rows(kind: Mirrored, own: Indices, X: Array, choice: Choice, lines: bool) -> Iterator[PlaneRows]:
    """Rows of the places `own` (K,) and of their images on the stresses of the bases X (K, c, d).

    Cones of one direction become two linear rows where `lines`. Places with the same numbers are judged once.
    """
    first, of_place = classes(np.stack([kind.sort[own], kind.sort[kind.image[own]]], axis=1))
    members = np.split(np.argsort(of_place, kind="stable"), np.cumsum(np.bincount(of_place))[:-1])
    places = np.concatenate([kind.places.rows[there] for there in _pair(kind, own)], axis=1)
    for at in range(0, len(first), CHUNK):
        chunk = slice(at, at + CHUNK)
        for rows in _rows(_sets(kind, own[first[chunk]], X[first[chunk]]), choice, lines):
            yield _everywhere(places, rows, members[chunk])


def _pair(kind: Mirrored, own: Indices) -> list[Indices]:
    """The places, and their images where these are others."""
    image = kind.image[own]
    return [own] if (image == own).all() else [own, image]


def _rows(sets: _Sets, choice: Choice, as_lines: bool) -> Iterator[_Rows]:
    """Rows of each set: cones, but for those of no direction, or of one where it gives lines; and lines."""
    lines = [sets.heads[:, np.array(sets.linear)]]
    valid = [np.ones(lines[0].shape[:2], dtype=bool)]
    for size in sorted({m.stop - m.start for m in sets.members} - {1}):
        cones = _cones(sets, size)
        lines += [cones.weight[:, :, 0] + sign * cones.weight[:, :, 1] for sign in (1.0, -1.0)]
        valid += [cones.valid & (cones.rank <= as_lines), cones.valid & (cones.rank == 1) & as_lines]
        yield from _kept(cones, int(as_lines))
    yield _lines(sets, np.concatenate(lines, axis=1), np.concatenate(valid, axis=1), choice)


def _sets(kind: Mirrored, own: Indices, X: Array) -> _Sets:
    p, there = kind.places, _pair(kind, own)
    sorts, bases = [p.sort[k] for k in there], [X, kind.turn[own] @ X]
    values = np.concatenate(
        [np.concatenate([p.F[k] @ Y, p.g[k][..., None]], axis=2) for k, Y in zip(sorts, bases, strict=False)],
        axis=1,
    )
    size = np.abs(values).max(axis=(1, 2), keepdims=True)
    r, count = p.rows.shape[1], len(p.members)
    ats = (1, 0) if kind.paired[own].all() else (0, 1)  # partners are in the image, or in the place itself
    return _Sets(
        places=len(there),
        values=values / size,
        flow=np.concatenate([p.G[k] @ Y for k, Y in zip(sorts, bases, strict=False)], axis=1) / size,
        members=tuple(slice(m.start + k * r, m.stop + k * r) for k in range(len(there)) for m in p.members),
        linear=tuple(k < p.linear for k in range(count)) * len(there),
        partner=np.concatenate(
            [kind.partner[k] + at * count for k, at in zip(there, ats, strict=False)], axis=1
        ),
    )


@dataclass(frozen=True, eq=False)
class _Rows:
    """Reduced rows (c, size) of the sets `k` (c,): their `source` among rows there, and weights of these."""

    size: int
    k: Indices
    weight: Array
    source: Indices


@dataclass(frozen=True, eq=False)
class _Cones:
    """Cones of one size: weights (K, L, z + 1, r) of rows in head and directions, and how many of these.

    `valid` (K, L) marks those that stand for all that are the same; `start` (L,) are their first rows.
    """

    weight: Array
    rank: Indices
    valid: Flags
    start: Indices


def _cones(sets: _Sets, size: int) -> _Cones:
    """Cones whose rows below the head are put in as few directions as they take."""
    which = [k for k, m in enumerate(sets.members) if m.stop - m.start == size]
    start = sets.start[which]
    E = sets.values[:, start[:, None] + np.arange(size)]
    stands, share = _same(length_of(E))
    z = E[:, :, 1:]
    _, S, Vt = np.linalg.svd(z, full_matrices=False)
    kept = S > EXACT
    rank = kept.sum(axis=2)
    directions = (S * kept)[..., None] * Vt
    if directions.shape[2] == size - 1:
        directions = np.where((rank == size - 1)[..., None, None], z, directions)
    directions = np.take_along_axis(directions, stands[..., None, None], axis=1)
    inverse = np.linalg.pinv(directions, rcond=EXACT)
    K, r, _ = sets.values.shape
    weight = np.zeros((K, len(which), directions.shape[2] + 1, r))
    weight[:, :, 0] = sets.heads[:, which]
    place = np.arange(K)[:, None, None]
    for first in (np.broadcast_to(start, stands.shape), sets.start[sets.partner[:, which]]):
        at = first[..., None] + np.arange(1, size)
        frame = sets.values[place, at] @ inverse
        rows = np.zeros((K, len(which), size - 1, r))
        np.put_along_axis(rows, at[..., None], 0.5, axis=3)
        weight[:, :, 1:] += np.einsum("klzq,klzr->klqr", frame, rows)
    mean = np.einsum("klm,kmzr->klzr", share, weight)
    return _Cones(mean, rank, stands == np.arange(len(which)), start)


def _kept(cones: _Cones, lines: int) -> Iterator[_Rows]:
    """Cones of more directions than become `lines`."""
    for rank in np.unique(cones.rank[cones.valid & (cones.rank > lines)]).tolist():
        k, which = np.nonzero(cones.valid & (cones.rank == rank))
        weight = cones.weight[k, which, : rank + 1]
        yield _Rows(rank + 1, k, weight, cones.start[which][:, None] + np.arange(rank + 1))


def _lines(sets: _Sets, weight: Array, valid: Flags, choice: Choice) -> _Rows:
    """Linear rows, those that coincide, and flow alike where this counts, merged in their mean."""
    lines = weight @ sets.values
    flow = weight @ sets.flow if choice is Choice.FLOWING else None
    alike = lines if flow is None else np.concatenate([lines, flow], axis=2)
    stands, share = _same(np.where(valid[..., None], alike, np.inf))
    valid = valid & (stands == np.arange(valid.shape[1]))
    if choice is not Choice.EVERY:
        valid &= ~redundant(np.where(valid[..., None], lines, 0.0), valid, flow)
    k, which = np.nonzero(valid)
    mean = np.einsum("klm,kmr->klr", share, weight)[k, which][:, None]
    here = sets.values.shape[1] // sets.places  # rows of the place itself, not of its image
    return _Rows(1, k, mean, np.abs(mean[:, 0, :here]).argmax(axis=1)[:, None])


def _everywhere(places: Indices, rows: _Rows, members: list[Indices]) -> PlaneRows:
    """The rows of each set at all members of its class, as triplets; `places` (K, r) are the whole rows."""
    weight = np.where(np.abs(rows.weight) > EXACT, rows.weight, 0.0)
    count = np.array([len(members[k]) for k in rows.k], dtype=np.int64)
    place = np.concatenate([members[k] for k in rows.k]) if len(rows.k) else rows.k
    row, _ = repeated(count)
    entry, z, r = np.nonzero(weight)
    of_entry, position = repeated(count[entry])
    new = (np.cumsum(count) - count)[entry][of_entry] + position
    return PlaneRows(
        rows.size,
        places[place[:, None], rows.source[row]].ravel(),
        weight[entry, z, r][of_entry],
        new * rows.size + z[of_entry],
        places[place[new], r[of_entry]],
    )


def _same(values: Array) -> tuple[Indices, Array]:
    """The first member (K, L) with the same values, and the shares (K, L, L) of all of them in their mean."""
    K = len(values)
    order = in_order(values)
    there = np.take_along_axis(values, order[..., None], axis=1)
    with np.errstate(invalid="ignore"):
        new = ~(np.abs(np.diff(there, axis=1)) <= EXACT).all(axis=2)
    group = np.concatenate([np.zeros((K, 1), dtype=int), np.cumsum(new, axis=1)], axis=1)
    label = np.empty_like(group)
    np.put_along_axis(label, order, group, axis=1)
    same = label[:, :, None] == label[:, None]
    return same.argmax(axis=2), same / same.sum(axis=2, keepdims=True)
