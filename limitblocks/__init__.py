"""Limit analysis of structures made of rigid blocks, with evidence for every answer."""

from limitblocks import structures
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
from limitblocks.io import model_schema, read, read_result, write_result
from limitblocks.joints import (
    ExactTorsion,
    Joint,
    OrdunaLourenco,
    PointContact,
    YieldRows,
    effective_strength,
    interface,
)
from limitblocks.mechanics import Load, force, mass_proportional, moment, self_weight
from limitblocks.model import Model
from limitblocks.report import Report, report

__version__ = "0.1.0"

__all__ = [
    "Block",
    "Bounds",
    "CheckFailed",
    "ExactTorsion",
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
    "Report",
    "SolveError",
    "SolverFailure",
    "UnlimitedLoad",
    "YieldRows",
    "bounds",
    "effective_strength",
    "find_interfaces",
    "force",
    "interface",
    "mass_proportional",
    "model_schema",
    "moment",
    "read",
    "read_result",
    "report",
    "self_weight",
    "structures",
    "write_result",
]
