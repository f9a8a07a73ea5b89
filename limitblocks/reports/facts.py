"""What a model is, in numbers and words: for `limitblocks info` and for reports."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from limitblocks.analysis.diagnosis import diagnose
from limitblocks.analysis.magnitudes import weightless
from limitblocks.drawing.elevations import dimensions, length
from limitblocks.errors import few
from limitblocks.geometry import Interface
from limitblocks.geometry.polygon import areas
from limitblocks.model import Model
from limitblocks.reports.words import assumed, joint_words, laid_on, load_words, resultant_words, times
from limitblocks.shown import coordinate, coordinates, counted, many


def facts(model: Model) -> dict[str, Any]:
    """Return the facts of a model as plain numbers, lists and text; SI units."""
    diagnosis = diagnose(model)
    corners = np.concatenate([block.vertices for block in model.blocks])
    free = model.free_blocks
    heights = np.concatenate([block.vertices[:, 2] for block in free])
    return {
        "name": model.name,
        "digest": model.digest,
        "blocks": len(model.blocks),
        "free_blocks": len(free),
        "supports": list(model.supports),
        "interfaces": len(model.interfaces),
        "weight": sum(block.weight for block in free if block.unit_weight is not None),
        "volume": sum(block.volume for block in free),
        "unit_weights": _unit_weights(model),
        "dimensions": dimensions(model),
        "heights": [float(heights.min()), float(heights.max())],
        "interface_area": float(sum(areas(one.polygon) for one in model.interfaces if not _element(one))),
        "bounding_box": [corners.min(axis=0).tolist(), corners.max(axis=0).tolist()],
        "joints": counted(_joints(model)),
        "layers": counted(block.layer for block in model.blocks),
        "materials": _materials(model),
        "groups": counted(group for block in model.blocks for group in block.groups),
        "colours": counted(block.colour for block in model.blocks),
        "left_out": list(model.left_out),
        "block_types": counted(_shape(len(block.faces), len(block.vertices)) for block in model.blocks),
        "interface_types": counted(_polygon(len(interface.polygon)) for interface in model.interfaces),
        "dead": load_words(model.dead),
        "live": load_words(model.live, laid_on(model)),
        "dead_resultant": resultant_words(model, model.dead),
        "live_resultant": resultant_words(model, model.live),
        "contacts": "; ".join([diagnosis.accuracy, *diagnosis.nothing]),
        "tolerances": diagnosis.accuracy,
        "diagnosis": diagnosis.to_dict(),
        "findings": findings(model, diagnosis),
        "warnings": diagnosis.warnings,
    }


def _element(interface: Interface) -> bool:
    """Whether it is no contact area: a tie, dowel, fill or guide, whose joints have a `word`."""
    return bool(getattr(interface.joint, "word", ""))


def fact_rows(known: dict[str, Any]) -> tuple[tuple[str, str], ...]:
    """Return the facts as rows to read: quantity and value with its unit."""
    low, high = known["bounding_box"]
    size = " × ".join(f"{b - a:.4g}" for a, b in zip(low, high, strict=True))
    overall = ", ".join(f"{name} {length(value)}" for name, value in known["dimensions"].items())
    foot, top = known["heights"]
    labels = [
        ("Layers", times(known["layers"])),
        ("Materials", "; ".join(map(_made_of, known["materials"]))),
        ("Groups", times(known["groups"])),
        ("Colours", times(known["colours"])),
        ("Left out of the file", few(known["left_out"])),
    ]
    return (
        ("Blocks", f"{known['blocks']}, of which {known['free_blocks']} free"),
        ("Supports", few(known["supports"])),
        *(row for row in labels if row[1]),
        ("Size of the free blocks", overall),
        (
            "Height of the free blocks",
            f"{length(top - foot)}, from Z = {coordinate(foot)} m to {coordinate(top)} m",
        ),
        ("Block types", times(known["block_types"])),
        ("Interfaces", f"{known['interfaces']} ({times(known['interface_types'])})"),
        ("Interface area", f"{known['interface_area']:.4g} m²"),
        ("Contacts", known["contacts"]),
        ("Joints", times(known["joints"])),
        ("Weight of the free blocks", f"{known['weight'] / 1e3:.4g} kN"),
        ("Volume of the free blocks", f"{known['volume']:.4g} m³"),
        *(
            (f"Unit weight {row[0]}", f"{many(int(row[1]), 'block')}, {row[2]}, {row[3]}")
            for row in known["unit_weights"]
        ),
        ("Bounding box", f"{size} m, from {coordinates(low)} m"),
        ("Dead load", few(known["dead"]) or "none"),
        ("Its resultant", known["dead_resultant"]),
        ("Live load", few(known["live"])),
        ("Its resultant", f"{known['live_resultant']}, at load factor 1"),
    )


def findings(model: Model, diagnosis: Any) -> list[list[str]]:
    """Return what was looked for and what was found, "none" where nothing was."""
    looked = (
        ("Blocks that touch without an interface between them", [i.name for i in diagnosis.interfaces]),
        ("Interfaces off the faces of their blocks", diagnosis.off_faces),
        ("Faces that nearly touch", diagnosis.near_misses),
        ("Blocks that overlap", diagnosis.overlaps),
        ("Blocks without any interface", diagnosis.isolated),
        ("Blocks that friction alone holds against their dead load, if anything", diagnosis.uncarried),
        ("Contacts left out because they are too small", diagnosis.slivers),
        ("Strips left out because they are too narrow", diagnosis.strips),
        ("Contacts left out because a third block lies between", diagnosis.through),
        ("Blocks without weight", weightless(model)),
        ("Numbers and loads that look like slips", diagnosis.questions),
    )
    return [[words, few([*map(str, things)]) or "checked, nothing found"] for words, things in looked]


def _joints(model: Model) -> Iterator[str]:
    """Yield the joint of each interface, after the materials that it joins where they are known."""
    material = {block.name: block.material for block in model.blocks}
    words = {joint: joint_words(joint) for joint in dict.fromkeys(i.joint for i in model.interfaces)}
    for one in model.interfaces:
        pair = "|".join(sorted((material[one.block_i], material[one.block_j])))
        yield f"{pair}: {words[one.joint]}" if pair != "|" else words[one.joint]


def _materials(model: Model) -> list[dict[str, Any]]:
    """Return the number of blocks, volume (m3) and unit weights (N/m3) of each material."""
    names = counted(block.material for block in model.blocks)
    made = {name: [block for block in model.blocks if block.material == name] for name in names}
    return [
        {
            "material": name,
            "blocks": len(blocks),
            "volume": sum(block.volume for block in blocks),
            "unit_weights": sorted({b.unit_weight for b in blocks if b.unit_weight is not None}),
        }
        for name, blocks in made.items()
    ]


def _made_of(one: dict[str, Any]) -> str:
    weights = (
        " and ".join(f"{weight / 1e3:g} kN/m³" for weight in one["unit_weights"][:3]) or "no unit weight"
    )
    return f"{one['blocks']} × {one['material']}, {one['volume']:.4g} m³, {weights}"


def assumptions(model: Model) -> dict[str, list[str]]:
    """Return what each kind of joint of the model assumes, sentences by the words for the joints alike."""
    alike: dict[tuple[str, ...], dict[str, None]] = {}
    for joint in dict.fromkeys(interface.joint for interface in model.interfaces):
        alike.setdefault(assumed(joint), {})[joint_words(joint)] = None
    return {_first(list(names)): list(said) for said, names in alike.items()}


def _first(names: list[str]) -> str:
    return "; ".join(names[:2]) + f" and {len(names) - 2} more" * (len(names) > 2)


def _unit_weights(model: Model) -> list[list[str]]:
    """A row a unit weight of the free blocks: it, how many blocks have it, their volume and weight."""
    groups: dict[float, list[float]] = {}
    for block in model.free_blocks:
        groups.setdefault(block.unit_weight or 0.0, []).append(block.volume)
    return [
        [f"{one / 1e3:.4g} kN/m³", str(len(v)), f"{sum(v):.4g} m³", f"{one * sum(v) / 1e3:.4g} kN"]
        for one, v in sorted(groups.items())
    ]


def _shape(faces: int, vertices: int) -> str:
    return f"polyhedron of {faces} faces and {vertices} vertices"


def _polygon(sides: int) -> str:
    return {3: "triangle", 4: "quadrilateral"}.get(sides, f"{sides}-sided polygon")
