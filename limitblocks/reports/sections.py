"""The section of a result, as the registry of results says how it is made."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

from limitblocks.errors import LimitBlocksError
from limitblocks.evidence.claim import Claim
from limitblocks.kinds import KINDS, kind_of, named
from limitblocks.model import Model, refuse_other
from limitblocks.reports.rows import AS_READ
from limitblocks.reports.section import Section

CHECKED = (
    "read from a file: load factor, stresses, mechanism and the equilibrium of steps were checked here anew; "
    "limits, ways and what else is named beside them are what the file says"
)
NOT_JUDGED = (
    "read from a file, which does not hold what it takes to check it: all of it is what the file says"
)


def section(model: Model, result: Any) -> Section:
    """Return what a report says of `result`.

    Raises
    ------
    LimitBlocksError
        The result is of a kind unknown to reports, or belongs to another model.
    """
    kind = kind_of(result)
    if kind is None:
        known = ", ".join(sorted(one.name for word, one in KINDS.items() if word != "claim"))
        raise LimitBlocksError(f"a report cannot show {type(result).__name__}; expected a result: {known}")
    refuse_other(model, result)
    made: Section = named(kind.section)(model, result)
    return _as_read(made, result)


def _as_read(made: Section, result: Any) -> Section:
    """The section of a result; where that was read it says what was checked here, if anything."""
    if not getattr(result, "from_file", False):
        return made
    kind = kind_of(result)
    if kind and kind.judge:
        return replace(made, warnings=(CHECKED, *made.warnings))
    title, headline = f"{made.title}, as a file says", "not checked"
    values = (("Answer of the file", made.headline, AS_READ), *made.values)
    said: Any = {"values": values, "warnings": (NOT_JUDGED, *made.warnings)}
    unproven: Any = {"judged": None, "rates": None, "designs": (), "upper": None, "compared": ()}
    return replace(made, title=title, headline=headline, **said, **unproven)


def drawn(results: Iterable[Any], sections: Iterable[Section]) -> Section | None:
    """The section whose mechanism is drawn: the first of its kind would do, one says enough."""
    kinds = {kind_of(result): made for result, made in zip(results, sections, strict=True)}
    return next(
        (made for kind in KINDS.values() if (made := kinds.get(kind)) and made.rates is not None), None
    )


def shown(result: Any) -> bool:
    """Whether reports know this kind of result; a claim they check first."""
    return kind_of(result) is not None or isinstance(result, Claim)
