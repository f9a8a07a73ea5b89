"""The load factors of one model side by side, with what each of them means."""

from __future__ import annotations

from collections.abc import Iterable
from math import isnan
from typing import Any

from limitblocks.evidence.associated import Bounds
from limitblocks.evidence.load_path_result import LoadPath
from limitblocks.evidence.results import Nonassociated
from limitblocks.reports.sections import limits

NOT_UNIQUE = (
    "The load factor without dilatancy is not unique: the equations may have other solutions, at other load "
    "factors up to the associated one, and which of them a structure reaches depends "
    "on how it was built and loaded."
)
_ASSOCIATED = "joints dilate by the friction angle: no solution is higher"
_NONASSOCIATED = "joints follow the flow rule stated: a collapse that can happen, not the only one"
_PATH = "the collapse that the live load reaches as it grows from nothing; other histories may reach others"
_ORDER = ("Frictionless", "Non-associated", "Load path", "Associated")


def comparison(results: Iterable[Any]) -> tuple[tuple[str, str, str], ...]:
    """Return name, value and meaning of each load factor; empty where there is nothing to compare."""
    rows_by_name: dict[str, tuple[str, str, str]] = {}
    for result in results:
        rows: tuple[tuple[str, str, str], ...]
        if isinstance(result, Nonassociated | LoadPath):
            end = result.collapse if isinstance(result, LoadPath) else result
            name, meaning = ("Non-associated", _NONASSOCIATED) if end is result else ("Load path", _PATH)
            unproven = "" if end.converged else "; not converged, so not proven"
            if isnan(end.frictionless):  # a lower end of all results, or of none
                rows_by_name.pop("Frictionless", None)
            rows = (*limits(end), (name, f"{end.load_factor:#.7g}", meaning + unproven))
        elif isinstance(result, Bounds):
            rows = (("Associated", f"{result.lower:#.7g}", _ASSOCIATED),)
        else:
            continue
        rows_by_name = {row[0]: row for row in rows} | rows_by_name
    return (
        tuple(rows_by_name[name] for name in _ORDER if name in rows_by_name) if len(rows_by_name) > 1 else ()
    )
