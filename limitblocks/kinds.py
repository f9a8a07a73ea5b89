"""The registry of results: for each kind what files, reports, notebooks and the terminal do with it.

A new analysis is a module with its result class, a :class:`limitblocks.shown.Result`, and an entry here.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from typing import Any


@dataclass(frozen=True)
class Kind:
    """One kind of result. What it names, "module:name", is imported when it is needed and not before.

    Attributes
    ----------
    home : str
        Its class, whose `to_dict()` has the word of the kind under "analysis".
    section : str
        ``section(model, result)``: what reports, notebooks and the terminal show of it. The plain one shows
        what `to_dict()`, `rows()` and `residuals` say.
    read : str
        ``read(cls, data)``: makes it of what `to_dict()` wrote; by default each field from its own key.
    judge : str
        ``judge(model, result)``: what was read as it is judged anew. Empty: what was read proves nothing.
    document : str
        Document of a file that claims a solution, by hand or of another program; empty where it claims none.
    """

    home: str
    section: str = "limitblocks.reports.plain_section:plain_section"
    read: str = "limitblocks.io.saved:made"
    judge: str = ""
    document: str = ""

    @property
    def name(self) -> str:
        """Name of the class."""
        return self.home.rpartition(":")[2]


_EVIDENCE, _PRACTICE = "limitblocks.evidence", "limitblocks.practice"
_REPORTS, _DOCUMENTS = "limitblocks.reports", "limitblocks.io.result_documents"

#: By the word under "analysis", in the order in which one is chosen to be drawn.
KINDS: dict[str, Kind] = {
    "nonassociated": Kind(
        home=f"{_EVIDENCE}.results:Nonassociated",
        section=f"{_REPORTS}.solution_sections:nonassociated_section",
        judge=f"{_REPORTS}.claims:judged_nonassociated",
        document=f"{_DOCUMENTS}:ResultDocument",
    ),
    "path": Kind(
        home=f"{_EVIDENCE}.load_path_result:LoadPath",
        section=f"{_REPORTS}.solution_sections:path_section",
        read="limitblocks.io.saved:path_of",
        judge=f"{_REPORTS}.claims:judged_path",
        document=f"{_DOCUMENTS}:PathDocument",
    ),
    "range": Kind(
        home=f"{_EVIDENCE}.range_result:LoadFactorRange",
        section=f"{_REPORTS}.range_section:range_section",
        read="limitblocks.io.saved:range_of",
        judge=f"{_REPORTS}.claims:judged_range",
    ),
    "claim": Kind(
        home=f"{_REPORTS}.claims:CheckedClaim",
        section=f"{_REPORTS}.check_sections:claim_section",
    ),
    "bounds": Kind(
        home=f"{_EVIDENCE}.associated:Bounds",
        section=f"{_REPORTS}.solution_sections:bounds_section",
        read="limitblocks.io.saved:bounds_of",
        judge=f"{_REPORTS}.claims:judged_bounds",
        document=f"{_DOCUMENTS}:BoundsDocument",
    ),
    "stability": Kind(
        home=f"{_EVIDENCE}.stability_result:Stability",
        section=f"{_REPORTS}.check_sections:stability_section",
    ),
    "check": Kind(
        home=f"{_EVIDENCE}.check:Check",
        section=f"{_REPORTS}.check_sections:check_section",
    ),
    "sensitivities": Kind(
        home=f"{_EVIDENCE}.sensitivity_result:Sensitivities",
        section=f"{_REPORTS}.sensitivity_section:sensitivity_section",
    ),
    "capacity curve": Kind(
        home=f"{_PRACTICE}.capacity_result:CapacityCurve",
        section=f"{_REPORTS}.curve_sections:capacity_section",
    ),
    "verification": Kind(
        home=f"{_PRACTICE}.verification_result:Verification",
        section=f"{_REPORTS}.verification_section:verification_section",
    ),
    "adequacy": Kind(
        home=f"{_PRACTICE}.adequacy_result:Adequacy",
        section=f"{_REPORTS}.adequacy_section:adequacy_section",
    ),
    "settlement": Kind(
        home=f"{_PRACTICE}.settlement:Settlement",
        section=f"{_REPORTS}.practice_sections:settlement_section",
    ),
    "settlement until collapse": Kind(
        home=f"{_PRACTICE}.collapse_result:SettlementCurve",
        section=f"{_REPORTS}.curve_sections:collapse_section",
    ),
    "repair": Kind(
        home=f"{_PRACTICE}.repair:Repair",
        section=f"{_REPORTS}.practice_sections:repair_section",
    ),
    "worst position": Kind(
        home=f"{_PRACTICE}.worst_position:WorstPosition",
        section=f"{_REPORTS}.practice_sections:vehicle_section",
    ),
}


def kind_of(result: Any) -> Kind | None:
    """Return the kind of a result; None of anything else."""
    home = f"{type(result).__module__}:{type(result).__qualname__}"
    return next((kind for kind in KINDS.values() if kind.home == home), None)


def named(home: str) -> Any:
    """Return what is named "module:name"."""
    module, _, name = home.partition(":")
    return getattr(import_module(module), name)
