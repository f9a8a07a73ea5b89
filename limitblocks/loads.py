"""Loads: terms to add and to multiply, as in ``lb.self_weight() + lb.loads.force("top", (0, 0, -1e3))``."""

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
    "line_load",
    "mass_proportional",
    "moment",
    "pressure",
    "self_weight",
    "tilting",
    "top_force",
]


def __dir__() -> list[str]:
    return __all__
