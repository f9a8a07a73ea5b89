"""Blocks mended within their accuracy: facets made plane, faces that touch brought into one plane."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
import shapely

from limitblocks.arrays import Array, Indices, first_tied, real, sums
from limitblocks.errors import GeometryError, ModelError, sequence_of
from limitblocks.geometry.accuracy import GAPS, Accuracy, Tolerances, block_length, chosen, millimetres
from limitblocks.geometry.block import Block
from limitblocks.geometry.contact import find_contacts
from limitblocks.geometry.contacts import Contacts
from limitblocks.geometry.faces import FaceTable, face_table, opposed, surfaces_of
from limitblocks.geometry.kinds import between
from limitblocks.geometry.mend import mended
from limitblocks.geometry.neighbours import neighbours
from limitblocks.geometry.overlap import solid_of
from limitblocks.geometry.patches import covering, mean_width, patches
from limitblocks.geometry.regions import regions
from limitblocks.shown import many

#: Distances over the accuracy: of the corners of a face from its plane, of a vertex from where it was.
_FLAT, _MOST = 4.0, 12.0
_TURN = 0.3  # rad, between the facets of one face
#: Singular value of the normals at a vertex below which their planes are one.
_PARALLEL = 0.1


@dataclass(frozen=True)
class Healed:
    """Blocks that were mended, and how far they moved.

    Attributes
    ----------
    blocks : tuple of Block
        In the order given.
    displacements : mapping of str to float
        Largest distance that a vertex of a block moved, or its surface where vertices went, m.
    bound : float
        Distance that nothing moved beyond, m.
    accuracy : float
        Within which the blocks were mended, m.
    tolerances : Tolerances
        Those of the blocks as they were.
    notes : tuple of str
        Blocks left as they were, a line each.
    """

    blocks: tuple[Block, ...]
    displacements: Mapping[str, float]
    bound: float
    accuracy: float
    tolerances: Tolerances
    notes: tuple[str, ...]

    def contacts(self, joint: object) -> Contacts:
        """Return the contacts of the blocks, found with the tolerances of the blocks as they were.

        `joint` is as for :func:`limitblocks.find_contacts`.
        What was mended within an accuracy has edges that lie apart by as much, so that strips between stones
        that meet at an edge are still none.
        """
        used = self.tolerances
        return find_contacts(self.blocks, joint, gap=used.gap, angle=used.angle, width=used.width)

    def __str__(self) -> str:
        moved = max(self.displacements.values(), default=0.0)
        left = f"; {len(self.notes)} left as they were" if self.notes else ""
        return (
            f"{many(len(self.blocks), 'block')} mended within {millimetres(self.accuracy)}: vertices moved "
            f"by up to {millimetres(moved)}, at most {millimetres(self.bound)} allowed{left}"
        )


class Planes(NamedTuple):
    """Planes `normal @ x = offset` of regions, (m, 3) and (m,), m."""

    normal: Array
    offset: Array


def heal(blocks: Sequence[Block], accuracy: float | None = None) -> Healed:
    """Return the blocks mended within their accuracy, and how far every vertex moved.

    Meshes are made as coarse as six times the accuracy, or a quarter of the thickness (twice volume over
    surface) of a thin block, allows (manifold3d). The facets of a block that lie
    within four times the accuracy of one plane become one plane face; faces of different blocks that touch
    become parts of the common plane that fits their corners best, which closes gaps and overlaps up to six
    times the accuracy, but none that a third block fills. Each vertex then goes to the nearest point in the
    planes of its faces. A block of which a vertex would move farther than twelve times the accuracy stays as
    it was, with a note.

    Parameters
    ----------
    blocks : sequence of Block
    accuracy : float, optional
        About the standard deviation of a coordinate, m; left out, what the faces show:
        `Tolerances.accuracy` times the block length.

    Raises
    ------
    ModelError
        There are no blocks, the accuracy is not positive, or it is not given and there are too few joints to
        tell it.
    """
    blocks = sequence_of("blocks", blocks, Block)
    if not blocks:
        raise ModelError("no blocks given; expected at least one")
    centre = np.mean([block.vertices.mean(axis=0) for block in blocks], axis=0)
    length = block_length(blocks)
    shown = Accuracy.shown(blocks)
    size = shown.size * length if accuracy is None and shown.size is not None else accuracy
    if size is None:
        raise ModelError(
            "how accurate the faces are is not known, too few of them touch: heal(blocks, accuracy=...) "
            "takes a length in m; or leave them as they are and widen the gap that counts as touching "
            "(import --gap)"
        )
    if not 0.0 <= real(size) < np.inf:
        raise ModelError(f"accuracy is {accuracy!r}; a length in m is needed")
    used = chosen(None, None, None, Accuracy(size / length, shown.angle))
    if size <= 1e-9 * length:  # drawn exactly
        still = MappingProxyType({block.name: 0.0 for block in blocks})
        return Healed(tuple(blocks), still, 0.0, size, used, ())
    coarse = [_coarse(block, GAPS * size) for block in blocks]
    points = [block.vertices - centre for block in coarse]
    moved = _moved(coarse, points, used, length)
    made, shifts, notes = [], {}, []
    for old, block, here, there in zip(blocks, coarse, points, moved, strict=True):
        shift = float(np.linalg.norm(there - here, axis=1).max())
        shift += GAPS * size if block is not old else 0.0
        new = _rebuilt(block, there + centre) if shift <= _MOST * size else None
        shifts[old.name] = shift if new else 0.0
        made.append(new.labelled(**old.words) if new else old)
        if new is None:
            notes.append(f"block {old.name!r} is left as it was: its faces are not plane within {size:.2g} m")
    return Healed(tuple(made), MappingProxyType(shifts), _MOST * size, size, used, tuple(notes))


def _coarse(block: Block, tolerance: float) -> Block:
    """Return a mesh with as few facets as its surface within `tolerance`, m, allows; others as given."""
    if block.convex and max(map(len, block.faces)) > 3:
        return block
    solid = solid_of(block, block.vertices)
    quarter = 0.5 * solid.volume() / solid.surface_area()  # of the thickness: a sheet would become a wedge
    simple = solid.set_tolerance(min(tolerance, quarter))
    if simple.num_tri() >= solid.num_tri():
        return block
    mesh = simple.to_mesh64()
    try:
        return Block(block.name, mesh.vert_properties[:, :3], mesh.tri_verts.tolist())
    except GeometryError:
        return block


def _moved(blocks: Sequence[Block], points: Sequence[Array], used: Tolerances, length: float) -> list[Array]:
    """Return the vertices of blocks in the planes of their faces."""
    size = (used.accuracy or 0.0) * length
    flat = _FLAT * size
    surfaces = surfaces_of(blocks, points)
    label = regions(surfaces, flat, _TURN)
    faces = face_table(blocks, points, surfaces, label)
    _, region = np.unique(label, return_inverse=True)
    own = np.repeat(np.arange(len(faces.block)), faces.sides)
    planes = _fitted(faces.corners, own, faces.normal)
    common = _joined(faces, points, used, length)
    sign = np.sign(np.einsum("ij,ij->i", faces.normal, faces.normal[common]))
    shared = _fitted(faces.corners, common[own], faces.normal)
    off = np.abs(
        np.einsum("ij,ij->i", faces.corners, shared.normal[common[own]]) - shared.offset[common[own]]
    )
    fits = np.maximum.reduceat(off, faces.first) <= GAPS * size
    fits = (np.bincount(common, ~fits, len(fits)) == 0)[common]
    planes = Planes(
        np.where(fits[:, None], sign[:, None] * shared.normal[common], planes.normal),
        np.where(fits, sign * shared.offset[common], planes.offset),
    )
    width = 2.0 * faces.area / np.bincount(own, np.linalg.norm(faces.ends - faces.corners, axis=1))
    vertex = _numbered([block.mesh.start for block in blocks], [len(body) for body in points])
    pairs = np.unique(np.column_stack([vertex, region[surfaces.face]]), axis=0)
    pairs = pairs[(width > flat)[pairs[:, 1]]]  # the plane of a needle is noise
    placed = _placed(np.concatenate(points), pairs, planes)
    return np.split(placed, np.cumsum([len(body) for body in points])[:-1])


def _numbered(numbers: Sequence[Indices], counts: Sequence[int]) -> Indices:
    """Return numbers in parts as numbers in the whole, whose parts have so many members."""
    before = np.cumsum(counts) - counts
    return np.concatenate([part + first for part, first in zip(numbers, before, strict=True)])


def _fitted(corners: Array, owner: Indices, normal: Array) -> Planes:
    """Return the planes that fit corners (k, 3) best, of each owner; those of no corner are as they were."""
    m = len(normal)
    count = np.maximum(np.bincount(owner, minlength=m), 1)
    middle = sums(owner, corners, m) / count[:, None]
    arm = corners - middle[owner]
    spread = sums(owner, (arm[:, :, None] * arm[:, None]).reshape(-1, 9), m).reshape(-1, 3, 3)
    best = np.linalg.eigh(spread)[1][:, :, 0]
    best *= np.sign(np.einsum("ij,ij->i", best, normal))[:, None]
    return Planes(best, np.einsum("ij,ij->i", best, middle))


def _joined(faces: FaceTable, points: Sequence[Array], used: Tolerances, length: float) -> Indices:
    """Return for each region the first (m,) of those that contacts tie to it in one plane."""
    gap = used.gap * length
    seen = patches(faces, *opposed(faces, neighbours(points, gap), gap, used.angle), length)
    wide = (mean_width(seen.shape) > used.width * length) | covering(faces, seen)
    meant = seen.of(wide & (shapely.area(seen.shape) > seen.least) & (np.abs(seen.gap) <= gap))
    meant = meant.of(between(faces, meant, meant) < 0)  # stones on both sides of a sheet are apart
    return first_tied(np.column_stack([meant.a, meant.b]), len(faces.block))


def _placed(points: Array, pairs: Indices, planes: Planes) -> Array:
    """Return the nearest points in the planes of their regions, `pairs` (p, 2) of point and region."""
    placed = points.copy()
    vertex, region = pairs.T
    count = np.bincount(vertex, minlength=len(points))
    for n in np.unique(count[count > 0]):
        at = np.flatnonzero(count == n)
        which = region[count[vertex] == n].reshape(-1, n)
        normal = planes.normal[which]
        height = planes.offset[which] - np.einsum("ijk,ik->ij", normal, points[at])
        inverse = np.linalg.pinv(normal, rcond=_PARALLEL)
        placed[at] += np.einsum("ijk,ik->ij", inverse, height)
    return placed


def _rebuilt(block: Block, points: Array) -> Block | None:
    """Return a block with its vertices at `points` and its facets merged; None where that is no block."""
    try:
        return mended(block.name, points, block.faces)[0]
    except GeometryError:
        return None
