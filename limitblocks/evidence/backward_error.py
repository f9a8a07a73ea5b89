"""Backward error: the change of the model for which a state is an exact solution of Eqs (54)-(59).

Load factor and stresses stay. Limits of rows move to where the state is, directions of flow turn, loads of
blocks balance the stresses, and the mechanism becomes the nearest that is exact. The changed problem is built
and the state put into its equations: the number stands only where they hold to the tolerance of an answer.
docs/backward-error.md says what follows.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any
from weakref import ref

import numpy as np

from limitblocks.errors import ModelError
from limitblocks.evidence.claim import real_number
from limitblocks.evidence.given_state import Given
from limitblocks.evidence.nearby import Nearby, nearby
from limitblocks.evidence.residuals import TOLERANCE, Residual, Residuals, mcp_residuals, residual
from limitblocks.known import known
from limitblocks.problem import Flow, State
from limitblocks.shown import Shown

LEVELS = tuple(10.0 ** np.arange(-10.0, 0.1, 0.5))  # of changes of the model that are tried
SHOWN = 5  # places that are named
LARGE = 1e-4  # from where on it is told, however small the residuals are
ROUNDING = 1e-12  # changes that no place is named for
MEANINGS = {
    "limits": "relative change of friction, or of the distance of an edge, that takes rows to yield",
    "flow": "angle in radians by which flow turns",
    "loads": "change of the loads of a block over what acts on it",
    "mechanism": "change of the mechanism to the nearest exact one, over its largest rate",
}
UNKNOWN = tuple((name, np.inf, meaning) for name, meaning in MEANINGS.items())


@dataclass(frozen=True, eq=False, repr=False)
class BackwardError(Shown):
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
    model : float
        Least change of the model found that is enough with any mechanism, that of `exact`.
    exact : State, optional
        The state with this mechanism, dimensionless.
    """

    limits: Residual
    flow: Residual
    loads: Residual
    mechanism: Residual
    places: tuple[tuple[str, float], ...]
    model: float
    exact: State | None

    @property
    def parts(self) -> tuple[Residual, ...]:
        """The four parts."""
        return self.limits, self.flow, self.loads, self.mechanism

    @property
    def value(self) -> float:
        """The largest part."""
        return max(part.value for part in self.parts)

    def __str__(self) -> str:
        worst = max(self.parts, key=lambda part: part.value)
        place = f" at {worst.where}" if worst.where else ""
        return f"backward error {self.value:.1e} ({worst.name}{place})"

    def to_dict(self) -> dict[str, Any]:
        """Return the numbers and the places."""
        parts = {part.name: part.value for part in self.parts}
        return (
            {"value": self.value}
            | parts
            | {"model": self.model, "places": [list(place) for place in self.places]}
            | {"at": {part.name: part.where for part in self.parts}}
        )


def backward_error(flow: Flow, state: State, most: float = np.inf) -> BackwardError:
    """Return the backward error of a dimensionless state; infinite where it may be but is beyond `most`.

    The least of some levels of change is searched for at which the state is exact, see
    :func:`limitblocks.evidence.nearby.nearby`. What is found up to LARGE is known from then on: the end of a
    path is asked for it twice.
    """
    softening = 0.0 if flow.constant else flow.softening
    rule = ref(flow.problem), flow.dilatancy, flow.turning, softening
    error = known(state, ("backward error", *rule), lambda: _searched(flow, state, LARGE))
    if error.value <= LARGE or most <= LARGE:
        return error
    return _searched(flow, state, most, 0.0 if error.exact else LARGE)


def _searched(flow: Flow, state: State, most: float, above: float = 0.0) -> BackwardError:
    """The backward error, where no level up to `above` leads to an exact problem."""
    parts = (state.load_factor, state.x, state.u, state.y)
    with np.errstate(all="ignore"):  # what is undefined is infinite
        given = Given(flow, state)
        free = least(given, most, above=above) if all(np.isfinite(part).all() for part in parts) else None
        if free is None:
            return unknown()
        held = least(given, most, held=True) if moved_by(given, free).value > free.change else None
        both = [one for one in (free, held) if one]
        near = min(both, key=lambda one: max(one.change, moved_by(given, one).value))
        return _error(given, near, min(both, key=lambda one: one.change))


def unknown() -> BackwardError:
    """Return the backward error of a state of which none is known: infinite."""
    limits, turned, loads, moved = (Residual(*one) for one in UNKNOWN)
    return BackwardError(limits, turned, loads, moved, (), np.inf, None)


