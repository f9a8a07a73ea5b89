"""What a report says of sensitivities: the data that govern the load factor."""

from __future__ import annotations

import numpy as np

from limitblocks.arrays import Array
from limitblocks.evidence.sensitivity_result import ROUNDING, LoadPosition, Sensitivities
from limitblocks.mechanics.loads.load import triple
from limitblocks.model import Model
from limitblocks.reports.document import Part, Table
from limitblocks.reports.section import Section
from limitblocks.reports.words import at_least

MOST = 10  # data listed
MEANING = (
    "How much the associated load factor changes with the data of the model, by the derivatives at the "
    "collapse found, without solving again. They hold for small changes: a larger one may bring another "
    "mechanism. The load factor without dilatancy changes alike only as far as its mechanism is the same."
)
ONE_SIDED = "the mechanism is not unique: derivatives may hold in one direction only"


def sensitivity_section(_model: Model, found: Sensitivities) -> Section:
    """Return the section of the sensitivities of a load factor."""
    first = next(iter(found.governing(1)), None)
    agreed = found.unique and bool(found.agreed.all())
    least = ROUNDING * abs(found.load_factor)
    sides = "all stress states agree" if agreed else "some may hold in one direction only"
    return Section(
        title="Sensitivity",
        meaning=MEANING,
        headline=f"{first.elasticity:+.3g}" if first else "none",
        quantity=f"change of the load factor per unit of relative change: {first.kind} of {first.name}"
        if first
        else "no friction or unit weight changes the load factor",
        values=(
            ("Load factor", at_least(found.load_factor), "static load factor, associated flow"),
            (
                "Friction, all together",
                _sum(found.of_interfaces, least),
                "per unit of relative change",
            ),
            (
                "Unit weights, all together",
                _sum(found.of_blocks, least),
                "per unit of relative change",
            ),
            ("Derivatives by friction", "two-sided" if agreed else "in part one-sided", sides),
        ),
        warnings=(() if found.unique else (ONE_SIDED,)) + found.remarks,
        parts=_tables(found),
    )


def _tables(found: Sensitivities) -> tuple[Part, ...]:
    rows = [(one.kind, one.name, f"{one.elasticity:+.4g}") for one in found.governing(MOST)]
    heads = ("Datum", "Of", "Change of the load factor")
    caption = "Data that govern: change of the load factor per unit of relative change, the largest first"
    places = [(_load(one), one.block, triple(one.gradient.tolist())) for one in found.positions]
    tables = (
        Table.of(caption, heads, rows, right=(2,)),
        Table.of("Points of loads", ("Load", "On", "Change per m along X, Y, Z"), places),
    )
    return tuple(table for table in tables if table.rows)


def _sum(values: Array, least: float) -> str:
    return f"{values.sum():+.4g}" if np.abs(values).max(initial=0.0) > least else "0"


def _load(one: LoadPosition) -> str:
    return f"{one.load}, term {one.term + 1}"
