"""Limit analysis of structures made of rigid blocks, with evidence for every answer."""

from importlib import import_module
from typing import Any

from limitblocks import structures
from limitblocks.analysis.bounds import Bounds, bounds
from limitblocks.analysis.interface_states import InterfaceStates, interface_states
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
from limitblocks.report import Report, report, report_schema

__version__ = "0.1.0"

__all__ = [
    "Block",
    "Bounds",
    "Check",
    "CheckFailed",
    "Claim",
    "ExactTorsion",
    "GeometryError",
    "Interface",
    "InterfaceStates",
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
    "effective_strength",
    "find_interfaces",
    "force",
    "interface",
    "interface_states",
    "load_path",
    "mass_proportional",
    "model_schema",
    "moment",
    "nonassociated",
    "read",
    "read_result",
    "report",
    "report_schema",
    "self_weight",
    "structures",
    "write_result",
]


def __getattr__(name: str) -> Any:
    """Import `limitblocks.plots` when it is first asked for: it needs matplotlib."""
    if name == "plots":
        return import_module("limitblocks.plots")
    raise AttributeError(f"module 'limitblocks' has no attribute {name!r}")
