"""GLB out, by trimesh: each block a node about its centroid, with the motion of a result as an animation.

trimesh writes no animations; see the glTF 2.0 specification, sections 3.6 (data) and 3.11 (animations).
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from limitblocks.arrays import Array
from limitblocks.drawing.motion import motion, places
from limitblocks.errors import ModelError, path_of
from limitblocks.geometry import Block
from limitblocks.io.colours import linear_of
from limitblocks.io.imported import plain
from limitblocks.io.packages import package
from limitblocks.io.placed import Z_UP
from limitblocks.model import Model, checked_model
from limitblocks.written import write

_FLOAT = 5126  # component type
_COLOURS = {"support": (0.35, 0.37, 0.4, 1.0), "block": (0.76, 0.68, 0.56, 1.0)}
_SECONDS = 2.0  # length of the animation


def write_animation(model: Model, file: str | Path, result: Any, *, overwrite: bool = False) -> Path:
    """Write a model with the motion of a result as an animation to a GLB file, and return its path.

    A mechanism grows from nothing in two seconds; a load path passes through its steps in them. Motion
    is scaled as in :func:`limitblocks.files.write_vtu`, and the rotations are true ones, not their linear
    part. Capacity curves and settlements until collapse pass through their points at true size.

    Parameters
    ----------
    model : Model
    file : str or Path
        Name of a file that ends in .glb.
    result : LoadPath, CapacityCurve, SettlementCurve, or any result with `displacement_rates` (n, 6)
    overwrite : bool
        Replace the file if it exists.

    Raises
    ------
    LimitBlocksError
        The file exists and `overwrite` is false, or it cannot be written.
    MissingDependency
        trimesh is not installed.
    ModelError
        The suffix is not .glb, or the result belongs to another model.
    """
    model, path = checked_model(model), animation_path(file)
    states = places(model, result) if hasattr(result, "points") else motion(model, result).states
    fixed = (~model.free).tolist()
    still = np.zeros_like(states[:1])
    return write(path, encoded(plain(model.blocks, fixed), fixed, np.concatenate([still, states])), overwrite)


def animation_path(file: str | Path) -> Path:
    """Return the path of an animation, or raise ModelError if it does not end in .glb."""
    path = path_of(file)
    if path.suffix.lower() != ".glb":
        raise ModelError(f"{path}: suffix {path.suffix!r} is not that of an animation; expected .glb")
    return path


def encoded(blocks: Sequence[Block], fixed: Sequence[bool], states: Array | None = None) -> bytes:
    """Return the GLB file of blocks, with an animation through the displacements `states` (k, n, 6)."""
    trimesh, gltf = package("trimesh", "GLB"), package("trimesh.exchange.gltf", "GLB")
    scene = trimesh.Scene()
    for k, (block, support) in enumerate(zip(blocks, fixed, strict=True)):
        visual = trimesh.visual.TextureVisuals(material=_material(trimesh, block, support))
        points = (block.vertices - block.centroid) @ Z_UP
        mesh = trimesh.Trimesh(points, block.triangles, process=False, visual=visual)
        scene.add_geometry(mesh, node_name=str(k), geom_name=str(k))

    origin = blocks[0].centroid if blocks and states is not None else np.zeros(3)

    def finish(buffers: dict[str, bytes], document: dict[str, Any]) -> None:
        for block, node, mesh in zip(blocks, document["nodes"], document["meshes"], strict=True):
            # an animation moves a translation, not the matrix that trimesh would write
            node |= {"name": block.name, "translation": ((block.centroid - origin) @ Z_UP).tolist()}
            mesh["name"] = block.name
            # what the material alone would not tell; its colour is for show where the block has none
            extras: dict[str, Any] = {"layer": block.layer} if block.material else {}
            if block.groups:
                extras["groups"] = list(block.groups)
            node["extras"] = extras | {"colour": block.colour}
        if states is not None:
            document["animations"] = [_animation(buffers, document["accessors"], blocks, states, origin)]
            # about a node of its own: tracks have single precision, nodes all digits
            whole = {"translation": (origin @ Z_UP).tolist(), "children": list(range(len(blocks)))}
            document["nodes"].append(whole)
            document["scenes"][0]["nodes"] = [len(blocks)]

    return bytes(gltf.export_glb(scene, include_normals=False, buffer_postprocessor=finish))


def _material(trimesh: ModuleType, block: Block, support: bool) -> Any:
    shown = _COLOURS["support" if support else "block"]
    return trimesh.visual.material.PBRMaterial(
        name=block.material or block.layer or None,
        baseColorFactor=(*linear_of(block.colour), 1.0) if block.colour else shown,
        metallicFactor=0.0,
        roughnessFactor=0.9,
        doubleSided=True,
    )


def _animation(
    buffers: dict[str, bytes],
    accessors: dict[str, Any],
    blocks: Sequence[Block],
    states: Array,
    origin: Array,
) -> dict[str, Any]:
    """Return translation, off `origin`, and rotation of each moving block through `states` (k, n, 6)."""

    def add(values: Array, kind: str) -> int:
        """Append `values` (k, columns) and return the number of their accessor."""
        data, number = values.astype("<f4"), len(accessors)
        ends = {"min": data.min(axis=0).tolist(), "max": data.max(axis=0).tolist()}
        accessors[f"track {number}"] = {
            "bufferView": len(buffers), "componentType": _FLOAT, "count": len(data), "type": kind, **ends
        }  # fmt: skip
        buffers[f"track {number}"] = data.tobytes()
        return number

    clock = add(np.linspace(0.0, _SECONDS, len(states)).reshape(-1, 1), "SCALAR")
    channels: list[dict[str, Any]] = []
    samplers: list[dict[str, Any]] = []
    for k in np.flatnonzero(states.any(axis=(0, 2))).tolist():
        places = (blocks[k].centroid - origin + states[:, k, :3]) @ Z_UP
        turns = Rotation.from_rotvec(states[:, k, 3:] @ Z_UP).as_quat()
        for path, values, kind in (("translation", places, "VEC3"), ("rotation", turns, "VEC4")):
            channels.append({"sampler": len(samplers), "target": {"node": k, "path": path}})
            samplers.append({"input": clock, "output": add(values, kind), "interpolation": "LINEAR"})
    return {"name": "motion", "channels": channels, "samplers": samplers}
