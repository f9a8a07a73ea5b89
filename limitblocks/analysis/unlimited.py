"""Why there is no load factor: stresses within the yield surface carry the live load alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from limitblocks.analysis.nonassociated.without_shear import load_factor_without_shear
from limitblocks.analysis.programs import ROUNDS, jamming_program, solved, solvers
from limitblocks.analysis.scales import Scaled, balanced, scaled, unmoved, unpressed
from limitblocks.arrays import Array
from limitblocks.errors import UnlimitedLoad
from limitblocks.evidence.residuals import Residuals, static_residuals
from limitblocks.problem import LimitProblem

UNLIMITED = (
    "the live load can grow without limit: a stress state within the yield surface balances it alone; check "
    "its direction, or use the non-associated analysis"
)
JAMMED = (
    "the live load can grow without limit: normal forces alone balance it, without any friction, so that the "
    "non-associated analysis has no load factor either; check its direction, and for tenons drawn tight"
)
CERTIFIED = 1e-7  # largest residual of stresses that explain why there is no answer


def explain(problem: LimitProblem, dead: Array) -> None:
    """Raise UnlimitedLoad where stresses carry the live load with a little of the dead loads.

    The stresses `dead` carry those: what the live load does not reach is judged by them, not by rounding.
    """
    pushed = replace(problem, dead=problem.live, g=np.zeros_like(problem.g))  # any multiple of the live load
    loaded = replace(pushed, dead=problem.live + CERTIFIED * problem.dead, g=CERTIFIED * problem.g)
    for solver in solvers(bool(problem.cones.second_order)):
        measured: Scaled | None = scaled(pushed)
        for _ in range(ROUNDS):
            if measured is None:
                break
            (x,) = solved(jamming_program(measured), solver).values
            if not np.isfinite(x).all():
                break
            ways = balanced(measured, measured.dead, x), unpressed(measured, measured.dead, x)
            for x in (measured.stress * way for way in ways if way is not None):
                if Residuals(static_residuals(loaded, 0.0, x + CERTIFIED * dead)).worst.value > CERTIFIED:
                    continue
                jammed = np.isinf(load_factor_without_shear(problem, limited=False)[0])
                raise UnlimitedLoad(JAMMED if jammed else UNLIMITED)
            measured = measured.measured(unmoved(problem, 0.0, measured.stress * ways[0]))
