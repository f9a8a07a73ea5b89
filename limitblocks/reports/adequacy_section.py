"""What a report says of a load factor with partial factors: each value, its factor, its design value."""

from __future__ import annotations

from limitblocks.model import Model
from limitblocks.practice import Adequacy
from limitblocks.reports.document import Table
from limitblocks.reports.section import Section
from limitblocks.reports.words import at_least, at_most, figures, with_unit
from limitblocks.shown import rounded_down

FACTORED = (
    "Load factor of the structure with design values: gamma_G multiplies the dead loads, gamma_Q the live "
    "loads, gamma_M divides strengths and cohesion of the joints, gamma_phi (gamma_M where it is not given) "
    "their friction coefficient, gamma_S the strength of ties, dowels and passive fill (EN 1990, Eqs (6.1), "
    "(6.3); EN 1997-1, Table A.4, for friction). An adequacy factor of one is E_d = R_d, Eq. (6.8), for the "
    "loads and factors given; which factors a code asks for is not judged here. Where dead loads help, the "
    "answer with a gamma_G of 1 or less counts as well."
)


def adequacy_section(_model: Model, found: Adequacy) -> Section:
    """Return the section of a load factor with partial factors."""
    end = found.answer
    real = [
        (word, figures(one.load_factor, 7), of)
        for word, one, of in (
            ("Characteristic, without dilatancy", found.characteristic_result, "as given"),
            ("Without dilatancy", found.result, "of the design model"),
        )
        if one
    ]
    rows = [
        (one.symbol, one.where, with_unit(one.characteristic, one.unit), one.factor,
         f"{found.factors.value(one.factor):.6g}", with_unit(one.design, one.unit))
        for one in found.values
    ]  # fmt: skip
    heads = ("Symbol", "Of", "Characteristic", "Partial factor", "Its value", "Design")
    return Section(
        title="Adequacy with partial factors",
        own=True,
        judges=True,
        meaning=FACTORED,
        headline=rounded_down(found.factor),
        quantity=f"adequacy factor, {'at least one' if found.satisfied else 'LESS than one'}",
        values=(
            *_associated(found),
            *real,
        ),
        judged=(end.residuals, end.tolerance),
        warnings=found.remarks,
        parts=(Table.of("Characteristic and design values", heads, rows, right=(2, 4, 5)),),
    )


def _associated(found: Adequacy) -> list[tuple[str, str, str]]:
    """Load factors of associated flow, each with what it is of."""
    given, design, of = found.characteristic, found.bounds, "associated, of the design model"
    word = at_least(given.lower) if given else "without limit"
    rows = [("Characteristic load factor", word, "associated, as given")]
    if design is None:
        return [*rows, ("Design load factor", "without limit", of)]
    rows += [("Design load factor, static", at_least(design.lower), of)]
    return [*rows, ("Design load factor, kinematic", at_most(design.upper), of)]
