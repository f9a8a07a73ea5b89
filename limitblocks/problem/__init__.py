"""The dimensionless limit problem and its flow rule: numbers only, below joints and models."""

from limitblocks.problem.limit_problem import Cones, LimitProblem, Scales

__all__ = ["Cones", "LimitProblem", "Scales"]
