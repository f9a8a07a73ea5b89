"""VTU out, by meshio, for ParaView: blocks with their motion, interfaces with their stress resultants."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby, pairwise
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np

from limitblocks.arrays import Array
from limitblocks.drawing.motion import displaced, motion
from limitblocks.errors import ModelError, path_of
from limitblocks.evidence.load_path_result import LoadPath
from limitblocks.geometry import Block
from limitblocks.io.colours import parts_of
from limitblocks.io.packages import package
from limitblocks.model import Model, checked_model, refuse_other
from limitblocks.written import refuse_existing, write

_RESULTANTS = ("V1", "V2", "N", "M1", "M2", "T")


def write_vtu(
    model: Model, file: str | Path, result: Any = None, *, overwrite: bool = False
) -> tuple[Path, ...]:
    """Write a model, and a result of it, for ParaView; return the paths of all files.

    `wall.vtu` has the faces of the blocks with the cell data `block` (position in the model), `support`
    (0 or 1), and with a result the point data `displacement`, m: v + w x r at each vertex. ParaView's filter
    "Warp By Vector" with factor 1 shows it. One factor scales all displacements of a file or load path:
    the largest becomes 8 % of the diagonal of the structure, or the largest rotation 0.25 rad where that is
    less; the field data `magnification` is this factor.

    `wall_interfaces.vtu` beside it has the interfaces with the cell data `interface` (position in the model),
    and with a result `V1`, `V2`, `N` (N), `M1`, `M2`, `T` (N m) in local axes, N negative in compression, and
    `force`, N, global axes: what block j exerts on block i.

    A load path goes to `path.pvd` with `path_0000.vtu`, `path_0000_interfaces.vtu` and so on, a step each;
    the time is the number of the step and the field data `load_factor` its load factor.

    Parameters
    ----------
    model : Model
    file : str or Path
        Name of a file that ends in .vtu, or in .pvd for a load path.
    result : LoadPath, or any result with `displacement_rates` (n, 6) or `stress_resultants` (m, 6), optional
    overwrite : bool
        Replace files that exist.

    Raises
    ------
    LimitBlocksError
        A file exists and `overwrite` is false, or it cannot be written.
    MissingDependency
        meshio is not installed.
    ModelError
        The suffix is wrong, or the result belongs to another model.
    """
    model, path = checked_model(model), path_of(file)
    refuse_other(model, result)
    wanted = ".pvd" if isinstance(result, LoadPath) else ".vtu"
    if path.suffix.lower() != wanted:
        raise ModelError(f"{path}: suffix {path.suffix!r} is not that of this result; expected {wanted}")
    if isinstance(result, LoadPath):
        return _write_path(model, path, result, overwrite)
    return _write_all(_state(model, path, result), overwrite)


def _write_all(files: Iterable[tuple[Path, bytes]], overwrite: bool) -> tuple[Path, ...]:
    ready = list(files)
    refuse_existing([path for path, _ in ready], overwrite)
    return tuple(write(path, data, overwrite) for path, data in ready)


def _write_path(model: Model, path: Path, result: LoadPath, overwrite: bool) -> tuple[Path, ...]:
    moved = motion(model, result)
    files: list[tuple[Path, bytes]] = []
    entries = []
    for k, (step, state) in enumerate(zip(result.steps, moved.states, strict=True)):
        base = path.with_name(f"{path.stem}_{k:04d}.vtu")
        field = {"load_factor": step.load_factor, "magnification": moved.magnification}
        files += [(base, _blocks(model, state, field)), _interfaces(model, base, step.stress_resultants)]
        entries += [
            f' <DataSet timestep="{k}" part="{part}" file={quoteattr(name.name)}/>'
            for part, (name, _) in enumerate(files[-2:])
        ]
    head = '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">\n<Collection>\n'
    text = head + "\n".join(entries) + "\n</Collection>\n</VTKFile>\n"
    return _write_all([(path, text.encode()), *files], overwrite)


def _state(model: Model, path: Path, result: Any) -> Iterator[tuple[Path, bytes]]:
    moved = motion(model, result) if getattr(result, "displacement_rates", None) is not None else None
    if moved:
        yield path, _blocks(model, moved.states[0], {"magnification": moved.magnification})
    else:
        yield path, _blocks(model, None, {})
    yield _interfaces(model, path, getattr(result, "stress_resultants", None))


def _blocks(model: Model, state: Array | None, field: dict[str, float]) -> bytes:
    """Return the VTU file of the blocks, displaced by `state` (n, 6)."""
    blocks = model.blocks
    points = np.concatenate([block.vertices for block in blocks])
    starts = np.cumsum([0, *(len(block.vertices) for block in blocks)]).tolist()
    polygons = [np.add(face, starts[k]) for k, block in enumerate(blocks) for face in block.faces]
    owner = np.repeat(np.arange(len(blocks)), [len(block.faces) for block in blocks])
    of: dict[str, Any] = {"support": (~model.free).astype(np.int64)} | _labels(blocks)
    moves = (
        {}
        if state is None
        else {"displacement": np.concatenate([displaced(*each) for each in zip(blocks, state, strict=True)])}
    )
    return _vtu(points, polygons, moves, {"block": owner} | {word: of[word][owner] for word in of}, field)


def _labels(blocks: Sequence[Block]) -> dict[str, Any]:
    """Return places in the alphabet of the blocks' layers, materials, first groups; and colours, if any."""
    words = {word: [getattr(block, word) for block in blocks] for word in ("layer", "material")}
    words["group"] = [block.groups[0] if block.groups else "" for block in blocks]
    found = {word: np.unique(names, return_inverse=True)[1] for word, names in words.items() if any(names)}
    if not any(block.colour for block in blocks):
        return found
    return found | {"colour": np.array([parts_of(block.colour) for block in blocks], dtype=np.uint8)}


