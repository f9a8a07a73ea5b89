"""Backward error: the change of the model for which a state is an exact solution of Eqs (54)-(59).

Load factor and stresses stay. Limits of rows move to where the state is, directions of flow turn, loads of
blocks balance the stresses, and the mechanism becomes the nearest that is exact. The changed problem is built
and the state put into its equations: the number stands only where they hold to the tolerance of an answer.
docs/backward-error.md says what follows.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from limitblocks.arrays import Array
from limitblocks.evidence.nearby import Given, Nearby, nearby
from limitblocks.evidence.residuals import TOLERANCE, Residual, Residuals, mcp_residuals, residual
from limitblocks.problem import Flow, State

LEVELS = tuple(10.0 ** np.arange(-10.0, 0.1, 0.5))  # of changes of the model that are tried
SHOWN = 5  # places that are named
ROUNDING = 1e-12  # changes that no place is named for
MEANINGS = {
    "limits": "relative change of friction, or of the distance of an edge, that takes rows to yield",
    "flow": "angle in radians by which flow turns",
    "loads": "change of the loads of a block over what acts on it",
    "mechanism": "change of the mechanism to the nearest exact one, over its largest rate",
}


@dataclass(frozen=True, eq=False)
class BackwardError:
    """Relative change of the model for which a state is an exact solution of Eqs (54)-(59).

    It is at most this; a smaller one may do. Infinite if none was found.

    Attributes
    ----------
    limits, flow, loads : Residual
        Largest change of the strength of a row, of a direction of flow (rad), and of the loads of a block.
    mechanism : Residual
        How far the mechanism of the state is from that of the exact solution, over its largest rate.
    places : tuple of (str, float)
        Interfaces and blocks where the change of the model is largest, the largest first.
    exact : State, optional
        The state with the exact mechanism, dimensionless.
    """

    limits: Residual
    flow: Residual
    loads: Residual
    mechanism: Residual
    places: tuple[tuple[str, float], ...]
    exact: State | None

    @property
    def parts(self) -> tuple[Residual, ...]:
        """The four parts."""
        return self.limits, self.flow, self.loads, self.mechanism

    @property
    def value(self) -> float:
        """The largest part."""
        return max(part.value for part in self.parts)

    @property
    def model(self) -> float:
        """The largest change of the model; the mechanism is that of `exact`."""
        return max(part.value for part in self.parts[:3])

    def __str__(self) -> str:
        worst = max(self.parts, key=lambda part: part.value)
        place = f" at {worst.where}" if worst.where else ""
        return f"backward error {self.value:.1e} ({worst.name}{place})"

    def to_dict(self) -> dict[str, Any]:
        """Return the numbers and the places."""
        parts = {part.name: part.value for part in self.parts}
        return {"value": self.value} | parts | {"places": [list(place) for place in self.places]}


def backward_error(flow: Flow, state: State) -> BackwardError:
    """Return the backward error of a dimensionless state.

    The least of some levels of change is searched for at which the state is exact, see
    :func:`limitblocks.evidence.nearby.nearby`.
    """
    parts = (state.load_factor, state.x, state.u, state.y)
    with np.errstate(all="ignore"):  # what is undefined is infinite
        found = _least(Given(flow, state)) if all(np.isfinite(part).all() for part in parts) else None
        if found is None:
            none = [Residual(name, np.inf, meaning) for name, meaning in MEANINGS.items()]
            return BackwardError(*none, (), None)
        return _error(flow, state, found)


def _least(given: Given) -> Nearby | None:
    """The nearest exact problem of those found, by bisection over the levels after the least of them."""
    best: Nearby | None = None
    low, high, k = -1, len(LEVELS), 0
    while high - low > 1:
        found = nearby(given, LEVELS[k])
        if found is not None and is_exact(found):
            best = found if best is None or found.change < best.change else best
            high = k
        else:
            low = k
        k = (low + high) // 2
    return best


def is_exact(found: Nearby) -> bool:
    """Whether the state solves Eqs (54)-(59) of the changed problem; they do not ask for dissipation."""
    entries = mcp_residuals(found.flow, found.state).entries
    return all(entry.value <= TOLERANCE for entry in entries if entry.name != "dissipation")


def _error(flow: Flow, state: State, found: Nearby) -> BackwardError:
    p = flow.problem
    names, members = np.array(p.interfaces), p.member_interface
    turned = np.zeros(len(names))
    np.maximum.at(turned, p.stress_interface, found.turned[Given(flow, state).places[1]])
    limits = np.zeros(len(names))
    np.maximum.at(limits, members, np.abs(found.limits))
    changes = np.concatenate([np.maximum(limits, turned), found.loads])
    where = (*p.interfaces, *p.blocks)
    worst = [k for k in np.argsort(-changes, kind="stable")[:SHOWN].tolist() if changes[k] > ROUNDING]
    return BackwardError(
        residual("limits", limits, MEANINGS["limits"], where=p.interfaces),
        residual("flow", np.arctan(turned), MEANINGS["flow"], where=p.interfaces),
        residual("loads", found.loads, MEANINGS["loads"], where=p.blocks),
        _moved(flow, state, found.mechanism),
        tuple((where[k], float(changes[k])) for k in worst),
        found.mechanism,
    )


def _moved(flow: Flow, state: State, exact: State) -> Residual:
    """Largest change of the rates of a block and of the flow of an interface, over the largest rate."""
    p, G = flow.problem, flow.matrix(state.x)
    block, interface = np.repeat(p.units.block_force, 6), p.units.interface_force[p.stress_interface]
    largest = np.abs(exact.u / block).max()
    blocks = np.abs((exact.u - state.u) / block).reshape(-1, 6).max(axis=1)
    flows = np.zeros(len(p.interfaces))
    np.maximum.at(flows, p.stress_interface, np.abs(G.T @ (exact.y - state.y) / interface))
    where = (*p.blocks, *p.interfaces)
    return residual("mechanism", np.append(blocks, flows), MEANINGS["mechanism"], largest, where)
