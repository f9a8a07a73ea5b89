"""From where a structure is seen."""

from __future__ import annotations

import numpy as np

from limitblocks.arrays import Array
from limitblocks.model import Model

#: Elevations and plan; rows: directions on the page to the right, up, and towards the eye.
PLANES = {
    "xz": np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]]),
    "yz": np.array([[0, 1.0, 0], [0, 0, 1], [1, 0, 0]]),
    "xy": np.array([[1.0, 0, 0], [0, 1, 0], [0, 0, 1]]),
}
#: Of the mean displacement rate: a component that is less, over the rates themselves, chooses no side.
_SLIGHT = 0.05
_ACROSS, _ALONG, _ABOVE = 0.8, 0.45, 0.4


def towards(model: Model, rates: Array | None = None) -> Array:
    """Return the unit vector from a structure to the eye: from above, on the side to which it moves.

    The longer horizontal side of the model runs across the page. Of the two ends of each horizontal axis the
    eye is at the one to which the blocks move in the mean, by volume; without a mechanism, or where they
    move to both, it is in front (-Y) and to the right (+X).

    Parameters
    ----------
    model : Model
    rates : Array, shape (n, 6), optional
        Displacement rates of the blocks.
    """
    points = np.concatenate([block.vertices for block in model.blocks])
    wide, deep, _ = np.ptp(points, axis=0)
    eye = np.array([_ALONG, -_ACROSS, _ABOVE] if wide >= deep else [_ACROSS, -_ALONG, _ABOVE])
    if rates is not None:
        volumes = np.array([block.volume for block in model.blocks])
        mean = volumes @ rates[:, :2]
        size = float(volumes @ np.linalg.norm(rates[:, :2], axis=1))
        sided = np.abs(mean) > _SLIGHT * size
        eye[:2] = np.where(sided, np.sign(mean) * np.abs(eye[:2]), eye[:2])
    return np.asarray(eye / np.linalg.norm(eye))


def view_of(eye: Array) -> Array:
    """Return rows right, up and towards the eye, shape (3, 3); seen from above, X is to the right."""
    eye = eye / np.linalg.norm(eye)
    right = np.cross([0.0, 0.0, 1.0], eye)
    size = float(np.linalg.norm(right))
    right = right / size if size > 1e-9 else np.array([1.0, 0.0, 0.0])
    return np.array([right, np.cross(eye, right), eye])
