"""Limit analysis of structures made of rigid blocks, with evidence for every answer."""

from importlib import import_module
from typing import Any

from limitblocks import structures, studies, units
from limitblocks.analysis.bounds import bounds
from limitblocks.analysis.diagnosis import Diagnosis, diagnose
from limitblocks.analysis.load_factor_range.run import load_factor_range
from limitblocks.analysis.nonassociated.load_path import load_path
from limitblocks.analysis.nonassociated.loop import nonassociated
from limitblocks.analysis.nonassociated.means import Means
from limitblocks.analysis.nonassociated.path_equations import Barrier
from limitblocks.analysis.nonassociated.settings import Settings
from limitblocks.analysis.stability import stability
from limitblocks.errors import (
    CheckFailed,
    GeometryError,
    LimitBlocksError,
    MissingDependency,
    ModelError,
    NoEquilibrium,
    NoSolution,
    NotConverged,
    SolveError,
    SolverFailure,
    UnlimitedLoad,
)
from limitblocks.evidence.associated import Bounds
from limitblocks.evidence.backward_error import BackwardError
from limitblocks.evidence.check import Check, check_mcp
from limitblocks.evidence.claim import Claim
from limitblocks.evidence.ending import Status
from limitblocks.evidence.interface_states import InterfaceStates, interface_states
from limitblocks.evidence.load_path_result import LoadPath, PathStep, Snap
from limitblocks.evidence.range_answer import Origin, RangeAnswer
from limitblocks.evidence.range_result import LoadFactorRange
from limitblocks.evidence.results import Iteration, Nonassociated
from limitblocks.evidence.stability_result import Stability, Standing
from limitblocks.geometry import (
    Block,
    Contacts,
    Healed,
    Interface,
    Tolerances,
    find_contacts,
    find_interfaces,
    heal,
)
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
from limitblocks.mechanics import (
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
from limitblocks.model import Model
from limitblocks.reports import Report, report, report_schema

__version__ = "0.1.0"

__all__ = [
    "BackwardError",
    "Barrier",
    "Block",
    "Bounds",
    "Check",
    "CheckFailed",
    "Claim",
    "Contacts",
    "Diagnosis",
    "ExactTorsion",
    "GeometryError",
    "Healed",
    "ImportedBlocks",
    "Interface",
    "InterfaceStates",
    "Iteration",
    "Joint",
    "LimitBlocksError",
    "Load",
    "LoadFactorRange",
    "LoadPath",
    "Means",
    "MissingDependency",
    "Model",
    "ModelError",
    "NoEquilibrium",
    "NoSolution",
    "Nonassociated",
    "NotConverged",
    "OrdunaLourenco",
    "Origin",
    "PathStep",
    "PointContact",
    "RangeAnswer",
    "Report",
    "Settings",
    "Snap",
    "SolveError",
    "SolverFailure",
    "Stability",
    "Standing",
    "Status",
    "Tilting",
    "Tolerances",
    "UnlimitedLoad",
    "YieldRows",
    "added_mass",
    "bounds",
    "check_mcp",
    "compass",
    "diagnose",
    "effective_strength",
    "fill",
    "find_contacts",
    "find_interfaces",
    "force",
    "heal",
    "interface",
    "interface_states",
    "line_load",
    "load_factor_range",
    "load_path",
    "mass_proportional",
    "model_schema",
    "moment",
    "nonassociated",
    "pressure",
    "read",
    "read_blocks",
    "read_drawing",
    "read_result",
    "report",
    "report_schema",
    "self_weight",
    "stability",
    "structures",
    "studies",
    "tilting",
    "top_force",
    "units",
    "write_animation",
    "write_blocks",
    "write_result",
    "write_vtu",
]


def __getattr__(name: str) -> Any:
    """Import `limitblocks.plots` when it is first asked for: it needs matplotlib."""
    if name == "plots":
        return import_module("limitblocks.plots")
    raise AttributeError(f"module 'limitblocks' has no attribute {name!r}")
