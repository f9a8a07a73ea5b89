"""The interfaces that a result puts to use, as rows to read, and all of them for programs."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from limitblocks.arrays import Array
from limitblocks.evidence.associated import Bounds
from limitblocks.evidence.interface_states import InterfaceStates, interface_states
from limitblocks.evidence.load_path_result import LoadPath
from limitblocks.evidence.results import Nonassociated
from limitblocks.model import Model
from limitblocks.reports.scene import short, without_noise

#: Interfaces listed, those first that use most of their strength and are compressed most.
MOST = 200


class Cell(NamedTuple):
    """Text of a cell, and the number it sorts by; None for text."""

    text: str
    value: float | None = None


class Active(NamedTuple):
    """Interfaces that do not stick: title of the result, heads, rows, how many there are of how many."""

    title: str
    heads: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]
    active: int
    interfaces: int


HEADS = (
    "Interface", "State", "Utilisation", "N, kN", "V1, kN", "V2, kN", "M1, kN m", "M2, kN m", "T, kN m",
    "Active modes",
)  # fmt: skip


def active_interfaces(model: Model, result: Any, title: str) -> Active | None:
    """Return the interfaces that do not stick at collapse; None for a result without a mechanism."""
    if not isinstance(result, Bounds | Nonassociated | LoadPath):
        return None
    states = interface_states(model, result)
    active = np.array([word != "stick" for word in states.state], dtype=bool)
    order = np.lexsort((states.stress_resultants[:, 2], -states.utilisation.round(3)))  # then most compressed
    shown = [k for k in order.tolist() if active[k]]
    resultants = without_noise(states.stress_resultants)
    rows = tuple(_row(states, resultants[k], k) for k in shown[:MOST])
    return Active(title, HEADS, rows, len(shown), len(states.names))


def interface_rows(model: Model, result: Any) -> list[dict[str, Any]]:
    """Return a dictionary an interface, SI units, for JSON; empty for a result without a mechanism."""
    if not isinstance(result, Bounds | Nonassociated | LoadPath):
        return []
    states = interface_states(model, result)
    return [
        {
            "name": name,
            "joint": repr(interface.joint),
            "state": states.state[k],
            "utilisation": float(states.utilisation[k]),
            "active_modes": list(states.active_modes[k]),
            "stress_resultants": short(states.stress_resultants[k]),
            "force": short(states.force[k]),
            "centre_of_pressure": short(states.centre_of_pressure[k]),
        }
        for k, (name, interface) in enumerate(zip(states.names, model.interfaces, strict=True))
    ]


def _row(states: InterfaceStates, resultants: Array, k: int) -> tuple[Cell, ...]:
    V1, V2, N, M1, M2, T = (resultants / 1e3).tolist()
    used = float(states.utilisation[k])
    return (
        Cell(states.names[k]),
        Cell(states.state[k]),
        Cell(f"{used:.3f}", used),
        *(Cell(f"{value:.4g}", value) for value in (N, V1, V2, M1, M2, T)),
        Cell(", ".join(states.active_modes[k]) or "none"),
    )
