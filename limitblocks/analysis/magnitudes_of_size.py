"""Slips in size: another unit of length, and coordinates far from the origin."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from limitblocks.arrays import Array

#: Sizes of a structure, m, beyond which the unit of length may be another one.
_LARGE, _SMALL = 3e2, 5e-2
#: Rounding of coordinates, of the size of a structure, beyond which load factors may be off by 1e-6.
_ROUGH = 1e-7


def of_size(size: float) -> list[str]:
    """Return the question for the largest dimension of a structure, m."""
    if size > _LARGE:
        return [f"the structure is {size:.4g} m large: millimetres? then {size / 1e3:.4g} m; see units"]
    if size < _SMALL:
        return [f"the structure is {size:.4g} m large: is it in metres? see units"]
    return []


def of_dimensions(dimensions: Mapping[str, float]) -> list[str]:
    """Return the question for the largest of the dimensions, m, that a structure is to be made of."""
    name = max(dimensions, key=dimensions.__getitem__, default="")
    if not name or dimensions[name] <= _LARGE:
        return []
    return [f"{name} is {dimensions[name]:g} m: millimetres? then {dimensions[name] / 1e3:g} m; see units"]


def of_place(corners: Array, size: float) -> list[str]:
    """Return the question for a structure so far from the origin that rounding changes its shape."""
    far = float(np.abs(corners).max())
    rounded = float(np.spacing(far))
    if rounded <= _ROUGH * size:
        return []
    return [
        f"the structure is {far:.4g} m off the origin, where coordinates are rounded to {rounded:.1g} m: "
        "move it to the origin"
    ]
