"""Blocks out, as meshes that other programs read."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from limitblocks.errors import ModelError
from limitblocks.geometry import Block
from limitblocks.io.compas_writer import compas
from limitblocks.io.dxf_writer import dxf
from limitblocks.io.glb import glb
from limitblocks.io.imported import ImportedBlocks
from limitblocks.io.rhino_writer import rhino
from limitblocks.model import Model
from limitblocks.written import write


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
    if path.suffix.lower() not in _WRITERS:
        raise ModelError(f"{path}: suffix {path.suffix!r} is unknown; expected one of {', '.join(_WRITERS)}")
    return write(path, _WRITERS[path.suffix.lower()](bodies, layers_of(blocks)), overwrite)


def layers_of(blocks: Model | ImportedBlocks | Sequence[Block]) -> dict[str, str]:
    """Return the layer of each block by its name: support or block in a model; none if nothing is known."""
    if isinstance(blocks, ImportedBlocks):
        return dict(blocks.layers) | dict.fromkeys(blocks.supports, "support")
    if isinstance(blocks, Model):
        supports = set(blocks.supports)
        return {block.name: "support" if block.name in supports else "block" for block in blocks.blocks}
    return {}


def _obj(blocks: Sequence[Block], layers: dict[str, str]) -> bytes:
    lines = ["# limitblocks; m, Z up"]
    first = 1
    for block in blocks:
        lines.append(f"o {_line(block.name)}")
        lines += [f"v {x!r} {y!r} {z!r}" for x, y, z in block.vertices.tolist()]
        lines += [f"usemtl {_line(layers[block.name])}"] if layers.get(block.name) else []
        lines += ["f " + " ".join(str(first + vertex) for vertex in face) for face in block.faces]
        first += len(block.vertices)
    return ("\n".join(lines) + "\n").encode()


def _stl(blocks: Sequence[Block], _: dict[str, str]) -> bytes:
    lines: list[str] = []
    for block in blocks:
        lines.append(f"solid {_line(block.name)}")
        trios = block.vertices[block.triangles]
        normals = np.cross(trios[:, 1] - trios[:, 0], trios[:, 2] - trios[:, 0])
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), np.finfo(float).tiny)
        for corners, normal in zip(trios.tolist(), normals.tolist(), strict=True):
            lines.append(f" facet normal {_digits(normal)}\n  outer loop")
            lines += [f"   vertex {_digits(corner)}" for corner in corners]
            lines.append("  endloop\n endfacet")
        lines.append(f"endsolid {_line(block.name)}")
    return ("\n".join(lines) + "\n").encode()


def _ply(blocks: Sequence[Block], _: dict[str, str]) -> bytes:
    points = np.concatenate([block.vertices for block in blocks])
    starts = np.cumsum([0, *(len(block.vertices) for block in blocks)])
    faces = [
        np.add(face, start)
        for block, start in zip(blocks, starts.tolist()[:-1], strict=True)
        for face in block.faces
    ]
    header = (
        "ply\nformat binary_little_endian 1.0\ncomment limitblocks; m, Z up\n"
        f"element vertex {len(points)}\nproperty double x\nproperty double y\nproperty double z\n"
        f"element face {len(faces)}\nproperty list int int vertex_indices\nend_header\n"
    )
    rows = np.concatenate([[len(face), *face] for face in faces])
    return header.encode() + points.astype("<f8").tobytes() + rows.astype("<i4").tobytes()


def _line(name: str) -> str:
    """Return a name as one line of a text file, without blanks around it."""
    return " ".join(name.split())


def _digits(vector: Sequence[float]) -> str:
    return " ".join(map(repr, vector))


_WRITERS: dict[str, Callable[[Sequence[Block], dict[str, str]], bytes]] = {
    ".obj": _obj,
    ".stl": _stl,
    ".ply": _ply,
    ".glb": glb,
    ".dxf": dxf,
    ".3dm": rhino,
    ".json": compas,
}
