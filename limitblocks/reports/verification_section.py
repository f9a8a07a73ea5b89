"""What a report says of a kinematic verification: every quantity and every check."""

from __future__ import annotations

from limitblocks.model import Model
from limitblocks.practice.verification_result import UNSEEN, Verification
from limitblocks.reports.document import Table, Text
from limitblocks.reports.section import Section
from limitblocks.reports.words import rounded_down, some, with_unit


def verification_section(_model: Model, found: Verification) -> Section:
    """Return the section of a kinematic verification."""
    worst = min(found.checks, key=lambda one: one.ratio)
    quantities = [
        (one.symbol, one.meaning, one.formula, with_unit(one.value, one.unit), one.source)
        for one in found.quantities
    ]
    checks = [
        (one.name, with_unit(one.capacity, one.unit), with_unit(one.demand, one.unit),
         rounded_down(one.ratio), _word(one.satisfied))
        for one in found.checks
    ]  # fmt: skip
    sources = ", ".join(dict.fromkeys(one.source for one in found.checks))
    heads = ("Symbol", "Quantity", "Formula", "Value", "Source")
    return Section(
        title="Kinematic verification of the mechanism",
        meaning=f"A local mechanism as a rigid-body motion, {sources} with NTC 2018. {UNSEEN}",
        headline=rounded_down(worst.ratio),
        quantity=f"least ratio of capacity to demand: {worst.name}, {_word(worst.satisfied)}",
        values=(),
        checks=(),
        tolerance=0.0,
        parts=(
            Table.of("Quantities, in the order in which they are found", heads, quantities, right=(3,)),
            Table.of(
                f"Checks, {sources}: satisfied where capacity over demand is at least one",
                ("Check", "Capacity", "Demand", "Ratio", "Result"),
                checks,
                right=(1, 2, 3),
            ),
            Text(f"Blocks of the mechanism: {some(list(found.moving))}."),
        ),
    )


def _word(satisfied: bool) -> str:
    return "satisfied" if satisfied else "NOT satisfied"
