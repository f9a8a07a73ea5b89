"""Broad phase: which axis-aligned boxes in space overlap."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.spatial import cKDTree

from limitblocks.arrays import Array, Indices


def neighbours(points: Sequence[Array], tolerance: float) -> Indices:
    """Return the pairs (p, 2) of bodies, (n, 3) each, whose bounds, widened by `tolerance`, overlap."""
    low, high = bounds_of(points)
    return overlapping_boxes(low - tolerance, high + tolerance)


def bounds_of(points: Sequence[Array]) -> tuple[Array, Array]:
    """Return the least and the greatest corner (b, 3) of bodies, (n, 3) each."""
    return np.array([body.min(axis=0) for body in points]), np.array([body.max(axis=0) for body in points])


def overlapping_boxes(low: Array, high: Array) -> Indices:
    """Return the pairs i < j of boxes that overlap or touch, shape (p, 2), in lexicographic order.

    Boxes are classed by their half-dimension in powers of two; each class is sought among the boxes of its
    own and smaller classes, so that one large support does not widen the search for all.

    Parameters
    ----------
    low, high : Array, shape (n, 3)
        Least and greatest corner of each box.
    """
    middle, half = (low + high) / 2.0, (high - low).max(axis=1) / 2.0
    level = np.ceil(np.log2(half))
    near_boxes = []
    for k in np.unique(level):
        large, others = np.flatnonzero(level == k), np.flatnonzero(level <= k)
        radius = half[large].max() + half[others].max()
        near = cKDTree(middle[large]).sparse_distance_matrix(
            cKDTree(middle[others]), radius * (1.0 + 1e-9), p=np.inf, output_type="ndarray"
        )
        near_boxes.append(np.column_stack([large[near["i"]], others[near["j"]]]))
    pairs = np.sort(np.concatenate(near_boxes), axis=1)
    i, j = pairs.T
    pairs = pairs[(i != j) & (low[i] <= high[j]).all(axis=1) & (low[j] <= high[i]).all(axis=1)]
    return np.asarray(np.unique(pairs, axis=0))
