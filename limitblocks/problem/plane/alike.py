"""Which rows of two places are the same, whatever their order and whatever turns their cones."""

from __future__ import annotations

import numpy as np

from limitblocks.arrays import Array, Indices
from limitblocks.problem.cones import Cones
from limitblocks.problem.plane.places import Place
from limitblocks.problem.plane.rounding import close, size_of


def alike(kind: Place, own: Indices, other: Indices, turn: Array | None) -> Indices | None:
    """Which linear row or cone (K, members) of sorts `other` (K,) each one of `own` is, its stresses turned.

    None where one is like none. Cones are alike where their heads are, and the lengths of their other rows.
    """
    turned, there = numbers(kind, own, turn), numbers(kind, other, None)
    scale = size_of(there)
    turned, there = turned / scale, there / scale
    cones = Cones.of_sizes(kind.linear, kind.cones)
    partners, first = [], 0
    for rows in (np.arange(cones.linear)[:, None], *cones.groups):
        a, b = length_of(turned[:, rows]), length_of(there[:, rows])
        here, there_too = in_order(a), in_order(b)
        pair = [np.take_along_axis(v, at[..., None], 1) for v, at in ((a, here), (b, there_too))]
        if not close(pair[0], pair[1], 1.0):
            return None
        partner = np.empty_like(here)
        np.put_along_axis(partner, here, first + there_too, axis=1)
        partners.append(partner)
        first += len(rows)
    return np.concatenate(partners, axis=1)


def numbers(kind: Place, sort: Indices, turn: Array | None) -> Array:
    """Rows of F, g and G (K, r, 2 c + 1) of sorts (K,), of turned stresses."""
    F, g, G = kind.F[sort], kind.g[sort][..., None], kind.G[sort]
    return np.concatenate([F, g, G] if turn is None else [F @ turn, g, G @ turn], axis=2)


def in_order(values: Array) -> Indices:
    """An order (K, L) of values (K, L, n) that puts equal ones beside each other, whatever theirs was."""
    mix = np.cos(np.arange(values.shape[2]) ** 2 + 1.0)  # numbers without a pattern: unlike values differ
    with np.errstate(invalid="ignore"):
        return np.argsort(values @ mix, axis=1)


def length_of(rows: Array) -> Array:
    """Head of linear rows or cones (K, L, size, n) and products of their other rows: what no turn changes."""
    rest = rows[:, :, 1:]
    if not rest.shape[2]:
        return np.asarray(rows[:, :, 0])
    products = np.einsum("klri,klrj->klij", rest, rest).reshape(*rows.shape[:2], -1)
    return np.concatenate([rows[:, :, 0], products], axis=2)
