"""Load paths from many admissible states of the permanent loads, and other ways to solutions."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from typing import NamedTuple

import cvxpy as cp
import numpy as np

from limitblocks.analysis.nonassociated.loading import pushed
from limitblocks.analysis.nonassociated.means import MEANS, SOFTENING, Means
from limitblocks.analysis.nonassociated.path_equations import Barrier
from limitblocks.analysis.nonassociated.path_record import UNSETTLED
from limitblocks.analysis.nonassociated.permanent import permanent_state
from limitblocks.analysis.nonassociated.settings import Settings
from limitblocks.analysis.nonassociated.tracking import track
from limitblocks.analysis.polish import polish
from limitblocks.analysis.programs import Program, in_cone, solved, solvers
from limitblocks.arrays import Array
from limitblocks.evidence.range_answer import Origin
from limitblocks.problem import Flow, State

STIFFNESS = 10.0  # most that the stiffness of a joint, and shear over normal stiffness, depart from the usual
STRESSES = (0.3, 1.0, 3.0)  # size of the random stresses over those of the permanent loads
LARGE = (Barrier(0.1, 2.0), Barrier(1.0, 2.0), Barrier(3.0, 1.0), Barrier(10.0, 2.0))
BUDGET = MEANS[0].budget
Watch = Callable[[object], None]


class Way(NamedTuple):
    """A way to a solution: what it is, where it comes from, and the state at its end."""

    how: str
    origin: Origin
    go: Callable[[], State | None]


@dataclass(frozen=True, eq=False)
class Sampler:
    """Ways of one flow rule from stresses `x0` of the permanent loads; `associated` those of the bounds.

    `scale` is the dimensionless load factor that paths are measured by; `watch` is called at every point.
    """

    flow: Flow
    x0: Array
    associated: Array | None
    scale: float
    watch: Watch

    def ways(self, seed: int) -> Iterator[Way]:
        """Yield ways without end, of five kinds in turn, each drawn anew."""
        random, k = np.random.default_rng(seed), 0
        while True:
            k += 1
            size, small = STRESSES[k % len(STRESSES)], Means(Barrier(), k, BUDGET)
            other, ratios = random.normal(size=len(self.x0)), random.uniform(-1.0, 1.0, (3, len(self.x0)))
            large = Means(LARGE[k % len(LARGE)], k, BUDGET)
            yield Way(
                f"barrier {large.barrier.size:g}, power {large.barrier.power:g}, seed {k}",
                Origin.REACHED,
                partial(self._tracked, large, self.x0),
            )
            yield Way(
                f"small barrier, seed {k}, permanent loads near random stresses {size:g}",
                Origin.REACHED,
                partial(self._tracked_from, small, size * other),
            )
            yield Way(
                f"small barrier, seed {k}, random stiffness of the joints",
                Origin.REACHED,
                partial(self._other_stiffness, small, ratios),
            )
            yield Way(
                f"increments, permanent loads near random stresses {size:g}",
                Origin.REACHED,
                partial(self._stepped, -size * other),
            )
            if self.associated is not None:
                yield Way(
                    f"small barrier, seed {k}, from the associated collapse",
                    Origin.SEARCHED,
                    partial(self._tracked, small, self.associated),
                )

    def _tracked(self, means: Means, x0: Array | None, weights: Array | None = None) -> State | None:
        if x0 is None:
            return None
        problem = self.flow.problem
        state, path = track(
            replace(self.flow, softening=SOFTENING),
            x0,
            problem.compliance if weights is None else weights,
            barrier=means.barrier,
            seed=means.seed,
            budget=means.budget,
            power=self.scale / len(problem.blocks),
            progress=self.watch,
        )
        if path.interrupted:
            raise KeyboardInterrupt
        return None if path.end == UNSETTLED else polish(self.flow, state)

    def _tracked_from(self, means: Means, random: Array) -> State | None:
        return self._tracked(means, self._permanent(random))

    def _other_stiffness(self, means: Means, ratios: Array) -> State | None:
        """A path on joints each of another stiffness, and of another stiffness in shear."""
        p = self.flow.problem
        shear = np.zeros(len(self.x0), dtype=bool)
        places = p.resultants.tocoo()
        shear[places.col[np.isin(places.row % 6, (0, 1))]] = True
        factors = ratios[0][p.stress_interface] + np.where(shear, ratios[1][0], 0.0)
        weights = p.compliance * STIFFNESS**factors
        return self._tracked(means, permanent_state(self.flow, weights), weights)

    def _stepped(self, random: Array) -> State | None:
        x0 = self._permanent(random)
        if x0 is None:
            return None
        p = self.flow.problem
        return pushed(self.flow, x0, p.compliance, 1e-8, Settings(), self.scale, self.watch)[1]

    def _permanent(self, random: Array) -> Array | None:
        """The admissible stresses under the permanent loads that are nearest to x0 and random ones."""
        p = self.flow.problem
        root = np.sqrt(p.compliance)
        size = float(np.linalg.norm(root * self.x0) / np.sqrt(len(self.x0)))
        x = cp.Variable(len(self.x0))
        distance = cp.sum_squares(cp.multiply(root, x) - (root * self.x0 + size * random))
        constraints = [p.C.T @ x == p.dead, *in_cone(p.F @ x + p.g, p.cones)]
        (stresses,) = solved(
            Program(cp.Problem(cp.Minimize(distance), constraints), (x,)), solvers(conic=True)[1]
        ).values
        return stresses if np.isfinite(stresses).all() else None
