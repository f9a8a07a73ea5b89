"""The dimensionless limit problem and its flow rule: numbers only, below joints and models."""

from limitblocks.choices import Turning, turning_of
from limitblocks.problem.cones import Cones
from limitblocks.problem.flow import ASSOCIATED, Flow, checked_dilatancy
from limitblocks.problem.limit_problem import LimitProblem, State, Units, in_units, parts_of, power_of_two
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
    "in_units",
    "parts_of",
    "power_of_two",
    "turning_of",
]
