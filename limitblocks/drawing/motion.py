"""How blocks move in a result, scaled to be seen."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from limitblocks.arrays import Array
from limitblocks.errors import ModelError
from limitblocks.evidence.load_path_result import LoadPath
from limitblocks.geometry import Block
from limitblocks.model import Model, refuse_other

#: Largest displacement shown, over the diagonal of the structure, and largest rotation shown, rad.
SHOWN, TURN = 0.08, 0.25
#: Of the largest displacement rate: a block that moves less counts as standing still.
STILL = 1e-3
#: Of the size of the structure: places as near as that differ by rounding.
STANDS = 1e-12


class Motion(NamedTuple):
    """Displacements (k, n, 6) of n blocks in k states, as shown, and what they were multiplied by."""

    states: Array
    magnification: float


def motion(model: Model, result: Any) -> Motion:
    """Return the displacements of a result of `model`, scaled to be seen.

    One factor scales all: the largest displacement of a vertex becomes 8 % of the diagonal of the structure,
    or the largest rotation 0.25 rad where that is less.

    Parameters
    ----------
    model : Model
    result : LoadPath, or any result with `displacement_rates` (n, 6)
        A load path has a state a step; another result one state, the mechanism.

    Raises
    ------
    ModelError
        The result has no displacements, or belongs to another model.
    """
    refuse_other(model, result)
    n = len(model.blocks)
    if isinstance(result, LoadPath):
        states = np.array([step.displacements for step in result.steps], dtype=float)
    else:
        rates = getattr(result, "displacement_rates", None)
        if rates is None:
            raise ModelError(
                f"{type(result).__name__} has no displacement rates; expected a mechanism or a load path"
            )
        states = np.array([rates], dtype=float)
    if states.shape[1:] != (n, 6) or not np.isfinite(states).all():
        raise ModelError(
            f"the result has displacements of shape {states.shape[1:]}; the model has {n} blocks"
        )
    factor = magnification(model.blocks, states)
    return Motion(factor * states, factor)


def places(model: Model, result: Any) -> Array:
    """Return the displacements (k, n, 6) through which the blocks pass in a curve, at their true size.

    Parameters
    ----------
    model : Model
    result : CapacityCurve or SettlementCurve
        Its points have the displaced model. Translations are those of the centroids, m; rotations are the
        vectors of finite ones, rad.

    Raises
    ------
    ModelError
        The result belongs to another model.
    """
    refuse_other(model, result)
    states = np.zeros((len(result.points), len(model.blocks), 6))
    for state, point in zip(states, result.points, strict=True):
        for moved, rest, block in zip(state, model.blocks, point.model.blocks, strict=True):
            arms = block.vertices - block.centroid, rest.vertices - rest.centroid
            moved[:3] = block.centroid - rest.centroid
            moved[3:] = Rotation.align_vectors(*arms)[0].as_rotvec()
    points = np.concatenate([block.vertices for block in model.blocks])
    still = np.abs(states).max(axis=(0, 2)) <= STANDS * np.ptp(points, axis=0).max()
    return np.where(still[:, None], 0.0, states)


def displaced(block: Block, moved: Array) -> Array:
    """Return the displacements (n, 3), m, of the vertices of a block: v + w x r about its centroid."""
    return np.asarray(moved[:3] + np.cross(moved[3:], block.vertices - block.centroid))


def travel(blocks: Sequence[Block], moved: Array) -> Array:
    """Return the largest displacement of a vertex of each block, (n,), for displacements (n, 6)."""
    shifts = (displaced(block, one) for block, one in zip(blocks, moved, strict=True))
    return np.array([float(np.linalg.norm(shift, axis=1).max()) for shift in shifts])


def magnification(blocks: Sequence[Block], moved: Array) -> float:
    """Return by how much displacements (n, 6) or (k, n, 6) are drawn larger; 0 where nothing moves."""
    states = moved.reshape(-1, len(blocks), 6)
    largest = max(float(travel(blocks, state).max()) for state in states)
    if largest == 0.0:
        return 0.0
    turn = float(np.linalg.norm(states[..., 3:], axis=-1).max())
    points = np.concatenate([block.vertices for block in blocks])
    diagonal = float(np.linalg.norm(np.ptp(points, axis=0)))
    return min(SHOWN * diagonal / largest, TURN / turn if turn > 0.0 else np.inf)
