"""What counts as large on a path, so that the units of the numbers do not decide how it is followed."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from limitblocks.arrays import Array
from limitblocks.problem import LimitProblem


class Measures(NamedTuple):
    """What is large on a path: stresses and strain rates (s,), slacks (R,); power is that of its barrier."""

    stress: Array
    strain: Array
    slack: Array
    power: float


def by_compliance(problem: LimitProblem, elastic: Array, power: float) -> Measures:
    """Return what paths from one elastic step measure by, on joints of compliance `elastic` (s,).

    Stresses by those that do `power` on their elastic strains, and slacks, alike in a cone, by what such
    stresses change of them: the root of F diag(stress^2) F^T on its diagonal.
    """
    F, member = problem.F, problem.cones.member
    stress = np.sqrt(power / elastic)
    squares = F.multiply(F) @ stress**2
    slack = np.sqrt(np.bincount(member, squares) / np.bincount(member))[member]
    return Measures(stress, power / stress, np.where(slack > 0.0, slack, power), power)


def by_units(problem: LimitProblem, elastic: Array, power: float) -> Measures:
    """Return the units: prestress may be large beside an increment that does `power`."""
    one = np.ones_like(elastic)
    return Measures(one, one, np.ones(len(problem.g)), power)
