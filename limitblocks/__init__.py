"""Limit analysis of structures made of rigid blocks, with evidence for every answer."""

from limitblocks.analysis.bounds import Bounds, bounds
from limitblocks.errors import (
    CheckFailed,
    GeometryError,
    LimitBlocksError,
    MissingDependency,
    ModelError,
    NoEquilibrium,
    NotConverged,
    SolveError,
    SolverFailure,
    UnlimitedLoad,
)
from limitblocks.geometry import Block, Interface, find_interfaces
from limitblocks.joints import Joint, OrdunaLourenco, PointContact, YieldRows
from limitblocks.mechanics import Load, force, mass_proportional, moment, self_weight
from limitblocks.model import Model

__version__ = "0.1.0"

__all__ = [
    "Block",
    "Bounds",
    "CheckFailed",
    "GeometryError",
    "Interface",
    "Joint",
    "LimitBlocksError",
    "Load",
    "MissingDependency",
    "Model",
    "ModelError",
    "NoEquilibrium",
    "NotConverged",
    "OrdunaLourenco",
    "PointContact",
    "SolveError",
    "SolverFailure",
    "UnlimitedLoad",
    "YieldRows",
    "bounds",
    "find_interfaces",
    "force",
    "mass_proportional",
    "moment",
    "self_weight",
]