def checked_limit(limit: Any) -> float | None:
    """Return a limit of the backward error as a number above 0, None if there is none; or ModelError."""
    if limit is None:
        return None
    number = real_number("backward_error", limit)
    if not number > 0.0:
        raise ModelError(f"backward_error is {limit!r}, expected a number above 0, such as 1e-4")
    return number


def settled(
    flow: Flow, state: State, tolerance: float, limit: float | None, most: float = np.inf
) -> tuple[State, BackwardError]:
    """Return the state that is told, and its backward error, infinite where it is beyond `most`.

    Where residuals are above the tolerance and a change of the model within `limit` is enough, it is the
    state with the exact mechanism; else the one given.
    """
    error = backward_error(flow, state, most)
    if limit is None or error.exact is None or error.model > limit:
        return state, error
    if mcp_residuals(flow, state).worst.value <= tolerance:
        return state, error
    return error.exact, backward_error(flow, error.exact, most)


def within(error: BackwardError, residuals: Residuals, tolerance: float, limit: float | None) -> bool:
    """Whether a state is exact for a model within `limit`.

    Its interfaces must dissipate as nearly, and where the dead loads alone are judged they must stand.
    """
    names = [entry.name for entry in residuals.above(tolerance)]
    stands = "standing" not in names
    return limit is not None and stands and max(error.value, residuals["dissipation"]) <= limit


def far_off(error: BackwardError, residuals: Residuals, tolerance: float) -> tuple[str, ...]:
    """Return a remark where residuals are within the tolerance and yet no model nearby is known."""
    if error.value <= LARGE or residuals.worst.value > tolerance:
        return ()
    known = (
        f"by {error.value:.1g} of its friction, edges or loads"
        if np.isfinite(error.value)
        else "by as much as is not known"
    )
    return (
        f"the residuals are within {tolerance:g}, yet the state is exact only for a model changed {known}: "
        "the load factor may be farther off than they are, and another solution near it may carry less",
    )


def least(given: Given, most: float = np.inf, *, held: bool = False, above: float = 0.0) -> Nearby | None:
    """The nearest exact problem of those found at levels `above` one up to `most`, from the least upwards.

    Where the mechanism is `held` it must not move by more than the level, either.
    """
    best: Nearby | None = None
    for level in LEVELS[slice(*np.searchsorted(LEVELS, (above, most), "right"))]:
        if best is not None and best.change <= level:
            break
        near = nearby(given, level, held)
        if near is None or (held and moved_by(given, near).value > level) or not is_exact(near):
            continue
        best = near if best is None or near.change < best.change else best
    return best


def is_exact(near: Nearby) -> bool:
    """Whether the state solves Eqs (54)-(59) of the changed problem; they do not ask for dissipation."""
    entries = mcp_residuals(near.flow, near.state).entries
    return all(entry.value <= TOLERANCE for entry in entries if entry.name != "dissipation")


def _error(given: Given, near: Nearby, free: Nearby) -> BackwardError:
    p = given.flow.problem
    names, members = np.array(p.interfaces), p.member_interface
    turned = np.zeros(len(names))
    np.maximum.at(turned, p.stress_interface, near.turned[given.places[1]])
    limits = np.zeros(len(names))
    np.maximum.at(limits, members, np.abs(near.limits))
    changes = np.concatenate([np.maximum(limits, turned), near.loads])
    where = (*p.interfaces, *p.blocks)
    worst = [k for k in np.argsort(-changes, kind="stable")[:SHOWN].tolist() if changes[k] > ROUNDING]
    return BackwardError(
        residual("limits", limits, MEANINGS["limits"], where=p.interfaces),
        residual("flow", np.arctan(turned), MEANINGS["flow"], where=p.interfaces),
        residual("loads", near.loads, MEANINGS["loads"], where=p.blocks),
        moved_by(given, near),
        tuple((where[k], float(changes[k])) for k in worst),
        free.change,
        free.mechanism,
    )


def moved_by(given: Given, near: Nearby) -> Residual:
    """Largest change of the rates of a block and of the flow of an interface, over the largest rate."""
    p, state, exact = given.flow.problem, given.state, near.mechanism
    block, interface = np.repeat(p.units.block_force, 6), p.units.interface_force[p.stress_interface]
    largest = np.abs(exact.u / block).max()
    blocks = np.abs((exact.u - state.u) / block).reshape(-1, 6).max(axis=1)
    flows = np.zeros(len(p.interfaces))
    np.maximum.at(flows, p.stress_interface, np.abs(given.G.T @ (exact.y - state.y) / interface))
    where = (*p.blocks, *p.interfaces)
    return residual("mechanism", np.append(blocks, flows), MEANINGS["mechanism"], largest, where)
