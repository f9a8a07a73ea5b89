"""Mechanisms that prove that loads fall: they do more work on them than the joints take up."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from limitblocks.analysis.programs import answers, falling_program
from limitblocks.analysis.scales import compatible, scaled
from limitblocks.arrays import Array
from limitblocks.evidence.measure import Measure
from limitblocks.evidence.relative_rates import MOVING
from limitblocks.problem import Flow, LimitProblem, State

FALLING = 1e-6  # of the work of the weights on their blocks' lengths: surplus work below it counts as balance
LIKELY = 10.0  # times the largest load tied to an interface: more force on it is not to be expected
CERTIFIED = 1e-7  # largest residual of a mechanism that proves that a structure falls


@dataclass(frozen=True, eq=False)
class Fall:
    """A mechanism on which the loads do more work than the joints take up, in the units of its problem."""

    flow: Flow
    loads: Array
    state: State

    @property
    def blocks(self) -> tuple[str, ...]:
        """Blocks whose power is more than MOVING of the largest."""
        speed = np.linalg.norm(self.state.u.reshape(-1, 6), axis=1)  # the same in all axes
        return tuple(np.array(self.flow.problem.blocks)[speed > MOVING * speed.max()].tolist())

    @property
    def rates(self) -> Array:
        """Displacement rates, m and rad, (6 n,); the largest 1 m, rotations by half the size of the block."""
        units = self.flow.problem.units
        u = self.state.u / units.loads
        arms = np.stack([np.ones_like(units.block_length)] * 3 + [units.block_length] * 3, axis=1)
        return np.asarray(u / np.abs(u.reshape(-1, 6) * arms).max())


def falling(flow: Flow, loads: Array) -> Fall | None:
    """Return a mechanism of a flow rule that proves that the loads fall, sought in two sets of units.

    Those of the problem, and with every block measured by its own load.
    """
    if not loads.any():
        return None
    problem = flow.problem
    own = np.abs(loads).reshape(-1, 6).max(axis=1)
    light = problem.measured(np.where(own > 0.0, own, own.max()) * problem.units.block_force)
    share = light.units.loads / problem.units.loads
    for measured, acting in ((problem, loads), (light, loads / share)):
        known = replace(flow, problem=measured)
        G = known.matrix(np.zeros(measured.C.shape[0]))
        flowing = scaled(replace(measured, F=G))
        for found in answers(falling_program(flowing.problem, acting), problem.cones):
            u, y = found.values
            y = flowing.multiplier * compatible(flowing, u / flowing.rate, y / flowing.multiplier)
            strains = measured.C @ u + G.T @ y
            surplus = acting @ u - measured.g @ y - LIKELY * _worth(measured, acting, strains)
            if np.abs(strains).max() < CERTIFIED and surplus > FALLING:
                return Fall(known, acting, State(0.0, np.zeros(measured.C.shape[0]), u, y))
    return None


def _worth(problem: LimitProblem, loads: Array, strains: Array) -> float:
    """Power of forces as large as the largest load tied to an interface on strains that break the flow."""
    none = np.zeros(0)
    measure = Measure(replace(problem, dead=loads), State(0.0, np.zeros(len(strains)), none, none))
    return float(np.abs(strains) @ measure.pressed[problem.stress_interface])
