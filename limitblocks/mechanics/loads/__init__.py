"""Loads on blocks: weights, masses, forces, pressures, fill and line loads, and any sum of them."""

from limitblocks.mechanics.loads.fills import Fill, fill
from limitblocks.mechanics.loads.forces import (
    AddedMass,
    JointPressure,
    MassProportional,
    Moment,
    PointForce,
    added_mass,
    force,
    mass_proportional,
    moment,
    self_weight,
)
from limitblocks.mechanics.loads.load import Load, unit_vector
from limitblocks.mechanics.loads.pushes import Tilting, compass, tilting, turned
from limitblocks.mechanics.loads.surfaces import Pressure, pressure
from limitblocks.mechanics.loads.tops import LineLoad, TopForce, line_load, top_force

#: Every term that a model file may name.
LoadTerm = (
    MassProportional | AddedMass | PointForce | JointPressure | Moment | Pressure | Fill | TopForce | LineLoad
)

__all__ = [
    "AddedMass",
    "Fill",
    "JointPressure",
    "LineLoad",
    "Load",
    "LoadTerm",
    "MassProportional",
    "Moment",
    "PointForce",
    "Pressure",
    "Tilting",
    "TopForce",
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
    "turned",
    "unit_vector",
]
