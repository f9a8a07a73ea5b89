"""The cone K of yield rows: a nonnegative orthant and second-order cones; all of its geometry, once.

Sources: Alizadeh & Goldfarb (2003), Second-order cone programming, Mathematical Programming 95, Section 4
(Jordan products, arrow matrices); the rest is plain geometry of t >= ||z||.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations, groupby
from typing import Any

import numpy as np

from limitblocks.arrays import Array, Indices

FLAT = 1e-13  # of the terms of a discriminant: below it a direction runs along the boundary to the apex
TINY = np.finfo(float).tiny


@dataclass(frozen=True)
class Cones:
    """The cone K: `linear` rows of the nonnegative orthant, then (count, size) second-order cones t >= ||z||.

    K is self-dual. Rows come in this order; whatever has one number for each linear row and each cone has
    shape (degree,).
    """

    linear: int
    second_order: tuple[tuple[int, int], ...] = ()

    @classmethod
    def of_sizes(cls, linear: int, sizes: Sequence[int]) -> Cones:
        """Return the cone of `linear` rows and then second-order cones of these sizes, in this order."""
        return cls(linear, tuple((len(list(same)), size) for size, same in groupby(sizes)))

    @property
    def degree(self) -> int:
        """Number of linear rows and cones."""
        return self.linear + sum(count for count, _ in self.second_order)

    @property
    def height(self) -> int:
        """Number of rows R."""
        return self.linear + sum(count * size for count, size in self.second_order)

    @cached_property
    def groups(self) -> tuple[Indices, ...]:
        """Places of the rows of each group of second-order cones, shapes (count, size)."""
        first, groups = self.linear, []
        for count, size in self.second_order:
            groups.append(first + np.arange(count * size).reshape(count, size))
            first += count * size
        return tuple(groups)

    @cached_property
    def heads(self) -> Indices:
        """First row of each linear row and each cone, shape (degree,)."""
        return np.concatenate([np.arange(self.linear), *(index[:, 0] for index in self.groups)])

    @cached_property
    def member(self) -> Indices:
        """Which linear row or cone each row belongs to, shape (R,)."""
        sizes = [np.ones(self.linear, dtype=int)] + [np.full(count, k) for count, k in self.second_order]
        return np.repeat(np.arange(self.degree), np.concatenate(sizes))

    @cached_property
    def identity(self) -> Array:
        """The centre of the cone: 1 for linear rows, (1, 0, ...) for second-order cones."""
        centre = np.zeros(self.height)
        centre[self.heads] = 1.0
        return centre

    def margin(self, rows: Array) -> Array:
        """Return how far each linear row and each cone is inside K: s, or t - ||z||; negative outside."""
        cones = [_stack(rows, index) for index in self.groups]
        return np.concatenate([rows[: self.linear], *(v[:, 0] - lengths(v[:, 1:]) for v in cones)])

    def nearest(self, rows: Array) -> Array:
        """Return the nearest point of K: max(s, 0), or the mean of t >= 0 and ||z|| along z."""
        near = np.maximum(rows, 0.0)
        for index in self.groups:
            v, nearest = _stack(rows, index), _stack(near, index)
            t, norm = v[:, 0], lengths(v[:, 1:])
            nearest[:, 0] = head = np.where(norm <= t, t, np.maximum(t + norm, 0.0) / 2.0)
            nearest[:, 1:] = v[:, 1:] * (head / np.maximum(np.maximum(norm, head), TINY))[:, None]
        return near

    def norm(self, rows: Array) -> Array:
        """Return the Euclidean length of each linear row and each cone, shape (degree,)."""
        return np.sqrt(np.bincount(self.member, weights=rows * rows, minlength=self.degree))

    def longest(self, v: Array, dv: Array) -> float:
        """Return the largest t with v + t dv in K, for v in K; infinite if there is none."""
        a, b = v[: self.linear], dv[: self.linear]
        t = float(np.min(np.maximum(a[b < 0.0], 0.0) / -b[b < 0.0], initial=np.inf))
        for index in self.groups:
            t = min(t, float(_longest(v[index], dv[index]).min(initial=np.inf)))
        return t

    def share(self, held: Array, rest: Array, noise: float = 0.0) -> Array:
        """Return the least s in 0 to 1 with s held + rest in K, for held in K; 1 at yield, (degree,).

        Where what is held is at most `noise` it is 1 if anything is asked of it.
        """
        parts = [ratio(-rest[: self.linear], held[: self.linear], noise)]
        for index in self.groups:
            a, b = held[index], rest[index]
            aa, bb = _determinant(a), _determinant(b)
            ab = a[:, 0] * b[:, 0] - (a[:, 1:] * b[:, 1:]).sum(axis=1)
            parts.append(ratio(np.sqrt(np.maximum(ab**2 - aa * bb, 0.0)) - ab, aa, noise))
        return np.concatenate(parts)

    def product(self, a: Array, b: Array) -> Array:
        """Return a o b: row by row, and (a.b, a0 bz + b0 az) for a second-order cone."""
        rows = a * b
        for index in self.groups:
            p, q = a[index], b[index]
            rows[index] = p[:, :1] * q + q[:, :1] * p
            rows[index[:, 0]] = (p * q).sum(axis=1)
        return rows

    def arrow_entries(self, v: Array) -> tuple[Array, Indices, Indices]:
        """Return the entries of L(v), L(v) w = v o w, zeros among them, their rows and columns."""
        blocks = []
        for index in self.groups:
            w = v[index]
            block = w[:, :1, None] * np.eye(w.shape[1])
            block[:, 0, 1:] = block[:, 1:, 0] = w[:, 1:]
            blocks.append(block)
        return np.concatenate([v[: self.linear], *(block.ravel() for block in blocks)]), *self._places

    @cached_property
    def _places(self) -> tuple[Indices, Indices]:
        """Rows and columns of linear rows and of the blocks of cones."""
        k = np.arange(self.linear)
        rows = (index.repeat(index.shape[1]) for index in self.groups)
        columns = (index.repeat(index.shape[1], axis=0).ravel() for index in self.groups)
        return np.concatenate([k, *rows]), np.concatenate([k, *columns])


def rays(size: int, count: int) -> Array:
    """Return rays (1, d) on the boundary of a cone, `count` in each plane of two axes d, shape (k, size)."""
    if size < 3:  # |z| = t at two rays, or no z at all
        return np.array([[1.0, 1.0], [1.0, -1.0]])[: max(size, 1), :size]
    angles = 2.0 * np.pi * np.arange(count) / count
    kept = []
    for pair in combinations(range(1, size), 2):
        ray = np.eye(1, size).repeat(count, axis=0)
        ray[:, list(pair)] = np.stack([np.cos(angles), np.sin(angles)], axis=1)
        kept.append(ray)
    return np.concatenate(kept)


def lengths(z: Array) -> Array:
    """Return the Euclidean lengths of vectors (k, d), those of few components faster than NumPy."""
    return np.asarray(np.sqrt(np.einsum("kd,kd->k", z, z)))


def _stack(rows: Array, index: Indices) -> Array:
    """The rows of a group of cones (count, size), not copied."""
    return rows[index[0, 0] : index[-1, -1] + 1].reshape(index.shape)


def _determinant(v: Array) -> Array:
    return np.asarray(v[:, 0] ** 2 - (v[:, 1:] ** 2).sum(axis=1))


def _longest(v: Array, d: Array) -> Array:
    """Largest t with v + t d in each cone (k, size), in closed form; every v is in it."""
    a, z, b, w = v[:, 0], v[:, 1:], d[:, 0], d[:, 1:]
    # A t^2 + 2 B t + C, which is at least zero inside
    A, B, C = _determinant(d), a * b - (z * w).sum(axis=1), np.maximum(_determinant(v), 0.0)
    root = np.sqrt(np.maximum(B**2 - A * C, 0.0))
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        first = np.where(root > B, C / (root - B), 0.0)
        first = np.where((B > 0.0) & (A < 0.0), (B + root) / -A, first)  # this form does not cancel
        terms = np.abs(A) / b**2, np.abs(B) / np.maximum(-a * b, TINY), C / np.maximum(a**2, TINY)
        along = (b < 0.0) & (np.max(terms, axis=0) < FLAT)  # the boundary to the apex
        first = np.where(along, a / -b, first)
    return np.where(b >= np.linalg.norm(w, axis=1), np.inf, first)


def ratio(used: Any, available: Any, noise: float) -> Array:
    """Quotient in 0 to 1; where nothing is available it is 1 if anything is used."""
    safe = np.where(available > noise, available, 1.0)
    return np.asarray(
        np.where(available > noise, np.clip(used / safe, 0.0, 1.0), 1.0 * (used > noise)), dtype=float
    )
