"""What a result looks like in space: contact forces as arrows, and blocks where the mechanism takes them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from limitblocks.arrays import Array
from limitblocks.drawing.motion import motion
from limitblocks.errors import ModelError
from limitblocks.evidence.claim import claim_of, real_number
from limitblocks.geometry import Block
from limitblocks.geometry.ends import ends_of
from limitblocks.model import Model

#: Longest arrow, over the diagonal of the structure.
_LONGEST = 0.15
#: Of the largest force: below it a force has no direction worth an arrow, and no point of action.
_NOISE = 1e-7


@dataclass(frozen=True, eq=False)
class Picture:
    """A structure with the contact forces of a result, and its blocks displaced by the mechanism.

    Attributes
    ----------
    blocks, displaced : tuple of Block
        The blocks, and these as the mechanism moves them, if the result has one, as rigid bodies.
    names : tuple of str
        Of the interfaces.
    pairs : tuple of (int, int)
        Places of block i and block j of each interface among the blocks.
    fixed : tuple of bool
        Which blocks are supports.
    load_factor : float
    at : Array, shape (m, 3)
        Where the forces act: centres of pressure, (e1, e2) = (-M2, M1) / N off the centroids, or centroids
        where there is no pressure; global axes, m.
    force : Array, shape (m, 3)
        Force that block i exerts on block j, global axes, N; block i feels the opposite.
    moment : Array, shape (m, 3)
        Moment about `at` that block i exerts on block j, global axes, N m.
    scale : float
        Length of the arrow of 1 N, m.
    magnification : float
        What the displacement rates were multiplied by.
    """

    blocks: tuple[Block, ...]
    displaced: tuple[Block, ...]
    names: tuple[str, ...]
    pairs: tuple[tuple[int, int], ...]
    fixed: tuple[bool, ...]
    load_factor: float
    at: Array
    force: Array
    moment: Array
    scale: float
    magnification: float

    @property
    def tips(self) -> Array:
        """Ends of the arrows, (m, 3), m."""
        return np.asarray(self.at + self.scale * self.force)

    @property
    def drawn(self) -> list[int]:
        """Interfaces with a force that is worth an arrow."""
        sizes = np.linalg.norm(self.force, axis=1)
        return np.flatnonzero(sizes > _NOISE * sizes.max(initial=0.0)).tolist()


def picture(model: Model, result: Any, scale: float | None = None) -> Picture:
    """Return the forces and the displaced blocks of a result of `model`; of a load path, those at collapse.

    Parameters
    ----------
    model : Model
    result : any result with `load_factor` and `stress_resultants` (m, 6); `displacement_rates` (n, 6) or none
    scale : float, optional
        Length of the arrow of 1 N, m; left out, 1 m is 1, 2 or 5 times a power of ten, N, such that the
        longest arrow is at most 15 % of the diagonal of the structure.

    Raises
    ------
    ModelError
        The result has no forces, or belongs to another model; the scale is not above 0.
    """
    claim = claim_of(model, result)
    at, force, moment = _acting(model, claim.stress_resultants)
    length = _round(model, force) if scale is None else real_number("scale", scale)
    if length <= 0.0:
        raise ModelError(f"scale is {length:g} m/N, expected a length above 0 of the arrow of 1 N")
    moved: tuple[Block, ...] = ()
    magnification = 0.0
    if claim.displacement_rates is not None:
        (state,), magnification = motion(model, claim)
        moved = tuple(_moved(*pair) for pair in zip(model.blocks, state, strict=True))
    return Picture(
        tuple(model.blocks),
        moved,
        tuple(interface.name for interface in model.interfaces),
        tuple((i, j) for i, j in ends_of(model.blocks, model.interfaces).tolist()),
        tuple((~model.free).tolist()),
        claim.load_factor,
        at,
        force,
        moment,
        length,
        magnification,
    )


def _acting(model: Model, Q: Array) -> tuple[Array, Array, Array]:
    """Return where the forces of stress resultants (m, 6) act, the forces and the moments about there."""
    axes = np.array([interface.axes for interface in model.interfaces]).reshape(-1, 3, 3)
    force = -np.einsum("ma,mab->mb", Q[:, :3], axes)
    pressed = -Q[:, 2] > _NOISE * np.abs(Q[:, :3]).max(initial=0.0)
    N = np.where(pressed, Q[:, 2], 1.0)
    e = np.where(pressed[:, None], np.stack([-Q[:, 4], Q[:, 3]], axis=1) / N[:, None], 0.0)
    arm = np.einsum("ma,mab->mb", e, axes[:, :2])
    middle = np.array([interface.centroid for interface in model.interfaces]).reshape(-1, 3)
    moment = -np.einsum("ma,mab->mb", Q[:, 3:], axes) - np.cross(arm, force)
    return middle + arm, force, moment


def _round(model: Model, force: Array) -> float:
    """Return a scale in m/N whose inverse is a round number."""
    points = np.concatenate([block.vertices for block in model.blocks])
    longest = _LONGEST * float(np.linalg.norm(np.ptp(points, axis=0)))
    largest = float(np.linalg.norm(force, axis=1).max(initial=0.0))
    least = largest / longest if largest > 0.0 else 1.0
    power = 10.0 ** np.floor(np.log10(least))
    return 1.0 / float(next(power * step for step in (1.0, 2.0, 5.0, 10.0) if power * step >= least))


def _moved(block: Block, state: Array) -> Block:
    """Return a block after the displacement v of its centroid and the rotation w about it, true ones."""
    turn = Rotation.from_rotvec(state[3:]).as_matrix()
    return block.moved(turn, block.centroid + state[:3] - turn @ block.centroid)
