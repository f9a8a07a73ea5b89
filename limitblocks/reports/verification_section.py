"""What a report says of a kinematic verification: every mass, every quantity and every check."""

from __future__ import annotations

import re

from limitblocks.model import Model
from limitblocks.practice.verification_result import CLAIMED, Verification
from limitblocks.reports.document import Table, Text
from limitblocks.reports.section import Section
from limitblocks.reports.words import rounded_down, some, with_unit

GREEK = {"alpha": "α", "gamma": "γ", "delta": "δ", "zeta": "ζ", "xi": "ξ", "pi": "π", "psi": "ψ", "sum": "Σ"}
CODE = "Circolare 7/2019, C8.7.1.2.1"


def verification_section(_model: Model, found: Verification) -> Section:
    """Return the section of a kinematic verification."""
    worst = min(found.checks, key=lambda one: one.ratio)
    quantities = [
        (_typeset(one.symbol), one.meaning, _typeset(one.formula), with_unit(one.value, one.unit), one.source)
        for one in found.quantities
    ]
    checks = [
        (one.name, with_unit(one.capacity, one.unit), with_unit(one.demand, one.unit),
         rounded_down(one.ratio), _word(one.satisfied), one.source)
        for one in found.checks
    ]  # fmt: skip
    heads = ("Symbol", "Quantity", "Formula", "Value", "Equation or section")
    return Section(
        title="Kinematic verification of the mechanism",
        meaning=(
            f"A local mechanism as a motion of rigid bodies, {CODE} with NTC 2018; numbers of equations in "
            f"brackets are those of the Circolare. {CLAIMED}"
        ),
        headline=rounded_down(worst.ratio),
        quantity=f"least ratio of capacity to demand: {worst.name}, {_word(worst.satisfied)}",
        values=(),
        checks=(),
        tolerance=0.0,
        warnings=found.remarks,
        parts=(
            _masses(found),
            Table.of("Quantities, in the order in which they are found", heads, quantities, right=(3,)),
            Table.of(
                f"Checks, {CODE}: satisfied where capacity over demand is at least one",
                ("Check", "Capacity", "Demand", "Ratio", "Result", "Section"),
                checks,
                right=(1, 2, 3),
            ),
            Text(f"Blocks of the mechanism: {some(list(found.moving))}."),
        ),
    )


def _masses(found: Verification) -> Table:
    """The weights and virtual displacements that the sums are of."""
    rows = [
        (one.name, f"{one.weight / 1e3:.6g}", f"{one.horizontal:.6f}", f"{one.vertical:.6f}",
         f"{one.weight * one.horizontal / 1e3:.6g}", f"{one.weight * one.horizontal**2 / 1e3:.6g}")
        for one in found.masses
    ]  # fmt: skip
    heads = ("Mass", "P + Q, kN", "δ_PQx", "δ_Py", "(P + Q) dx, kN", "(P + Q) dx², kN")
    said = "Weights and virtual displacements, the largest horizontal one 1 [C8.7.1.1]"
    return Table.of(said, heads, rows, right=(1, 2, 3, 4))  # the last one takes the rest of the line


def _typeset(formula: str) -> str:
    """A formula with Greek letters and raised squares."""
    for word, letter in GREEK.items():
        formula = re.sub(rf"\b{word}(?![a-z])", letter, formula)
    return formula.replace("^2", "²")


def _word(satisfied: bool) -> str:
    return "satisfied" if satisfied else "NOT satisfied"
