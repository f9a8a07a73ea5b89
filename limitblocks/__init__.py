"""Limit analysis of structures made of rigid blocks, with evidence for every answer."""

from limitblocks import structures
from limitblocks.analysis.bounds import Bounds, bounds
from limitblocks.analysis.diagnosis import Diagnosis, diagnose
from limitblocks.analysis.load_path import load_path
from limitblocks.analysis.loading import Settings
from limitblocks.analysis.mcp import Check, Claim, check_mcp
from limitblocks.analysis.nonassociated import nonassociated
from limitblocks.analysis.results import Iteration, LoadPath, Nonassociated, PathStep, Status
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
from limitblocks.geometry import Block, Contacts, Interface, find_contacts, find_interfaces
from limitblocks.io import (
    ImportedBlocks,
    model_schema,
    read,
    read_blocks,
    read_drawing,
    read_result,
    write_animation,
    write_blocks,
    write_result,
    write_vtu,
)
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
    "Check",
    "CheckFailed",
    "Claim",
    "Contacts",
    "Diagnosis",
    "ExactTorsion",
    "GeometryError",
    "ImportedBlocks",
    "Interface",
    "Iteration",
    "Joint",
    "LimitBlocksError",
    "Load",
    "LoadPath",
    "MissingDependency",
    "Model",
    "ModelError",
    "NoEquilibrium",
    "Nonassociated",
    "NotConverged",
    "OrdunaLourenco",
    "PathStep",
    "PointContact",
    "Report",
    "Settings",
    "SolveError",
    "SolverFailure",
    "Status",
    "UnlimitedLoad",
    "YieldRows",
    "bounds",
    "check_mcp",
    "diagnose",
    "effective_strength",
    "find_contacts",
    "find_interfaces",
    "force",
    "interface",
    "load_path",
    "mass_proportional",
    "model_schema",
    "moment",
    "nonassociated",
    "read",
    "read_blocks",
    "read_drawing",
    "read_result",
    "report",
    "self_weight",
    "structures",
    "write_animation",
    "write_blocks",
    "write_result",
    "write_vtu",
]
