"""The section of a result, as the registry of results says how it is made."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from limitblocks.errors import LimitBlocksError
from limitblocks.evidence.claim import Claim
from limitblocks.kinds import KINDS, kind_of, named
from limitblocks.model import Model, refuse_other
from limitblocks.reports.as_read import as_read
from limitblocks.reports.section import Section


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
    return as_read(made, result)


def drawn(results: Iterable[Any], sections: Iterable[Section]) -> Section | None:
    """The section whose mechanism is drawn: the first of its kind would do, one says enough."""
    kinds = {kind_of(result): made for result, made in zip(results, sections, strict=True)}
    return next(
        (made for kind in KINDS.values() if (made := kinds.get(kind)) and made.rates is not None), None
    )


def shown(result: Any) -> bool:
    """Whether reports know this kind of result; a claim they check first."""
    return kind_of(result) is not None or isinstance(result, Claim)
