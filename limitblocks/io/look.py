"""What is in a file before anything is asked: blocks, layers, units, supports, what is wrong."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from limitblocks.analysis.magnitudes import of_volumes
from limitblocks.analysis.magnitudes_of_size import of_size
from limitblocks.errors import ModelError, path_of
from limitblocks.geometry import Block, Contacts, find_contacts
from limitblocks.geometry.twisted import Twisted
from limitblocks.io import faults, model_file
from limitblocks.io.blocks import contents_of, is_model_file
from limitblocks.io.formats.dxf.elevation import elevation, refuse_with_thickness
from limitblocks.io.imported import blocks_of
from limitblocks.io.made import refused
from limitblocks.io.open_joints import open_joints
from limitblocks.io.placed import UNITS, Contents, Frame, frame
from limitblocks.io.supports import LikelySupports, likely_supports
from limitblocks.shown import Shown, counted, many

_FORMATS = {
    ".obj": "Wavefront OBJ",
    ".stl": "STL",
    ".ply": "PLY",
    ".glb": "GLB",
    ".gltf": "glTF",
    ".dxf": "DXF",
    ".3dm": "Rhino 3dm",
    ".json": "COMPAS JSON",
}


@dataclass(frozen=True)
class SeenBlock:
    """A block in a file: volume, m3, size along X, Y, Z, m, the levels it lies between, m; groups, colour."""

    name: str
    layer: str
    material: str
    volume: float
    size: tuple[float, float, float]
    bottom: float
    top: float
    groups: tuple[str, ...] = ()
    colour: str = ""

    @classmethod
    def of(cls, block: Block) -> SeenBlock:
        """Return what is seen of a block."""
        low, high = block.vertices.min(axis=0), block.vertices.max(axis=0)
        x, y, z = (high - low).tolist()
        ends = float(low[2]), float(high[2])
        words = tuple(block.groups), block.colour
        return cls(block.name, block.layer, block.material, block.volume, (x, y, z), *ends, *words)


@dataclass(frozen=True, repr=False)
class Look(Shown):
    """What is in a file of blocks.

    Attributes
    ----------
    file, format : str
    blocks : tuple of SeenBlock
        Sound blocks, in m with Z up.
    faults : tuple of str
        Why the other solids are no blocks, a line each.
    layers, materials, groups, colours : dict
        Number of blocks by layer, by material, by group and by colour.
    units, up : str
        Unit of length and axis that points up, and where this comes from.
    bounding_box : tuple
        Lowest and highest coordinates, m.
    contacts : str
        Interfaces found, with the accuracy of the faces.
    touching : float
        Gap that takes blocks which overlap a little as touching, in block lengths; 0 if none do.
    marked_supports : tuple of str
        Blocks that the file says do not move.
    likely_supports : tuple of LikelySupports
    warnings : tuple of str
        What may not be meant.
    notes : tuple of str
        What was mended and left out.
    """

    file: str
    format: str
    blocks: tuple[SeenBlock, ...]
    faults: tuple[str, ...]
    layers: dict[str, int]
    materials: dict[str, int]
    groups: dict[str, int]
    colours: dict[str, int]
    units: str
    up: str
    bounding_box: tuple[tuple[float, ...], tuple[float, ...]]
    contacts: str
    touching: float
    marked_supports: tuple[str, ...]
    likely_supports: tuple[LikelySupports, ...]
    warnings: tuple[str, ...]
    notes: tuple[str, ...]

    @property
    def volume(self) -> float:
        """Volume of all blocks, m3."""
        return sum(block.volume for block in self.blocks)

    @property
    def size(self) -> tuple[float, ...]:
        """Dimensions of the bounding box, m."""
        return tuple(high - low for low, high in zip(*self.bounding_box, strict=True))

    def to_dict(self) -> dict[str, Any]:
        """Return all as plain numbers, lists and text; SI units."""
        return asdict(self) | {"volume": self.volume, "size": list(self.size)}

    def __str__(self) -> str:
        size = " x ".join(f"{side:.4g}" for side in self.size)
        bad = f", {many(len(self.faults), 'fault')}" if self.faults else ""
        return f"{self.file}: {many(len(self.blocks), 'block')}{bad}, {size} m"


def look(
    file: str | Path,
    *,
    units: str | None = None,
    up: str | None = None,
    twisted: Twisted | None = None,
    thickness: float | None = None,
    layers: str | Sequence[str] | None = None,
) -> Look:
    """Return what is in `file`, of any format in docs/files.md, before anything else is known.

    Parameters
    ----------
    file : str or Path
        The suffix of its name says the format.
    units, up, twisted : str, optional
        As for :func:`limitblocks.read`.
    thickness : float, optional
        As for :func:`limitblocks.files.read_drawing`, of a DXF elevation, m.
    layers : str or sequence of str, optional
        As there, of a DXF elevation.

    Raises
    ------
    ModelError
        The file cannot be read as a whole, or a model file is wrong; bad blocks alone are in `faults`.
    MissingDependency
        The format needs a package that is not installed.
    """
    path = path_of(file)
    if layers and thickness is None:
        raise ModelError(f"{path}: layers are of DXF elevations: give thickness (--thickness), too")
    if is_model_file(path):
        if units or up or twisted or thickness:
            raise ModelError(f"{path}: a model file says units, axes and faces itself; leave these out")
        model = model_file.read(path)
        own = "m, as limitblocks reads model files", "Z, as in every model file"
        return _look(path, "limitblocks model", model.blocks, *own, marked=tuple(model.supports))
    with faults.named(path):
        if thickness is not None:
            refuse_with_thickness(up=up, twisted=twisted)
        contents = contents_of(path) if thickness is None else elevation(path, thickness, units, layers)
        where = frame(contents, units, up)
        made = blocks_of(contents, where, twisted)
        if not made.blocks and made.wrong:
            raise refused(made.wrong, 0, made.twisted)
        return _look(
            path,
            _FORMATS[path.suffix.lower()] if thickness is None else "DXF elevation",
            made.blocks,
            _units(contents, where, units),
            _up(contents, where, up),
            marked=made.supports,
            wrong=tuple(line for lines in made.wrong.values() for line in lines),
            warnings=(*where.warnings, *made.warnings),
            notes=(*contents.notes, *made.notes),
        )


def _look(
    path: Path,
    kind: str,
    blocks: Sequence[Block],
    units: str,
    up: str,
    *,
    marked: tuple[str, ...] = (),
    wrong: tuple[str, ...] = (),
    warnings: tuple[str, ...] = (),
    notes: tuple[str, ...] = (),
) -> Look:
    if not blocks:
        raise ModelError("holds no solid; expected at least one block")
    corners = np.concatenate([block.vertices for block in blocks])
    contacts = find_contacts(blocks, None)
    return Look(
        str(path),
        kind,
        tuple(map(SeenBlock.of, blocks)),
        wrong,
        counted(block.layer for block in blocks),
        counted(block.material for block in blocks),
        counted(group for block in blocks for group in block.groups),
        counted(block.colour for block in blocks),
        units,
        up,
        (tuple(corners.min(axis=0).tolist()), tuple(corners.max(axis=0).tolist())),
        f"{many(len(contacts.interfaces), 'interface')}; {contacts.accuracy}",
        contacts.touching,
        marked,
        likely_supports(blocks),
        (*warnings, *_suspicious(blocks, corners, contacts)),
        notes,
    )


def _suspicious(blocks: Sequence[Block], corners: Any, contacts: Contacts) -> list[str]:
    """Return what may not be meant: sizes, debris, what contact detection saw, joints drawn open."""
    size = float(np.ptp(corners, axis=0).max())
    return [*of_size(size), *of_volumes(blocks), *contacts.warnings, *open_joints(contacts, blocks)]


def _units(contents: Contents, where: Frame, units: str | None) -> str:
    names = {metres: name for name, metres in UNITS.items()}
    name = names.get(where.metres, f"{where.metres:g} m")
    if units is not None:
        return f"{name}, as given"
    if contents.metres is not None:
        return f"{name}, as the file says"
    return f"{name}, {'guessed' if where.metres != 1.0 else 'assumed'}: the file does not say"


def _up(contents: Contents, where: Frame, up: str | None) -> str:
    if up is not None:
        return f"{up.upper()}, as given"
    if contents.up is not None:
        return f"{where.up.upper()}, as the format has it"
    return f"{where.up.upper()}, {'guessed' if where.up == 'y' else 'assumed'}: the file does not say"
