"""The data of the 3D picture: blocks, interfaces and results as short lists of numbers for JSON."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Any

import numpy as np

from limitblocks.arrays import Array
from limitblocks.drawing.chains import chains
from limitblocks.drawing.motion import magnification
from limitblocks.drawing.ties import has_area, tie_lines
from limitblocks.drawing.view import towards
from limitblocks.evidence.claim import ARRAYS
from limitblocks.evidence.interface_states import InterfaceStates, interface_states
from limitblocks.evidence.load_path_result import LoadPath, PathStep
from limitblocks.geometry.ends import ends_of
from limitblocks.mechanics.loads.load import resultant
from limitblocks.model import Model
from limitblocks.reports.words import joint_words

SCENE_VERSION = 4
DIGITS = 6  # of coordinates and stress resultants
DRAWN_DIGITS = 4  # of what is drawn more than read: displacements, and forces before collapse
NOISE = 1e-7  # of the largest of its kind: shown as zero
MOST_NUMBERS = 120_000  # of the steps of a load path; longer ones are thinned out
BEGINS = "begins to flow"
UNKNOWN = "not evaluated"


def scene(model: Model, results: Iterable[Any], title: str) -> dict[str, Any]:
    """Return what the viewer shows: shapes, blocks, interfaces and each result with a mechanism."""
    shown = [result for result in results if in_scene(result)]
    states = [interface_states(model, result) for result in shown]
    words = _Words.of(states, [result for result in shown if isinstance(result, LoadPath)])
    live = resultant(model.live, model.free_blocks)
    size = float(np.linalg.norm(live))
    corners = np.concatenate([block.vertices for block in model.blocks])
    origin = np.round((corners.min(axis=0) + corners.max(axis=0)) / 2) + 0.0  # WebGL has seven digits
    return {
        "schema_version": SCENE_VERSION,
        "title": title,
        "eye": short(towards(model)),
        "live": short(live / size) if size > 0.0 else None,
        "origin": origin.tolist(),
        "states": words.states,
        "modes": words.modes,
        **_blocks(model, origin),
        **_interfaces(model, origin),
        "chains": [chain for chain in chains(model) if len(chain) > 1],
        "results": [_result(model, *pair, words) for pair in zip(shown, states, strict=True)],
    }


def in_scene(result: Any) -> bool:
    """Whether the viewer shows a result."""
    collapse = getattr(result, "collapse", None)
    return collapse is not None and all(getattr(collapse, name, None) is not None for name in ARRAYS)


def short(values: Any, noise: float = 0.0, digits: int = DIGITS) -> list[float | None]:
    """Return numbers, flattened, with few digits; those below `noise` of the largest are 0, NaN is None."""
    flat = np.asarray(values, dtype=float).ravel()
    least = noise * np.nanmax(np.abs(flat), initial=0.0)
    return [
        None if not np.isfinite(value) else 0 if abs(value) <= least else _shortest(value, digits)
        for value in flat.tolist()
    ]


def without_noise(resultants: Array) -> Array:
    """Return resultants (m, 6) with 0 for forces and moments below 1e-7 of the largest of their kind."""
    sizes = np.abs(resultants)
    forces, moments = sizes[:, :3].max(initial=0.0), sizes[:, 3:].max(initial=0.0)
    return np.where(sizes > NOISE * np.repeat([forces, moments], 3), resultants, 0.0)


@dataclass(frozen=True)
class _Words:
    """Names of states and modes, to be told by their places."""

    states: list[str]
    modes: list[str]

    @classmethod
    def of(cls, states: Sequence[InterfaceStates], paths: Sequence[LoadPath]) -> _Words:
        named = dict.fromkeys(["stick", *sorted({word for one in states for word in one.state})])
        known = {str(mode) for one in states for modes in one.active_modes for mode in modes}
        known |= {str(mode) for path in paths for step in path.steps for _, mode in step.active}
        return cls([*named, *([BEGINS, UNKNOWN] if paths else [])], sorted(known))


def _blocks(model: Model, origin: Array) -> dict[str, Any]:
    """Blocks by shape: many are alike up to a translation."""
    shapes: dict[Any, int] = {}
    kinds = []
    for block in model.blocks:
        corners = tuple(short(block.vertices - block.centroid, 1e-9))
        kinds.append(shapes.setdefault((corners, block.faces), len(shapes)))
    return {
        "shapes": [{"vertices": corners, "faces": faces} for corners, faces in shapes],
        "blocks": {
            "name": [block.name for block in model.blocks],
            "shape": kinds,
            "centroid": short([block.centroid - origin for block in model.blocks], 1e-9),
            "weight": short([_weight(block.unit_weight, block.volume) for block in model.blocks]),
            "volume": short([block.volume for block in model.blocks]),
            "layer": [block.layer for block in model.blocks],
            "material": [block.material for block in model.blocks],
            "groups": [", ".join(block.groups) for block in model.blocks],
            "colour": [block.colour for block in model.blocks],
            "support": np.flatnonzero(~model.free).tolist(),
        },
    }


def _interfaces(model: Model, origin: Array) -> dict[str, Any]:
    i, j = ends_of(model.blocks, model.interfaces).T.tolist()
    outlines: dict[Any, int] = {}
    joints: dict[str, int] = {}
    kinds, laws = [], []
    for interface in model.interfaces:
        corners = tuple(short(interface.polygon @ interface.axes[:2], 1e-9))
        axes = tuple(short(interface.axes, 1e-9))
        kinds.append(outlines.setdefault((corners, axes), len(outlines)))
        laws.append(joints.setdefault(joint_words(interface.joint), len(joints)))
    return {
        "joints": list(joints),
        "outlines": [{"corners": corners, "axes": axes} for corners, axes in outlines],
        "interfaces": {
            "i": i,
            "j": j,
            "outline": kinds,
            "joint": laws,
            "centroid": short([interface.centroid - origin for interface in model.interfaces], 1e-9),
        },
        "ties": [
            [line.interface, *short(np.linalg.norm(np.diff(line.anchors, axis=0)))]
            for line in tie_lines(model)
        ],
        "named": [
            [k, one.name]
            for k, one in enumerate(model.interfaces)
            if one.name != f"{one.block_i}|{one.block_j}"
        ],
        "without_area": [k for k, drawn in enumerate(has_area(model)) if not drawn],
    }


def _result(model: Model, result: Any, states: InterfaceStates, words: _Words) -> dict[str, Any]:
    if isinstance(result, LoadPath):
        return _path(model, result, states, words)
    rates = result.collapse.displacement_rates
    return {
        "title": result.title,
        "moves": "Displacement rates, for live work 1 N m",
        "magnification": magnification(model.blocks, rates),
        "eye": short(towards(model, rates)),
        "steps": [_collapse(f"load factor {result.load_factor:.6g}", rates, states, words)],
    }


def _path(model: Model, path: LoadPath, states: InterfaceStates, words: _Words) -> dict[str, Any]:
    last = len(path.steps) - 1
    each = 6 * (len(model.blocks) + len(model.interfaces))
    shown = np.unique(np.linspace(0, last, max(2, min(last + 1, MOST_NUMBERS // each))).round().astype(int))
    steps = []
    for k in shown.tolist():
        step = path.steps[k]
        label = f"step {k} of {last}: load factor {step.load_factor:.6g}"
        if k == last:
            steps.append(_collapse(label, step.displacements, states, words))
        else:
            steps.append(_before(model, label, step, words))
    return {
        "title": path.title,
        "moves": "Displacement since the permanent loads",
        "magnification": magnification(model.blocks, path.steps[-1].displacements),
        "eye": short(towards(model, path.collapse.displacement_rates)),
        "steps": steps,
    }


def _collapse(label: str, moved: Array, states: InterfaceStates, words: _Words) -> dict[str, Any]:
    return {
        "label": label,
        "displacements": short(moved, NOISE, DRAWN_DIGITS),
        "stress_resultants": short(without_noise(states.stress_resultants)),
        "states": [words.states.index(word) for word in states.state],
        "utilisation": short(states.utilisation.round(4)),
        "modes": [[words.modes.index(mode) for mode in modes] for modes in states.active_modes],
    }


def _before(model: Model, label: str, step: PathStep, words: _Words) -> dict[str, Any]:
    """A step before collapse: which interfaces begin to flow is known, their utilisation is not kept."""
    ordered = sorted(step.active)
    begun = {name: [mode for _, mode in pairs] for name, pairs in groupby(ordered, lambda pair: pair[0])}
    names = [interface.name for interface in model.interfaces]
    known = {mode: k for k, mode in enumerate(words.modes)}
    return {
        "label": label,
        "displacements": short(step.displacements, NOISE, DRAWN_DIGITS),
        "stress_resultants": short(without_noise(step.stress_resultants), 0.0, DRAWN_DIGITS),
        "states": [words.states.index(BEGINS if name in begun else UNKNOWN) for name in names],
        "utilisation": [None] * len(names),
        "modes": [[known[mode] for mode in begun.get(name, ())] for name in names],
    }


def _weight(unit_weight: float | None, volume: float) -> float:
    return np.nan if unit_weight is None else unit_weight * volume


def _shortest(value: float, digits: int) -> float:
    brief = float(f"{value:.{digits}g}")
    return int(brief) if brief.is_integer() else brief
