"""Limit analysis of structures made of rigid blocks, with evidence for every answer.

What most models need is here; the rest is in `loads`, `joints`, `structures`, `practice`, `studies`, `plots`,
`files`, `results`, `settings`, `errors` and `units`. Everything is loaded when it is first used.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from limitblocks import (
        errors,
        files,
        joints,
        loads,
        plots,
        practice,
        results,
        settings,
        structures,
        studies,
        units,
    )
    from limitblocks.analysis.bounds import bounds
    from limitblocks.analysis.diagnosis import diagnose
    from limitblocks.analysis.load_factor_range.run import load_factor_range
    from limitblocks.analysis.nonassociated.load_path import load_path
    from limitblocks.analysis.nonassociated.loop import nonassociated
    from limitblocks.analysis.sensitivities import sensitivities
    from limitblocks.analysis.stability import stability
    from limitblocks.errors import LimitBlocksError, ModelError, NotConverged, SolveError
    from limitblocks.evidence.check import check_mcp
    from limitblocks.evidence.interface_states import interface_states
    from limitblocks.geometry import Block, Interface, find_contacts, find_interfaces, heal
    from limitblocks.io import read, read_result
    from limitblocks.joints import OrdunaLourenco, PointContact
    from limitblocks.loads import mass_proportional, self_weight
    from limitblocks.model import Model
    from limitblocks.reports.report import report
    from limitblocks.studies import study

__version__ = "0.1.0"

__all__ = [
    "Block",
    "Interface",
    "LimitBlocksError",
    "Model",
    "ModelError",
    "NotConverged",
    "OrdunaLourenco",
    "PointContact",
    "SolveError",
    "bounds",
    "check_mcp",
    "diagnose",
    "errors",
    "files",
    "find_contacts",
    "find_interfaces",
    "heal",
    "interface_states",
    "joints",
    "load_factor_range",
    "load_path",
    "loads",
    "mass_proportional",
    "nonassociated",
    "plots",
    "practice",
    "read",
    "read_result",
    "report",
    "results",
    "self_weight",
    "sensitivities",
    "settings",
    "stability",
    "structures",
    "studies",
    "study",
    "units",
]

# where a name is that is no module of its own; the imports above say the same to type checkers
_HOMES = {
    "Block": "geometry",
    "Interface": "geometry",
    "LimitBlocksError": "errors",
    "Model": "model",
    "ModelError": "errors",
    "NotConverged": "errors",
    "OrdunaLourenco": "joints",
    "PointContact": "joints",
    "SolveError": "errors",
    "bounds": "analysis.bounds",
    "check_mcp": "evidence.check",
    "diagnose": "analysis.diagnosis",
    "find_contacts": "geometry",
    "find_interfaces": "geometry",
    "heal": "geometry",
    "interface_states": "evidence.interface_states",
    "load_factor_range": "analysis.load_factor_range.run",
    "load_path": "analysis.nonassociated.load_path",
    "mass_proportional": "loads",
    "nonassociated": "analysis.nonassociated.loop",
    "read": "io",
    "read_result": "io",
    "report": "reports.report",
    "self_weight": "loads",
    "sensitivities": "analysis.sensitivities",
    "stability": "analysis.stability",
    "study": "studies",
}


def __dir__() -> list[str]:
    return __all__


if not TYPE_CHECKING:  # a type checker would take it for leave to use any name

    def _elsewhere(name: str) -> str:
        """Where a name is that the parts show; plots, which a name here may be pictured by, are left out."""
        parts = () if name.startswith("_") else sorted({*__all__} - {*_HOMES, "plots"})
        homes = [part for part in parts if name in dir(import_module(f"limitblocks.{part}"))]
        return f"; it is limitblocks.{homes[0]}.{name}" if homes else ""

    def __getattr__(name: str) -> Any:
        """Import a public name when it is first asked for."""
        if name not in __all__:
            raise AttributeError(f"module 'limitblocks' has no attribute {name!r}{_elsewhere(name)}")
        if name not in _HOMES:
            return import_module(f"limitblocks.{name}")
        value = globals()[name] = getattr(import_module(f"limitblocks.{_HOMES[name]}"), name)
        return value