def _interfaces(model: Model, path: Path, resultants: Array | None) -> tuple[Path, bytes]:
    """Return path and VTU file of the interfaces with their stress resultants (m, 6)."""
    parts = model.interfaces
    points = [part.corners for part in parts]
    ends = np.cumsum([0, *map(len, points)]).tolist()
    polygons = [np.arange(*span) for span in pairwise(ends)]
    cells: dict[str, Any] = {"interface": np.arange(len(parts))}
    if resultants is not None:
        values = np.asarray(resultants, dtype=float)
        if values.shape != (len(parts), 6) or not np.isfinite(values).all():
            raise ModelError(
                f"stress resultants: shape {values.shape}; ({len(parts)}, 6) finite numbers are needed"
            )
        axes = np.array([part.axes for part in parts]).reshape(-1, 3, 3)
        cells |= dict(zip(_RESULTANTS, values.T, strict=True))
        cells["force"] = np.einsum("ki,kij->kj", values[:, :3], axes)
    everything = np.concatenate([*points, np.zeros((0, 3))])
    return path.with_name(f"{path.stem}_interfaces.vtu"), _vtu(everything, polygons, {}, cells, {})


def _vtu(
    points: Array,
    polygons: Sequence[Any],
    point_data: dict[str, Array],
    cell_data: dict[str, Any],
    field: dict[str, float],
) -> bytes:
    """Return the VTU file of `polygons` over `points` with their data."""
    meshio = package("meshio", "VTU")
    cells = [("polygon", np.array(list(run))) for _, run in groupby(polygons, len)]
    ends = np.cumsum([len(run) for _, run in cells])[:-1]
    runs = {name: np.split(values, ends) for name, values in cell_data.items()}
    with TemporaryDirectory() as folder:  # meshio writes VTU to files only, and no field data
        file = Path(folder) / "mesh.vtu"
        meshio.Mesh(points, cells, point_data, runs).write(file)
        arrays = "".join(
            f'<DataArray type="Float64" Name="{name}" NumberOfTuples="1" format="ascii">{value!r}</DataArray>'
            for name, value in zip(field, map(float, field.values()), strict=True)
        )
        tag = b"<UnstructuredGrid>"
        return file.read_bytes().replace(tag, tag + f"<FieldData>{arrays}</FieldData>".encode(), 1)
