"""Loads, compatibility and the dimensionless limit problem."""

from limitblocks.mechanics.assembly import limit_problem
from limitblocks.mechanics.loads import (
    Load,
    Tilting,
    added_mass,
    compass,
    fill,
    force,
    line_load,
    mass_proportional,
    moment,
    pressure,
    self_weight,
    tilting,
    top_force,
)

__all__ = [
    "Load",
    "Tilting",
    "added_mass",
    "compass",
    "fill",
    "force",
    "limit_problem",
    "line_load",
    "mass_proportional",
    "moment",
    "pressure",
    "self_weight",
    "tilting",
    "top_force",
]
