"""Rows and lines that sections of several kinds of results share, and load factors side by side."""

from __future__ import annotations

from collections.abc import Iterable
from math import isfinite, isinf, isnan

from limitblocks.errors import few
from limitblocks.evidence.backward_error import BackwardError
from limitblocks.evidence.residuals import TOLERANCE
from limitblocks.evidence.results import Nonassociated
from limitblocks.reports.section import Section
from limitblocks.reports.words import at_least, at_most, figures

AS_READ = "as the file says, not computed here"
Row = tuple[str, str, str]
NOT_CLAIMED = "not claimed"
NOT_UNIQUE = (
    "The load factor without dilatancy is not unique: the equations may have other solutions, at other load "
    "factors up to the associated one, and which of them a structure reaches depends "
    "on how it was built and loaded."
)
_LEAST, _MOST = "Frictionless", "Associated"  # limits of all solutions: a row each
_ORDER = ("Non-associated", "Load path")
SHOWN = 4  # names in a cell
KNOWN = 0.2  # of friction: how well it is known, docs/how-sure.md


def limits(result: Nonassociated) -> tuple[Row, Row]:
    """Return name, value and meaning of the load factors that no solution is below and above."""
    lower, upper = result.frictionless, result.associated
    if result.from_file:
        least = NOT_CLAIMED if isnan(lower) else at_least(lower)
        return ("Frictionless", least, AS_READ), ("Associated", number(upper), AS_READ)
    return (
        ("Frictionless", NOT_CLAIMED, result.unclaimed)
        if isnan(lower)
        else ("Frictionless", at_least(lower), "joints carry no shear: no solution is lower"),
        ("Associated", at_most(upper), "joints dilate by the friction angle: no solution is higher")
        if isfinite(upper)
        else ("Associated", number(upper), "dilating joints jam under this load: nothing is known above"),
    )


def number(load_factor: float) -> str:
    """Return a load factor as text."""
    return figures(load_factor, 7) if isfinite(load_factor) else "unlimited"


def backward(error: BackwardError) -> Row:
    """Return name, value and meaning of a backward error."""
    if isinf(error.value):
        return "Backward error", "inf", "no changed model was found of which this state is exact"
    parts = ", ".join(f"{part.name} {part.value:.1e}" for part in error.parts)
    where = few([f"{name} ({change:.1e})" for name, change in error.places], SHOWN)
    said = f"exact for a model changed by as much: {parts}" + (f"; most at {where}" if where else "")
    return "Backward error", f"{error.value:.1e}", said


def far(error: BackwardError) -> tuple[str, ...]:
    """Return a warning if no model near by was found of which a state is exact."""
    said = (
        f"the residuals pass, but no model within {KNOWN:.0%} was found of which this state is exact: {error}"
    )
    return (said,) if error.value > KNOWN else ()


def loose(tolerance: float, usual: float = TOLERANCE) -> tuple[str, ...]:
    """Return a warning if a tolerance is looser than usual."""
    said = f"the tolerance {tolerance:.1e} is looser than the usual {usual:.1e}"
    return (said,) if tolerance > usual else ()


def comparison(sections: Iterable[Section]) -> tuple[Row, ...]:
    """Return name, value and meaning of each load factor; empty where there is nothing to compare.

    Every solution has a row, but those that are alike have one. Of the limits, what was computed here counts
    before what a file says.
    """
    given = tuple(dict.fromkeys(row for one in sections for row in one.compared))
    limits = {name: _limit([row for row in given if row[0] == name]) for name in (_LEAST, _MOST)}
    between = [row for row in given if row[0] not in limits]
    between.sort(key=lambda row: [not row[0].startswith(name) for name in _ORDER])
    rows = (*limits[_LEAST], *between, *limits[_MOST])
    return rows if len(rows) > 1 else ()


def _limit(rows: list[Row]) -> tuple[Row, ...]:
    """The row of a limit of all results, if there is one: not claimed where one does not claim it."""
    ranked = sorted(rows, key=lambda row: (row[1] != NOT_CLAIMED, row[2] == AS_READ))
    return tuple(ranked[:1])
