"""What a model is, in numbers and words: for `limitblocks info` and for reports."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import asdict
from inspect import getdoc
from typing import Any

import numpy as np

from limitblocks.analysis.diagnosis import diagnose
from limitblocks.analysis.magnitudes import questions
from limitblocks.geometry.polygon import areas
from limitblocks.mechanics import Load
from limitblocks.model import Model

_SHOWN = 8


def facts(model: Model) -> dict[str, Any]:
    """Return the facts of a model as plain numbers, lists and text; SI units."""
    diagnosis = diagnose(model)
    corners = np.concatenate([block.vertices for block in model.blocks])
    free = model.free_blocks
    return {
        "name": model.name,
        "digest": model.digest,
        "blocks": len(model.blocks),
        "free_blocks": len(free),
        "supports": list(model.supports),
        "interfaces": len(model.interfaces),
        "weight": sum(block.weight for block in free if block.unit_weight is not None),
        "volume": sum(block.volume for block in free),
        "interface_area": float(sum(areas(interface.polygon) for interface in model.interfaces)),
        "bounding_box": [corners.min(axis=0).tolist(), corners.max(axis=0).tolist()],
        "joints": _counted(_joint_words(model)),
        "layers": _counted(block.layer for block in model.blocks if block.layer),
        "materials": _materials(model),
        "block_types": _counted(_shape(len(block.faces), len(block.vertices)) for block in model.blocks),
        "interface_types": _counted(_polygon(len(interface.polygon)) for interface in model.interfaces),
        "dead": load_words(model.dead),
        "live": load_words(model.live),
        "contacts": "; ".join([diagnosis.accuracy, *diagnosis.nothing]),
        "diagnosis": diagnosis.to_dict(),
        "warnings": warnings(model) + diagnosis.warnings,
    }


def fact_rows(known: dict[str, Any]) -> tuple[tuple[str, str], ...]:
    """Return the facts as rows to read: quantity and value with its unit."""
    low, high = known["bounding_box"]
    size = " × ".join(f"{b - a:.4g}" for a, b in zip(low, high, strict=True))
    labels = [
        ("Layers", _times(known["layers"])),
        ("Materials", "; ".join(map(_made_of, known["materials"]))),
    ]
    return (
        ("Blocks", f"{known['blocks']}, of which {known['free_blocks']} free"),
        ("Supports", _some(known["supports"])),
        *(row for row in labels if row[1]),
        ("Block types", _times(known["block_types"])),
        ("Interfaces", f"{known['interfaces']} ({_times(known['interface_types'])})"),
        ("Interface area", f"{known['interface_area']:.4g} m²"),
        ("Contacts", known["contacts"]),
        ("Joints", _times(known["joints"])),
        ("Weight of the free blocks", f"{known['weight'] / 1e3:.4g} kN"),
        ("Volume of the free blocks", f"{known['volume']:.4g} m³"),
        ("Bounding box", f"{size} m, from ({', '.join(f'{a:.4g}' for a in low)}) m"),
        ("Dead load", _some(known["dead"]) or "none"),
        ("Live load", _some(known["live"])),
    )


def _joint_words(model: Model) -> Iterator[str]:
    """Yield the joint of each interface, after the materials that it joins where they are known."""
    material = {block.name: block.material for block in model.blocks}
    for one in model.interfaces:
        pair = "|".join(sorted((material[one.block_i], material[one.block_j])))
        yield f"{pair}: {one.joint!r}" if pair != "|" else repr(one.joint)


def _materials(model: Model) -> list[dict[str, Any]]:
    """Return the number of blocks, volume (m3) and unit weights (N/m3) of each material."""
    names = _counted(block.material for block in model.blocks if block.material)
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


def load_words(load: Load) -> list[str]:
    """Return a line a term: its factor, kind and settings."""
    lines = []
    for factor, term in load.terms:
        settings = ", ".join(f"{key} {_plain(v)}" for key, v in asdict(term).items() if v not in (None, ()))
        lines.append(f"{factor:g} × {type(term).__name__}: {settings}")
    return lines


def assumptions(model: Model) -> dict[str, list[dict[str, Any]]]:
    """Return what the joints assume, from their docstrings: paragraphs with `text`, or `items` of a list."""
    classes = dict.fromkeys(type(interface.joint) for interface in model.interfaces)
    return {cls.__name__: _paragraphs((getdoc(cls) or "").split("\nParameters\n")[0]) for cls in classes}


def warnings(model: Model) -> list[str]:
    """Return what is no error but may not be meant, less what the contacts show."""
    said = []
    weightless = [block.name for block in model.free_blocks if not block.unit_weight]
    if weightless:
        said.append(f"blocks without weight: {_some(weightless)}")
    if not model.dead.terms:
        said.append("no dead load: the structure has no weight to stabilise it")
    return said + questions(model)


def _counted(words: Iterable[str]) -> dict[str, int]:
    return dict(Counter(words).most_common())


def _shape(faces: int, vertices: int) -> str:
    return f"polyhedron of {faces} faces and {vertices} vertices"


def _polygon(sides: int) -> str:
    return {3: "triangle", 4: "quadrilateral"}.get(sides, f"{sides}-sided polygon")


def _some(names: list[str]) -> str:
    return ", ".join(names[:_SHOWN]) + (f" and {len(names) - _SHOWN} more" if len(names) > _SHOWN else "")


def _plain(value: Any) -> str:
    if not isinstance(value, tuple):
        return str(value)
    return "(" + ", ".join(f"{part:g}" if isinstance(part, float) else str(part) for part in value) + ")"


def _times(counts: dict[str, int]) -> str:
    return _some([f"{count} × {word}" for word, count in counts.items()])


def _paragraphs(text: str) -> list[dict[str, Any]]:
    parts: list[dict[str, Any]] = []
    for paragraph in text.strip().split("\n\n"):
        plain = paragraph.replace("`", "")
        if plain.startswith("- "):
            items = [" ".join(item.split()) for item in plain[2:].split("\n- ")]
            parts.append({"text": "", "items": items})
        else:
            parts.append({"text": " ".join(plain.split()), "items": []})
    return parts
