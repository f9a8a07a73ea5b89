"""What the functions of limitblocks return: classes to read about and to annotate with."""

from limitblocks.analysis.diagnosis import Diagnosis
from limitblocks.evidence.associated import Bounds
from limitblocks.evidence.backward_error import BackwardError
from limitblocks.evidence.check import Check
from limitblocks.evidence.claim import Claim
from limitblocks.evidence.ending import Status
from limitblocks.evidence.interface_states import InterfaceStates
from limitblocks.evidence.load_path_result import LoadPath, PathStep, Snap
from limitblocks.evidence.range_answer import Origin, RangeAnswer
from limitblocks.evidence.range_result import LoadFactorRange
from limitblocks.evidence.results import Iteration, Nonassociated
from limitblocks.evidence.sensitivity_result import Influence, LoadPosition, Sensitivities
from limitblocks.evidence.stability_result import Stability, Standing
from limitblocks.geometry import Contacts, Healed
from limitblocks.notebook import View
from limitblocks.reports import Report

__all__ = [
    "BackwardError",
    "Bounds",
    "Check",
    "Claim",
    "Contacts",
    "Diagnosis",
    "Healed",
    "Influence",
    "InterfaceStates",
    "Iteration",
    "LoadFactorRange",
    "LoadPath",
    "LoadPosition",
    "Nonassociated",
    "Origin",
    "PathStep",
    "RangeAnswer",
    "Report",
    "Sensitivities",
    "Snap",
    "Stability",
    "Standing",
    "Status",
    "View",
]


def __dir__() -> list[str]:
    return __all__
