"""What the functions of limitblocks return: classes to read about and to annotate with."""

from limitblocks.analysis.diagnosis import Diagnosis
from limitblocks.evidence.associated import Bounds
from limitblocks.evidence.backward_error import BackwardError
from limitblocks.evidence.check import Check
from limitblocks.evidence.claim import Claim
from limitblocks.evidence.ending import Status
from limitblocks.evidence.interface_states import InterfaceStates
from limitblocks.evidence.load_path_result import LoadPath, PathStep, Snap
from limitblocks.evidence.proof import Proof
from limitblocks.evidence.range_answer import Origin, RangeAnswer
from limitblocks.evidence.range_result import Extreme, LoadFactorRange, Wedging
from limitblocks.evidence.residuals import Residual, Residuals
from limitblocks.evidence.results import Iteration, Nonassociated
from limitblocks.evidence.sensitivity_result import Influence, LoadPosition, Sensitivities
from limitblocks.evidence.stability_result import Stability, Standing
from limitblocks.geometry import Contacts, Healed
from limitblocks.geometry.findings import NearMiss, Overlap, Sliver, Through
from limitblocks.notebook import View
from limitblocks.problem import Mode
from limitblocks.reports import Report

__all__ = [
    "BackwardError",
    "Bounds",
    "Check",
    "Claim",
    "Contacts",
    "Diagnosis",
    "Extreme",
    "Healed",
    "Influence",
    "InterfaceStates",
    "Iteration",
    "LoadFactorRange",
    "LoadPath",
    "LoadPosition",
    "Mode",
    "NearMiss",
    "Nonassociated",
    "Origin",
    "Overlap",
    "PathStep",
    "Proof",
    "RangeAnswer",
    "Report",
    "Residual",
    "Residuals",
    "Sensitivities",
    "Sliver",
    "Snap",
    "Stability",
    "Standing",
    "Status",
    "Through",
    "View",
    "Wedging",
]


def __dir__() -> list[str]:
    return __all__
