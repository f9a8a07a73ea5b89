"""How accurate the faces of blocks are, and the tolerances of contacts that belong to it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import NamedTuple

import numpy as np
import shapely

from limitblocks.arrays import Array, Indices, real
from limitblocks.errors import ModelError
from limitblocks.geometry.block import Block
from limitblocks.geometry.faces import all_faces, opposed
from limitblocks.geometry.neighbours import neighbours
from limitblocks.geometry.patches import patches

#: Tolerances of blocks drawn exactly: gap and width in block lengths, angle in rad.
GAP, ANGLE = 1e-3, 1e-2
#: Gap and width over the accuracy. Vertices off by up to n in each coordinate (n is 1.9 times the accuracy)
#: leave gaps up to 3 n and strips up to 2 n wide: scripts/noise measures both.
GAPS = 6.0
#: Angle over the median angle between faces that touch: scripts/noise finds up to 5.4.
ANGLES = 8.0
#: Accuracy, in block lengths, beyond which load factors are no longer right within 1 %: scripts/noise.
COARSEST = 2e-3
#: Facets of a contact that make a rough face, and the accuracy beyond which that is no drawing.
_FACETS, _SMOOTH = 3, 1e-5
#: Gap in block lengths and angle in rad within which faces are compared; beyond the tolerances of COARSEST.
_REACH, _TURN = 2.0 * GAPS * COARSEST, 0.2
#: Distance of blocks that may touch, in block lengths.
_NEAR = 1e-2
#: Share of the smaller face that a joint covers, fewest joints that tell noise from a wedge, most looked at.
_COVERED, _FEWEST, _MOST = 0.2, 8, 2000


@dataclass(frozen=True)
class Tolerances:
    """What counts as touching; lengths are in block lengths, the median cube root of the blocks' volumes.

    Attributes
    ----------
    gap : float
        Largest distance between two faces that touch, also where they interpenetrate.
    angle : float
        Largest angle between them, rad.
    width : float
        Least mean width (area over half the perimeter) of an interface; what is narrower is a strip.
    accuracy : float
        Of the vertices, as the faces that touch show it: the median of half the variation of the gap over
        a joint. About the standard deviation of a coordinate, in block lengths; None where there are fewer
        than 8 joints, which do not tell noise from a wedge.
    """

    gap: float = GAP
    angle: float = ANGLE
    width: float = GAP
    accuracy: float | None = None

    def __post_init__(self) -> None:
        for name, value in asdict(self).items():
            if value is not None and np.isnan(real(value)):
                raise ModelError(f"{name} of the tolerances is {value!r}, expected a number")

    def in_words(self, length: float) -> str:
        """Return the tolerances as text, for blocks of `length`, m."""
        return (
            f"gap {millimetres(self.gap * length)}, angle {self.angle:.2g} rad, "
            f"least width {millimetres(self.width * length)}"
        )

    def to_dict(self) -> dict[str, float | None]:
        """Return the numbers by name."""
        return asdict(self)


def millimetres(length: float) -> str:
    """Return a length in m as text, in mm where two digits are enough."""
    return f"{1e3 * length:.2g} mm" if length < 0.0995 else f"{length:.4g} m"


def block_length(blocks: Sequence[Block]) -> float:
    """Return the median over the blocks of the cube root of their volume, m."""
    return float(np.median(np.cbrt([block.volume for block in blocks])))


class Accuracy(NamedTuple):
    """What faces that touch show: vertices good to `size` block lengths, faces `angle` apart, rad."""

    size: float | None = None
    angle: float = 0.0

    @classmethod
    def shown(cls, blocks: Sequence[Block]) -> Accuracy:
        """Return the accuracy of blocks as the faces show it that touch, or nearly."""
        if len(blocks) < 2:
            return cls()
        centre = np.mean([block.vertices.mean(axis=0) for block in blocks], axis=0)
        points = [block.vertices - centre for block in blocks]
        return cls.of(blocks, points, neighbours(points, _NEAR * block_length(blocks)))

    @classmethod
    def of(cls, blocks: Sequence[Block], points: Sequence[Array], pairs: Indices) -> Accuracy:
        """Return the accuracy of blocks with vertices `points` about the centre of their model.

        What varies over a joint counts, not its width: joints drawn open evenly are no noise. `pairs` (p, 2)
        are blocks that may touch.
        """
        if len(pairs) < _FEWEST:
            return cls()
        length = block_length(blocks)
        used, local = np.unique(pairs[:: 1 + len(pairs) // _MOST], return_inverse=True)
        reach = _REACH * length
        faces = all_faces([blocks[k] for k in used], [points[k] for k in used], reach / 4.0, _TURN / 4.0)
        seen = patches(faces, *opposed(faces, local.reshape(-1, 2), reach, _TURN), length)
        covered = shapely.area(seen.shape) / np.minimum(faces.area[seen.a], faces.area[seen.b])
        joints = seen.of((covered > _COVERED) & (np.abs(seen.gap) <= reach))
        if len(joints.a) < _FEWEST:
            return cls()
        return cls(float(np.median(joints.spread)) / length, float(np.median(joints.angle)))


_UNKNOWN = Accuracy()


def chosen(
    gap: float | None, angle: float | None, width: float | None, accuracy: Accuracy = _UNKNOWN
) -> Tolerances:
    """Return the tolerances: those given, the others by the accuracy.

    Raises
    ------
    ModelError
        A tolerance given is out of range.
    """
    faults = []
    for name, value in (("gap", gap), ("width", width)):
        if value is not None and not 0.0 < real(value) < 1.0:
            faults.append(f"{name} is {value!r}; a tolerance between 0 and 1 block lengths is needed")
    if angle is not None and not 0.0 < real(angle) < np.pi / 4:
        faults.append(f"angle is {angle!r}; a tolerance between 0 and pi/4 rad is needed")
    if faults:
        raise ModelError(*faults)
    gap = max(GAP, GAPS * (accuracy.size or 0.0)) if gap is None else gap
    angle = max(ANGLE, min(ANGLES * accuracy.angle, _TURN)) if angle is None else angle
    return Tolerances(gap, angle, gap if width is None else width, accuracy.size)


def too_coarse(accuracy: float | None, length: float, facets: int) -> str:
    """Say why faces with an accuracy, in block lengths of `length`, m, do not do; empty where they do.

    `facets` are those through which two blocks touch.
    """
    size = accuracy or 0.0
    good = f"the faces that touch are good to about {millimetres(size * length)} only"
    wrong = "the load factor may be off by more than 1 %"
    remedy = "mend the blocks first (limitblocks.heal, import --heal), or give gap to take them as they are"
    if size > COARSEST:
        coarsest = f"{millimetres(COARSEST * length)} for blocks of {length:.3g} m"
        return f"{good}; beyond {coarsest} {wrong}: {remedy}"
    if size > _SMOOTH and facets >= _FACETS:
        return f"{good}, and two blocks touch through {facets} facets, so that {wrong}: {remedy}"
    return ""
