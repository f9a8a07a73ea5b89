"""The dimensionless limit problem and its flow rule: numbers only, below joints and models."""

from limitblocks.choices import Turning, turning_of
from limitblocks.problem.cones import Cones
from limitblocks.problem.flow import ASSOCIATED, Flow, checked_dilatancy
from limitblocks.problem.limit_problem import LimitProblem, State, Units, power_of_two, tied
from limitblocks.problem.modes import Mode

__all__ = [
    "ASSOCIATED",
    "Cones",
    "Flow",
    "LimitProblem",
    "Mode",
    "State",
    "Turning",
    "Units",
    "checked_dilatancy",
    "power_of_two",
    "tied",
    "turning_of",
]
