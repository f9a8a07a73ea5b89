"""What the increments of a load path tell: its steps, its snaps and the trace of its arclength."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from limitblocks.analysis.in_si import resultants_of
from limitblocks.analysis.nonassociated.increment import Increment
from limitblocks.analysis.nonassociated.loading import Pushed, at_rest
from limitblocks.analysis.nonassociated.stretch import Visit
from limitblocks.arrays import Array, read_only
from limitblocks.evidence.load_path_result import PathStep, Snap
from limitblocks.evidence.residuals import mcp_residuals
from limitblocks.model import Model
from limitblocks.problem import Flow, State

FLOWING = 1e-6  # of the largest displacement rate: less counts as no flow

Pairs = frozenset[tuple[str, str]]


class Told(NamedTuple):
    """Displacements (6 n,), m and rad, over dimensionless ones; whether unstable states are steps."""

    unit: Array
    snaps: str


def told(
    model: Model, flow: Flow, x0: Array, pushes: tuple[Pushed, ...], last: State, how: Told
) -> tuple[tuple[PathStep, ...], tuple[Snap, ...], Array]:
    """Return the steps from the stresses `x0` to `last`, the snaps and the trace (k, 3)."""
    teller = _Teller(model, flow, how.unit)
    first = at_rest(flow, x0)
    begin = teller.add(first, "start" if first.load_factor else "permanent loads")
    snaps, trace = [], [np.array([(0.0, 0.0, begin.load_factor)])]
    for one in pushes:
        trace.append(teller.trace(one.increment, trace[-1][-1, 0]))
        for before, after in one.increment.folds:
            visits = one.increment.visits
            fold = teller.add(_total(visits[before]), "before snap")
            for visit in visits[before + 1 : after] if how.snaps == "along" else ():
                teller.add(_total(visit), "unstable")
            snaps.append(Snap(fold, teller.add(_total(visits[after]), "after snap")))
        z = one.increment.end
        teller.add(State(z.load_factor, z.x, z.u / one.increment.rho, z.y / one.increment.rho), "step")
        teller.moved = teller.moved + z.u / one.increment.rho
    still = State(last.load_factor, last.x, 0.0 * last.u, 0.0 * last.y)  # the polish changes stresses only
    teller.add(still, "polish", rates=last)
    return tuple(teller.steps), tuple(snaps), np.concatenate(trace)


def _total(visit: Visit) -> State:
    """A visit with displacements and multipliers since the start of its increment."""
    z = visit.point
    return State(z.load_factor, z.x, z.u / visit.rho, z.y / visit.rho)


@dataclass
class _Teller:
    """Steps told so far, and the displacements at the start of the increment, dimensionless."""

    model: Model
    flow: Flow
    unit: Array
    steps: list[PathStep] = field(default_factory=list)
    flowing: Pairs = frozenset()

    def __post_init__(self) -> None:
        self.moved = np.zeros_like(self.unit)
        free = {block.name: k for k, block in enumerate(self.model.blocks)}
        self.places = [free[name] for name in self.flow.problem.blocks]
        self.live = self.model.live.on(self.model.free_blocks).ravel()

    def add(self, state: State, kind: str, rates: State | None = None) -> PathStep:
        """Tell a state, whose displacements count from the start of the increment."""
        problem = self.flow.problem
        moved = np.zeros((len(self.model.blocks), 6))
        moved[self.places] = ((self.moved + state.u) * self.unit).reshape(-1, 6)
        flowing = self._flowing(rates or state)
        residuals = mcp_residuals(self.flow, state)
        step = PathStep(
            load_factor=float(state.load_factor / problem.units.live),
            stress_resultants=resultants_of(problem, state.x),
            displacements=read_only(moved),
            active=tuple(sorted(flowing - self.flowing)),
            residuals={name: residuals[name] for name in ("equilibrium", "yield")},
            kind=kind,
        )
        self.steps.append(step)
        self.flowing = flowing
        return step

    def trace(self, increment: Increment, length: float) -> Array:
        """Arclength, work of the live load at load factor one, load factor of each visit, shape (k, 3)."""
        units = self.flow.problem.units
        return np.array(
            [
                (
                    length + visit.arclength,
                    self.live @ ((self.moved + visit.point.u / visit.rho) * self.unit),
                    visit.point.load_factor / units.live,
                )
                for visit in increment.visits
            ]
        )

    def _flowing(self, state: State) -> Pairs:
        """(interface, mode) of every row with a multiplier."""
        p = self.flow.problem
        speed = np.abs(state.u / p.units.loads).max()
        rows = np.flatnonzero(np.abs(state.y) * p.multiplier_units * p.units.live > FLOWING * speed)
        return frozenset((p.interfaces[p.row_interface[r]], p.row_mode[r]) for r in rows)
