"""The load factors of one model side by side, with what each of them means."""

from __future__ import annotations

from collections.abc import Iterable

from limitblocks.reports.as_read import AS_READ
from limitblocks.reports.section import Section

Row = tuple[str, str, str]
NOT_CLAIMED = "not claimed"
NOT_UNIQUE = (
    "The load factor without dilatancy is not unique: the equations may have other solutions, at other load "
    "factors up to the associated one, and which of them a structure reaches depends "
    "on how it was built and loaded."
)
_LEAST, _MOST = "Frictionless", "Associated"  # limits of all solutions: a row each
_ORDER = ("Non-associated", "Load path")


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
