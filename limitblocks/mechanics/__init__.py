"""Loads, compatibility and the dimensionless limit problem; functions of loads are in `loads`."""

from limitblocks.mechanics.assembly import limit_problem
from limitblocks.mechanics.loads import Load

__all__ = ["Load", "limit_problem"]
