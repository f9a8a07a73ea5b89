"""Blocks in and out, in every format that other programs read and write."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from limitblocks.errors import ModelError
from limitblocks.geometry import Block
from limitblocks.io import faults, formats
from limitblocks.io.imported import Contents, ImportedBlocks, UnitWeight, imported, read_bytes
from limitblocks.model import Model
from limitblocks.written import write


def read_blocks(
    file: str | Path, *, units: str | None = None, unit_weight: UnitWeight = None, up: str | None = None
) -> ImportedBlocks:
    """Return the blocks in `file`, of any format in docs/files.md but the model file.

    Parameters
    ----------
    file : str or Path
        The suffix of its name says the format.
    units : str, optional
        Unit of length of the file, one of "m", "cm", "mm", "in", "ft"; left out, what the file says, and
        metres where it says nothing.
    unit_weight : float or mapping of str to float, optional
        N/m3, of all blocks or by layer; blocks of other layers get none, as supports may.

    up : str, optional
        Axis of the file that points up, "y" or "z"; left out, what the format says (glTF: Y), else Z.

    Raises
    ------
    ModelError
        The file cannot be read, or solids in it are no blocks; `problems` has a line per fault.
    MissingDependency
        The format needs a package that is not installed.
    """
    path = Path(file)
    with faults.named(path):
        return imported(_contents(path), units, unit_weight, up)


def _contents(path: Path) -> Contents:
    suffix = path.suffix.lower()
    if suffix not in formats.READ:
        known = ", ".join(sorted(formats.READ))
        raise ModelError(f"suffix {suffix!r} is unknown; blocks are read from {known}, models from .json")
    contents: Contents = formats.module(suffix).contents(path)
    return contents


def write_blocks(
    blocks: Model | ImportedBlocks | Sequence[Block], file: str | Path, *, overwrite: bool = False
) -> Path:
    """Write blocks to a file that other programs read, and return its path.

    The suffix says the format. OBJ keeps faces, names and every digit; STL (text) names and every digit,
    with triangles; PLY (binary) faces and every digit, no names; GLB names, with triangles in single
    precision about each block's centroid, and Y up as the format wants it. OBJ and GLB get the materials
    "support" and "block" where a model is given, layers where blocks are that were read with them. So do DXF
    and 3dm (Rhino) as layers, with names and every digit. JSON is COMPAS JSON: an assembly with names,
    supports and every digit.

    Raises
    ------
    LimitBlocksError
        The file exists and `overwrite` is false, or it cannot be written.
    MissingDependency
        The format needs a package that is not installed.
    ModelError
        The suffix is unknown, or there are no blocks.
    """
    path = Path(file)
    bodies = tuple(blocks.blocks if isinstance(blocks, Model | ImportedBlocks) else blocks)
    if not bodies:
        raise ModelError(f"{path}: no blocks given; expected at least one")
    if path.suffix.lower() not in formats.WRITTEN:
        raise ModelError(
            f"{path}: suffix {path.suffix!r} is unknown; expected one of {', '.join(formats.WRITTEN)}"
        )
    return write(path, formats.module(path.suffix).encoded(bodies, layers_of(blocks)), overwrite)


def layers_of(blocks: Model | ImportedBlocks | Sequence[Block]) -> dict[str, str]:
    """Return the layer of each block by its name: support or block in a model; none if nothing is known."""
    if isinstance(blocks, ImportedBlocks):
        return dict(blocks.layers) | dict.fromkeys(blocks.supports, "support")
    if isinstance(blocks, Model):
        supports = set(blocks.supports)
        return {block.name: "support" if block.name in supports else "block" for block in blocks.blocks}
    return {}


def is_model_file(path: Path) -> bool:
    """Return whether the file at `path` is a model file of limitblocks: JSON that is not of COMPAS."""
    return path.suffix.lower() == "" or (path.suffix.lower() == ".json" and not _is_compas(path))


def _is_compas(path: Path) -> bool:
    """Return whether a file of JSON is of COMPAS: its objects have a "dtype", ours a "schema_version"."""
    try:
        data = read_bytes(path)
    except ModelError:  # for the reader to say
        return False
    return b'"dtype"' in data and b'"schema_version"' not in data
