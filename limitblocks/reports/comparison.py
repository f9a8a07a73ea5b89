"""The load factors of one model side by side, with what each of them means."""

from __future__ import annotations

from collections.abc import Iterable

from limitblocks.reports.section import Section

NOT_CLAIMED = "not claimed"
NOT_UNIQUE = (
    "The load factor without dilatancy is not unique: the equations may have other solutions, at other load "
    "factors up to the associated one, and which of them a structure reaches depends "
    "on how it was built and loaded."
)
_FIRST, _LAST = ("Frictionless", "Non-associated", "Load path"), ("Associated",)


def comparison(sections: Iterable[Section]) -> tuple[tuple[str, str, str], ...]:
    """Return name, value and meaning of each load factor; empty where there is nothing to compare."""
    rows: dict[str, tuple[str, str, str]] = {}
    for row in (row for one in sections for row in one.compared):
        if row[1] == NOT_CLAIMED:  # a lower end of all results, or of none
            rows[row[0]] = row
        rows.setdefault(row[0], row)
    order = dict.fromkeys((*_FIRST, *(name for name in rows if name not in _LAST), *_LAST))
    return tuple(rows[name] for name in order if name in rows) if len(rows) > 1 else ()
