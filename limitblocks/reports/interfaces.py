"""The interfaces that a result puts to use, as rows to read, and all of them for programs."""

from __future__ import annotations

from collections import Counter
from typing import Any, NamedTuple

import numpy as np

from limitblocks.arrays import Array
from limitblocks.drawing.ties import tie_lines
from limitblocks.evidence.interface_states import InterfaceStates, interface_states
from limitblocks.geometry.ends import ends_of
from limitblocks.geometry.polygon import areas
from limitblocks.joints import Backfill, Dowel, Tie
from limitblocks.model import Model
from limitblocks.reports.document import Cell
from limitblocks.reports.scene import in_scene, short, without_noise
from limitblocks.reports.words import joint_words
from limitblocks.shown import coordinates

IDLE = 1e-3  # of the strength of fill: a row prints less as 0.000
#: Interfaces listed, those first that move most.
MOST = 40


MOVES = "Moves: how far its two sides move apart or along one another, over the largest."
TIGHT = "N and utilisation of a prestressed tie are those beyond its prestress, which is a dead load."


class Active(NamedTuple):
    """Interfaces that do not stick: rows, how many there are of how many, and what to know."""

    rows: tuple[tuple[Cell, ...], ...]
    active: int
    interfaces: int
    note: str


HEADS = (
    "Interface", "State", "Moves", "Utilisation", "N, kN", "V1, kN", "V2, kN", "M1, kN m", "M2, kN m",
    "T, kN m", "Active modes",
)  # fmt: skip


def active_interfaces(model: Model, result: Any) -> Active | None:
    """Return the interfaces that do not stick at collapse; None for a result without a mechanism."""
    if not in_scene(result):
        return None
    states = interface_states(model, result)
    active = np.array([word != "stick" for word in states.state], dtype=bool)
    moves = relative_motion(model, result.collapse.displacement_rates)
    moves = moves / max(float(moves.max(initial=0.0)), 1e-300)
    # then those that use most of their strength, then the most compressed
    order = np.lexsort((states.stress_resultants[:, 2], -states.utilisation.round(3), -moves.round(3)))
    shown = [k for k in order.tolist() if active[k]]
    resultants = without_noise(states.stress_resultants)
    names = Counter(states.names)
    rows = tuple(_row(states, names, resultants[k], float(moves[k]), k) for k in shown[:MOST])
    tight = any(isinstance(one.joint, Tie) and one.joint.prestress for one in model.interfaces)
    note = f"{MOVES} {TIGHT}" if tight else MOVES
    return Active(rows, len(shown), len(states.names), note)


def relative_motion(model: Model, rates: Array) -> Array:
    """Return by how much the two blocks of each interface move apart or along one another, (m,).

    The largest over the corners of its polygon of the difference of v + w x r of both blocks, m, for
    displacement rates (n, 6); of a tie along its line only.
    """
    ends = ends_of(model.blocks, model.interfaces).tolist()
    centroids = np.array([block.centroid for block in model.blocks])
    largest = np.zeros(len(model.interfaces))
    for k, (interface, (i, j)) in enumerate(zip(model.interfaces, ends, strict=True)):
        if not (rates[i].any() or rates[j].any()):
            continue
        tie = isinstance(interface.joint, Tie)  # counts along its line; its ends go where they like across it
        corners = interface.centroid + (0.0 if tie else 1.0) * interface.polygon @ interface.axes[:2]
        shift = [rates[b, :3] + np.cross(rates[b, 3:], corners - centroids[b]) for b in (i, j)]
        gap = shift[1] - shift[0]
        if tie:
            gap = gap @ np.outer(interface.axes[2], interface.axes[2])
        largest[k] = float(np.linalg.norm(gap, axis=1).max())
    return largest


ELEMENT_HEADS = ("Tie, dowel or fill", "Where, m", "Force, kN", "Strength, kN", "Utilisation", "State")


def element_rows(model: Model, result: Any) -> list[tuple[str, ...]]:
    """Return what ELEMENT_HEADS says: tension of a tie with its prestress, shear of a dowel, as text."""
    states = interface_states(model, result)
    Q = without_noise(states.stress_resultants) / 1e3
    anchors = {line.interface: line.anchors.tolist() for line in tie_lines(model)}
    rows: list[tuple[str, ...]] = []
    for k, one in enumerate(model.interfaces):
        if not isinstance(one.joint, Tie | Dowel):
            continue
        area = float(areas(one.polygon)) / 1e3
        if isinstance(one.joint, Tie):
            force = float(Q[k, 2]) + one.joint.prestress * area
        else:
            force = float(np.linalg.norm(Q[k, :2]))
        most = one.joint.strength * area
        if isinstance(one.joint, Backfill) and not force > IDLE * most:
            continue  # of fill along a whole span, what presses is enough
        where = " to ".join(coordinates(end) for end in anchors.get(k, [one.centroid.tolist()]))
        said = (f"{force:.4g}", f"{most:.4g}", f"{force / most:.3f}", states.state[k])
        rows.append((states.names[k], where, *said))
    return rows


def interface_rows(model: Model, result: Any) -> list[dict[str, Any]]:
    """Return a dictionary an interface, SI units, for JSON; empty for a result without a mechanism."""
    if not in_scene(result):
        return []
    states = interface_states(model, result)
    words = {joint: joint_words(joint) for joint in dict.fromkeys(i.joint for i in model.interfaces)}
    return [
        {
            "name": name,
            "joint": words[interface.joint],
            "centroid": interface.centroid.round(6).tolist(),
            "state": states.state[k],
            "utilisation": float(states.utilisation[k]),
            "active_modes": list(states.active_modes[k]),
            "stress_resultants": short(states.stress_resultants[k]),
            "force": short(states.force[k]),
            "centre_of_pressure": [
                None if np.isnan(x) else round(x, 6) for x in states.centre_of_pressure[k].tolist()
            ],
        }
        for k, (name, interface) in enumerate(zip(states.names, model.interfaces, strict=True))
    ]


def _row(
    states: InterfaceStates, names: Counter[str], resultants: Array, moves: float, k: int
) -> tuple[Cell, ...]:
    name = states.names[k]
    if names[name] > 1:  # pieces of an area
        name += f" at {coordinates(states.centroid[k].tolist())} m"
    V1, V2, N, M1, M2, T = (resultants / 1e3).tolist()
    used = float(states.utilisation[k])
    return (
        Cell(name),
        Cell(states.state[k]),
        Cell(f"{moves:.3f}", moves),
        Cell(f"{used:.3f}", used),
        *(Cell(f"{value:.4g}", value) for value in (N, V1, V2, M1, M2, T)),
        Cell(", ".join(states.active_modes[k]) or "none"),
    )
