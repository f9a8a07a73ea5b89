"""Blocks from Rhino 3dm files: meshes, polysurfaces and extrusions with plane faces, block instances."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np

from limitblocks.arrays import Array
from limitblocks.errors import ModelError
from limitblocks.io import shells
from limitblocks.io.colours import hex_of
from limitblocks.io.formats.rhino import breps, chunks, trial
from limitblocks.io.imported import MOST_FACES, foreign, one_line, read_bytes
from limitblocks.io.packages import package
from limitblocks.io.placed import Contents
from limitblocks.io.solid import Solid, placed, turned
from limitblocks.shown import many

_DEEPEST = 32  # instances within instances
#: Metres per unit of Rhino's unit systems.
_METRES = {
    "Microns": 1e-6, "Millimeters": 1e-3, "Centimeters": 1e-2, "Decimeters": 0.1, "Meters": 1.0,
    "Dekameters": 10.0, "Hectometers": 100.0, "Kilometers": 1e3, "Microinches": 2.54e-8, "Mils": 2.54e-5,
    "Inches": 0.0254, "Feet": 0.3048, "Yards": 0.9144,
}  # fmt: skip


class Part(NamedTuple):
    """A geometry out of its block instances: `matrix` (4, 4) takes it to the model."""

    geometry: Any
    matrix: Array
    layer: str
    name: str
    material: str
    groups: tuple[str, ...]
    colour: str

    @property
    def words(self) -> dict[str, Any]:
        """Material, groups and colour of a solid made of it."""
        return {"material": self.material, "groups": self.groups, "colour": self.colour}


def contents(path: Path) -> Contents:
    """Return the solids in a Rhino file; hidden objects and all that is no solid are left out with a note."""
    rhino3dm = package("rhino3dm", "3dm")
    model, notes = _model(rhino3dm, path)
    left_out: Counter[str] = Counter()
    wrong: dict[str, list[str]] = {}
    solids: list[Solid] = []
    with foreign("3dm"):
        for part in _Expansion(rhino3dm, model, left_out).everything():
            try:
                shape = breps.polygons(rhino3dm, part.geometry)
            except ModelError as error:
                said = [f"{part.name!r} on layer {part.layer!r}: {fault}" for fault in error.problems]
                wrong.setdefault(part.name, []).extend(said)
                continue
            if shape is None:
                left_out[type(part.geometry).__name__] += 1
            else:
                points, faces = placed(shape[0], part.matrix), turned(shape[1], part.matrix)
                made = shells.solids(part.name, part.layer, points, faces)
                solids += [solid._replace(**part.words) for solid in made]
        metres, units = _metres(model)
    listed = ", ".join(f"{number} {word}" for word, number in sorted(left_out.items()))
    if not solids and not wrong:
        shown = "; switch on what is hidden, objects and layers, and save again" * (
            "hidden objects" in left_out
        )
        raise ModelError(
            f"holds no solid{f' but {listed}' if listed else ''}; expected meshes or polysurfaces{shown}"
        )
    notes += [*units, *([f"left out: {listed}"] if listed else [])]
    hidden = left_out["hidden objects"]
    return Contents(solids, metres, notes, "z", wrong, (f"{hidden} hidden objects",) * (hidden > 0))


def _model(rhino3dm: ModuleType, path: Path) -> tuple[Any, list[str]]:
    """Return the model in a file, and a note where rhino3dm left out objects without a word."""
    data = read_bytes(path)
    fault = chunks.fault(data) or trial.fault(path)
    if fault:
        raise ModelError(fault)
    with foreign("3dm"):
        model = rhino3dm.File3dm.FromByteArray(data)
        if model is None:
            raise ModelError("is not sound 3dm: rhino3dm cannot read it; save it again in Rhino")
        lost = chunks.objects(data) - len(model.Objects)
    said = f"left out: {many(lost, 'object')} that rhino3dm cannot read, damaged or of plug-ins"
    return model, [said] * (lost > 0)


def _metres(model: Any) -> tuple[float | None, list[str]]:
    unit = str(model.Settings.ModelUnitSystem).rpartition(".")[2]
    if unit in {"None", "Unset"}:
        return None, ["states no unit of length"]
    if unit not in _METRES:
        raise ModelError(f"unit of length is {unit!r}; set one of {', '.join(_METRES)} in Rhino")
    return _METRES[unit], []


class _Above(NamedTuple):
    """What objects have of the block instance they are in: placement, name, groups, colour."""

    matrix: Array
    name: str = ""
    groups: tuple[str, ...] = ()
    colour: str = ""


class _Expansion:
    """State of taking a model apart."""

    def __init__(self, rhino3dm: ModuleType, model: Any, left_out: Counter[str]) -> None:
        self.rhino3dm, self.model, self.left_out = rhino3dm, model, left_out
        self.met = 0
        self.materials = model.Materials
        self.groups = {group.Index: one_line(group.Name) for group in model.Groups}
        self.layers = {layer.Index: layer for layer in model.Layers}
        shown = {str(layer.Id): layer for layer in model.Layers}
        self.hidden = {
            index for index, layer in self.layers.items() if not all(_visible(layer, shown, len(shown)))
        }

    def everything(self) -> Iterator[Part]:
        """Yield what the model shows, instances taken apart."""
        top = [item for item in self.model.Objects if not item.Attributes.IsInstanceDefinitionObject]
        return self.parts(top, _Above(np.eye(4)), 0)

    def parts(self, items: Sequence[Any], above: _Above, depth: int) -> Iterator[Part]:
        for item in items:
            self.met += 1
            if self.met > MOST_FACES:
                raise ModelError(f"has more than {MOST_FACES} objects, the most that are read")
            attributes, geometry = item.Attributes, item.Geometry
            layer = self.layers.get(attributes.LayerIndex)
            # objects of a definition are hidden themselves; only their layer counts
            if attributes.LayerIndex in self.hidden or (depth == 0 and not attributes.Visible):
                self.left_out["hidden objects"] += 1
                continue
            title = above.name or attributes.Name
            own = tuple(self.groups[k] for k in attributes.GetGroupList() or () if self.groups.get(k))
            groups = tuple(dict.fromkeys((*above.groups, *own)))
            colour = self.colour(attributes, layer, above.colour)
            if isinstance(geometry, self.rhino3dm.InstanceReference):
                yield from self.instances(geometry, _Above(above.matrix, title, groups, colour), depth)
            elif geometry is not None:
                path = layer.FullPath if layer is not None else ""
                title = title or f"{path} {str(attributes.Id)[:8]}".strip()
                material = self.material(attributes, layer)
                yield Part(geometry, above.matrix, path, title, material, groups, colour)

    def colour(self, attributes: Any, layer: Any, reference: str) -> str:
        """Return the colour of an object, its own or that of its layer or instance; empty for plain black."""
        sources = self.rhino3dm.ObjectColorSource
        if attributes.ColorSource == sources.ColorFromObject:
            return hex_of(*attributes.ObjectColor[:3])
        if attributes.ColorSource == sources.ColorFromParent and reference:
            return reference
        found = hex_of(*layer.Color[:3]) if layer is not None else ""
        return "" if found == "#000000" else found

    def material(self, attributes: Any, layer: Any) -> str:
        """Return the name of the material of an object, its own or that of its layer; empty for none."""
        own = attributes.MaterialSource == self.rhino3dm.ObjectMaterialSource.MaterialFromObject
        index = attributes.MaterialIndex if own else layer.RenderMaterialIndex if layer is not None else -1
        return str(self.materials[index].Name) if 0 <= index < len(self.materials) else ""

    def instances(self, reference: Any, above: _Above, depth: int) -> Iterator[Part]:
        definition = self.model.InstanceDefinitions.FindId(reference.ParentIdefId)
        if definition is None:
            raise ModelError(
                f"block instance {above.name!r}: its definition {reference.ParentIdefId} is missing"
            )
        if depth == _DEEPEST:
            raise ModelError(
                f"block {definition.Name!r} contains itself, or blocks nest deeper than {_DEEPEST}"
            )
        items = [self.model.Objects.FindId(key) for key in definition.GetObjectIds()]
        where = above._replace(
            matrix=above.matrix @ _matrix(reference.Xform), name=above.name or definition.Name
        )
        yield from self.parts([i for i in items if i is not None], where, depth + 1)


def _visible(layer: Any, known: dict[str, Any], steps: int) -> Iterator[bool]:
    """Yield whether a layer and each one above it are switched on."""
    above: Any = layer
    while above is not None and steps >= 0:
        yield bool(above.Visible)
        above, steps = known.get(str(above.ParentLayerId)), steps - 1


def _matrix(transform: Any) -> Array:
    """Return a transform as a matrix (4, 4), with the digits that its ToFloatArray drops."""
    return np.array([[getattr(transform, f"M{i}{j}") for j in range(4)] for i in range(4)], dtype=np.float64)
