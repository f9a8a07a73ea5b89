"""A result as GLB, by trimesh: blocks in glass, displaced blocks and arrows as meshes."""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from limitblocks.arrays import Array
from limitblocks.drawing.arrows import Picture
from limitblocks.io.packages import package
from limitblocks.io.placed import Z_UP

_COLOURS = {
    "blocks": (0.76, 0.68, 0.56, 0.25),
    "displaced": (0.76, 0.68, 0.56, 1.0),
    "forces": (0.0, 0.45, 0.7, 1.0),
}
#: Of an arrow: radius of its shaft over the diagonal of the structure, and of its head over that.
_SHAFT, _HEAD = 2e-3, 3.0
#: Length of the head over its radius, and the most of an arrow that it takes.
_SLENDER, _MOST = 3.0, 0.5
_SIDES = 8


def with_forces(shown: Picture) -> bytes:
    """Return the file: nodes "blocks", "displaced" and "forces" with a node a block or arrow.

    The extras of an arrow have its force and moment in N and N m, with Z up, and its point of action, m.
    """
    trimesh, gltf = package("trimesh", "GLB"), package("trimesh.exchange.gltf", "GLB")
    scene = trimesh.Scene()
    names: dict[str, str] = {}
    extras: dict[str, dict[str, Any]] = {}
    materials = {group: _material(trimesh, group) for group in _COLOURS}
    for group in _COLOURS:
        scene.graph.update(frame_from="world", frame_to=group, matrix=np.eye(4))

    def add(group: str, name: str, points: Array, triangles: Any, about: Array) -> str:
        key = f"{group} {len(names)}"
        visual = trimesh.visual.TextureVisuals(material=materials[group])
        shape = trimesh.Trimesh((points - about) @ Z_UP, triangles, process=False, visual=visual)
        place = trimesh.transformations.translation_matrix(about @ Z_UP)
        scene.add_geometry(shape, node_name=key, geom_name=key, parent_node_name=group, transform=place)
        names[key] = name
        return key

    for group, bodies in (("blocks", shown.blocks), ("displaced", shown.displaced)):
        for block in bodies:
            add(group, block.name, block.vertices, block.triangles, block.centroid)
    diagonal = float(np.linalg.norm(np.ptp(np.concatenate([b.vertices for b in shown.blocks]), axis=0)))
    for k in shown.drawn:
        points, triangles = _arrow(shown.at[k], shown.tips[k], _SHAFT * diagonal)
        key = add("forces", shown.names[k], points, triangles, shown.at[k])
        extras[key] = _said(shown, k)

    def finish(buffers: dict[str, bytes], document: dict[str, Any]) -> None:
        for node in document["nodes"]:
            if node["name"] in extras:
                node["extras"] = extras[node["name"]]
            node["name"] = names.get(node["name"], node["name"])
        for one in document["meshes"]:
            one["name"] = names[one["name"]]
        document["asset"]["extras"] = {
            "load_factor": shown.load_factor, "scale": shown.scale, "magnification": shown.magnification
        }  # fmt: skip

    return bytes(gltf.export_glb(scene, include_normals=False, buffer_postprocessor=finish))


def _material(trimesh: ModuleType, group: str) -> Any:
    return trimesh.visual.material.PBRMaterial(
        name=group,
        baseColorFactor=_COLOURS[group],
        metallicFactor=0.0,
        roughnessFactor=0.9,
        doubleSided=True,
        alphaMode="BLEND" if _COLOURS[group][3] < 1.0 else "OPAQUE",
    )


def _said(shown: Picture, k: int) -> dict[str, Any]:
    i, j = shown.pairs[k]
    vectors = {"force": shown.force, "moment": shown.moment, "at": shown.at}
    pair = {"from_block": shown.blocks[i].name, "on_block": shown.blocks[j].name}
    return pair | {word: values[k].tolist() for word, values in vectors.items()}


def _arrow(tail: Array, tip: Array, radius: float) -> tuple[Array, Any]:
    """Return vertices and triangles of a closed arrow: its profile turned about its axis."""
    length = float(np.linalg.norm(tip - tail))
    head = min(_SLENDER * _HEAD * radius, _MOST * length)
    wide = head / _SLENDER  # a short arrow is a thin one
    profile = [
        (0.0, 0.0),
        (wide / _HEAD, 0.0),
        (wide / _HEAD, length - head),
        (wide, length - head),
        (0.0, length),
    ]
    turn, _ = Rotation.align_vectors([(tip - tail) / length], [[0.0, 0.0, 1.0]])
    made = package("trimesh.creation", "GLB").revolve(np.array(profile), sections=_SIDES)
    return tail + turn.apply(made.vertices), made.faces
