"""GLB out: each block a node about its centroid, with the motion of a result as an animation.

glTF 2.0 specification, sections 3.6 (data), 3.7 (geometry), 3.11 (animations) and 4.4 (GLB).
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from limitblocks.arrays import Array
from limitblocks.errors import ModelError
from limitblocks.geometry import Block
from limitblocks.io.imported import Z_UP
from limitblocks.io.motion import motion
from limitblocks.io.written import write
from limitblocks.model import Model

_INT, _FLOAT = 5125, 5126  # component types
_VERTICES, _INDICES = 34962, 34963  # what a buffer view is for
_CHUNKS = (b"JSON", b"BIN\0")
_COLOURS = {"support": (0.35, 0.37, 0.4, 1.0), "block": (0.76, 0.68, 0.56, 1.0)}
_PLAIN = (0.8, 0.8, 0.8, 1.0)
_SECONDS = 2.0  # length of the animation


def write_animation(model: Model, file: str | Path, result: Any, *, overwrite: bool = False) -> Path:
    """Write a model with the motion of a result as an animation to a GLB file, and return its path.

    A mechanism grows from nothing in two seconds; a load path passes through its steps in them. Motion
    is scaled as in :func:`limitblocks.write_vtu`, and the rotations are true ones, not their linear part.

    Parameters
    ----------
    model : Model
    file : str or Path
        Name of a file that ends in .glb.
    result : LoadPath, or any result with `displacement_rates` (n, 6)
    overwrite : bool
        Replace the file if it exists.

    Raises
    ------
    LimitBlocksError
        The file exists and `overwrite` is false, or it cannot be written.
    ModelError
        The suffix is not .glb, or the result is not one of the model.
    """
    path = Path(file)
    if path.suffix.lower() != ".glb":
        raise ModelError(f"{path}: suffix {path.suffix!r} is not that of an animation; expected .glb")
    states = motion(model, result).states
    supports = set(model.supports)
    layers = {block.name: "support" if block.name in supports else "block" for block in model.blocks}
    still = np.zeros_like(states[:1])
    return write(path, glb(model.blocks, layers, np.concatenate([still, states])), overwrite)


def glb(blocks: Sequence[Block], layers: dict[str, str], states: Array | None = None) -> bytes:
    """Return the GLB file of blocks, with an animation through the displacements `states` (k, n, 6)."""
    data = _Data()
    names = list(dict.fromkeys(layers.get(block.name, "") for block in blocks))
    document: dict[str, Any] = {
        "asset": {"version": "2.0", "generator": "limitblocks"},
        "scene": 0,
        "scenes": [{"nodes": list(range(len(blocks)))}],
        "nodes": [
            {"name": block.name, "mesh": k, "translation": (Z_UP.T @ block.centroid).tolist()}
            for k, block in enumerate(blocks)
        ],
        "meshes": [
            {
                "name": block.name,
                "primitives": [_primitive(data, block, names.index(layers.get(block.name, "")))],
            }
            for block in blocks
        ],
        "materials": [_material(name) for name in names],
    }
    if states is not None:
        document["animations"] = [_animation(data, blocks, states)]
    document |= {
        "accessors": data.accessors,
        "bufferViews": data.views,
        "buffers": [{"byteLength": len(data.bytes)}],
    }
    text = json.dumps(document, separators=(",", ":")).encode()
    return _container(text, bytes(data.bytes))


class _Data:
    """The binary chunk as it grows, with its buffer views and accessors."""

    def __init__(self) -> None:
        self.bytes = bytearray()
        self.views: list[dict[str, int]] = []
        self.accessors: list[dict[str, Any]] = []

    def add(self, values: npt.NDArray[Any], component: int, kind: str, target: int | None = None) -> int:
        """Append `values` (n, columns) and return the number of their accessor."""
        self.views.append(
            {"buffer": 0, "byteOffset": len(self.bytes), "byteLength": values.nbytes}
            | ({"target": target} if target else {})
        )
        self.accessors.append(
            {
                "bufferView": len(self.views) - 1,
                "componentType": component,
                "count": len(values),
                "type": kind,
            }
            | {"min": values.min(axis=0).tolist(), "max": values.max(axis=0).tolist()}
        )
        self.bytes += values.tobytes() + bytes(-values.nbytes % 4)
        return len(self.accessors) - 1


def _primitive(data: _Data, block: Block, material: int) -> dict[str, Any]:
    points = (block.vertices - block.centroid) @ Z_UP
    return {
        "attributes": {"POSITION": data.add(points.astype("<f4"), _FLOAT, "VEC3", _VERTICES)},
        "indices": data.add(block.triangles.astype("<u4").reshape(-1, 1), _INT, "SCALAR", _INDICES),
        "material": material,
    }


def _material(name: str) -> dict[str, Any]:
    look = {"baseColorFactor": _COLOURS.get(name, _PLAIN), "metallicFactor": 0.0, "roughnessFactor": 0.9}
    return ({"name": name} if name else {}) | {"pbrMetallicRoughness": look, "doubleSided": True}


def _animation(data: _Data, blocks: Sequence[Block], states: Array) -> dict[str, Any]:
    """Return translation and rotation of each moving block through `states` (k, n, 6)."""
    times = np.linspace(0.0, _SECONDS, len(states)).astype("<f4").reshape(-1, 1)
    clock = data.add(times, _FLOAT, "SCALAR")
    channels: list[dict[str, Any]] = []
    samplers: list[dict[str, Any]] = []
    for k, block in enumerate(blocks):
        if not states[:, k].any():
            continue
        places = (block.centroid + states[:, k, :3]) @ Z_UP
        turns = quaternions(states[:, k, 3:] @ Z_UP)
        for path, values, kind in (("translation", places, "VEC3"), ("rotation", turns, "VEC4")):
            channels.append({"sampler": len(samplers), "target": {"node": k, "path": path}})
            output = data.add(values.astype("<f4"), _FLOAT, kind)
            samplers.append({"input": clock, "output": output, "interpolation": "LINEAR"})
    return {"name": "motion", "channels": channels, "samplers": samplers}


def quaternions(turns: Array) -> Array:
    """Return the unit quaternions (k, 4), x y z w, of rotation vectors (k, 3), rad."""
    half = np.linalg.norm(turns, axis=1, keepdims=True) / 2.0
    return np.hstack([turns / 2.0 * np.sinc(half / np.pi), np.cos(half)])


def _container(text: bytes, binary: bytes) -> bytes:
    parts = [text + b" " * (-len(text) % 4), binary]
    chunks = [
        len(part).to_bytes(4, "little") + kind + part for kind, part in zip(_CHUNKS, parts, strict=True)
    ]
    size = 12 + sum(map(len, chunks))
    return b"glTF" + (2).to_bytes(4, "little") + size.to_bytes(4, "little") + b"".join(chunks)
