"""Every format that blocks are read from, by the suffix of the file."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path

from limitblocks.errors import ModelError
from limitblocks.io import faults
from limitblocks.io.imported import Contents, ImportedBlocks, UnitWeight, imported, read_bytes

#: Module of limitblocks.io whose function `contents(path)` reads files with this suffix.
READERS: dict[str, str] = {
    ".obj": "obj",
    ".stl": "stl",
    ".ply": "ply",
    ".glb": "gltf",
    ".gltf": "gltf",
    ".dxf": "dxf",
    ".3dm": "rhino",
    ".json": "compas",
}


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
    if suffix not in READERS:
        known = ", ".join(sorted(READERS))
        raise ModelError(f"suffix {suffix!r} is unknown; blocks are read from {known}, models from .json")
    read = import_module(f"limitblocks.io.{READERS[suffix]}").contents
    contents: Contents = read(path)
    return contents


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
