"""Loads, compatibility and the dimensionless limit problem."""

from limitblocks.mechanics.assembly import limit_problem
from limitblocks.mechanics.loads import Load, force, mass_proportional, moment, self_weight
from limitblocks.mechanics.problem import Cones, LimitProblem, Scales

__all__ = [
    "Cones",
    "LimitProblem",
    "Load",
    "Scales",
    "force",
    "limit_problem",
    "mass_proportional",
    "moment",
    "self_weight",
]
