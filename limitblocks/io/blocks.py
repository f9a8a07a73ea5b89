"""Blocks in and out, in every format that other programs read and write."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from limitblocks.errors import ModelError, path_of, sequence_of
from limitblocks.geometry import Block
from limitblocks.geometry.twisted import Twisted
from limitblocks.io import faults, formats, strict_json
from limitblocks.io.imported import (
    ImportedBlocks,
    UnitWeight,
    foreign,
    imported,
    plain,
    read_bytes,
)
from limitblocks.io.placed import Contents
from limitblocks.model import Model
from limitblocks.written import write


def read_blocks(
    file: str | Path,
    *,
    units: str | None = None,
    unit_weight: UnitWeight = None,
    up: str | None = None,
    twisted: Twisted | None = None,
    skip_bad: bool = False,
) -> ImportedBlocks:
    """Return the blocks in `file`, of any format in docs/files.md but the model file.

    Parameters
    ----------
    file : str or Path
        The suffix of its name says the format.
    units : str, optional
        Unit of length of the file, one of "m", "cm", "mm", "in", "ft"; left out, what the file says, and
        metres where it says nothing, or mm or cm where it would be larger than 300 m: `guesses` says so.
    unit_weight : float or mapping of str to float, optional
        N/m3, of all blocks or by layer; blocks of other layers get none, as supports may.
    up : str, optional
        Axis of the file that points up, "y" or "z"; left out, what the format says (glTF: Y), else Z,
        or Y where the structure would lie on its side: `guesses` says so.
    twisted : {"refuse", "triangulate", "fit"}, optional
        What becomes of faces whose corners lie in no plane, within 1e-3 of the block's size: an error;
        triangles; or planes that fit the corners best, into which the vertices go. Left out: triangles where
        the corners are off no more than four times the accuracy that faces show which touch, or than the
        digits of the coordinates tell; else an error.
    skip_bad : bool
        Leave out solids that are no blocks, with a note each, instead of refusing the file.

    Raises
    ------
    ModelError
        The file cannot be read, or solids in it are no blocks; `problems` has the first 20
        faults, a line each.
    MissingDependency
        The format needs a package that is not installed.
    """
    path = path_of(file)
    with faults.named(path):
        return imported(contents_of(path), units, unit_weight, up, twisted, skip_bad)


def contents_of(path: Path) -> Contents:
    """Return what the reader of its format finds in the file at `path`."""
    suffix = path.suffix.lower()
    if suffix not in formats.READ:
        known = ", ".join(sorted(formats.READ))
        if suffix in formats.INSTEAD:
            raise ModelError(
                f"{suffix[1:].upper()} is not read: {formats.INSTEAD[suffix]} (blocks are read from {known})"
            )
        raise ModelError(f"suffix {suffix!r} is unknown; blocks are read from {known}, models from .json")
    module = formats.module(suffix)
    with foreign(suffix[1:]):
        contents: Contents = module.contents(path)
    return contents


def write_blocks(
    blocks: Model | ImportedBlocks | Sequence[Block], file: str | Path, *, overwrite: bool = False
) -> Path:
    """Write blocks to a file that other programs read, and return its path.

    The suffix says the format. OBJ keeps faces, names and every digit; STL (text) names and every digit,
    with triangles; PLY (binary) faces and every digit, no names; GLB names, with triangles in single
    precision about each block's centroid, and Y up as the format wants it. DXF and 3dm (Rhino) keep names,
    layers and every digit; JSON is COMPAS JSON, an assembly with names, supports and every digit. A block
    of a model without a layer gets "support" or "block" as its layer. Materials are kept by all but STL and
    PLY; OBJ and GLB without a material have the layer as one.

    Raises
    ------
    LimitBlocksError
        The file exists and `overwrite` is false, or it cannot be written.
    MissingDependency
        The format needs a package that is not installed.
    ModelError
        The suffix is unknown, or there are no blocks.
    """
    given = blocks.blocks if isinstance(blocks, Model | ImportedBlocks) else blocks
    bodies, path = sequence_of("blocks", given, Block), path_of(file)
    if not bodies:
        raise ModelError(f"{path}: no blocks given; expected at least one")
    if path.suffix.lower() not in formats.WRITTEN:
        raise ModelError(
            f"{path}: suffix {path.suffix!r} is unknown; expected one of {', '.join(formats.WRITTEN)}"
        )
    supports = set(blocks.supports if isinstance(blocks, Model | ImportedBlocks) else ())
    fixed = [block.name in supports for block in bodies]
    return write(path, formats.module(path.suffix).encoded(plain(bodies, fixed), fixed), overwrite)


def is_model_file(path: Path) -> bool:
    """Return whether the file at `path` is a model file of limitblocks: JSON that is not of COMPAS."""
    return path.suffix.lower() == "" or (path.suffix.lower() == ".json" and not _is_compas(path))


def _is_compas(path: Path) -> bool:
    """Return whether a file of JSON is of COMPAS: it says so, or has blocks and no key of our own."""
    try:
        data = read_bytes(path)
        if b'"schema_version"' in data or b'"dtype"' in data or b'"datatype"' in data:
            return b'"schema_version"' not in data
        document = strict_json.parse(strict_json.read_text(path))
    except ModelError:  # for the reader to say
        return False
    own = isinstance(document, dict) and document.keys() & {"interfaces", "joints", "live"}
    return not own and bool(formats.module(".json").holds_blocks(document))
