"""What a report says of a kinematic verification: every check, every quantity and every mass."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

import numpy as np

from limitblocks.errors import few
from limitblocks.model import Model
from limitblocks.practice.verification_result import CLAIMED, STEPS, Inequality, Quantity, Verification
from limitblocks.reports.document import Table, Text
from limitblocks.reports.section import Section
from limitblocks.shown import rounded_down

GREEK = {"alpha": "α", "gamma": "γ", "delta": "δ", "zeta": "ζ", "xi": "ξ", "pi": "π", "psi": "ψ", "sum": "Σ"}
CODE = "Circolare 7/2019, C8.7.1.2.1"
LARGER = {"N": "kN", "kg": "t"}  # what an engineer reads
DIGITS = 4  # of what is shown; the result file has all
#: Captions of the steps: what is done, and the title that the text gives it.
CAPTIONS = {
    "activation": "Activation of the mechanism (moltiplicatore di attivazione e oscillatore equivalente, "
    "C8.7.1.2.1.3)",
    "demand": "Seismic action (azione sismica, NTC 2018 3.2)",
    "linear": "Linear check at SLV (verifica semplificata dello SLV con fattore di comportamento q, analisi "
    "cinematica lineare, C8.7.1.2.1.7)",
    "SLV": "Non-linear check at SLV (verifica in spostamento allo SLV, analisi cinematica non lineare, "
    "C8.7.1.2.1.8)",
    "SLC": "Non-linear check at SLC (verifica in spostamento allo SLC, analisi cinematica non lineare, "
    "C8.7.1.2.1.8)",
}
#: Words of the text for its symbols, those of a limit state without its name.
ITALIAN = {
    "alpha0": "moltiplicatore che attiva il meccanismo",
    "e*": "frazione di massa partecipante",
    "M*": "massa partecipante",
    "FC": "fattore di confidenza",
    "a0*": "accelerazione spettrale di attivazione",
    "a_g": "accelerazione di riferimento al suolo",
    "S": "categoria di sottosuolo e condizioni topografiche",
    "F0": "amplificazione spettrale massima",
    "T_C": "inizio del tratto a velocità costante",
    "T_D": "inizio del tratto a spostamento costante",
    "T_0": "periodo caratteristico iniziale",
    "q": "fattore di comportamento",
    "a_g,SLD": "accelerazione al suolo allo SLD",
    "a_g,SLV": "accelerazione al suolo allo SLV",
    "zeta_E": "azione sopportabile su azione di progetto",
    "d0*": "spostamento per cui si annulla l'accelerazione",
    "d*": "spostamento ultimo",
    "T": "periodo secante",
    "xi": "smorzamento viscoso equivalente",
    "S_De": "domanda di spostamento",
    "a_Z": "accelerazione massima alla quota z",
}


def verification_section(_model: Model, found: Verification) -> Section:
    """Return the section of a kinematic verification."""
    worst = min(found.checks, key=lambda one: one.ratio)
    return Section(
        title="Kinematic verification of the mechanism",
        meaning=(
            f"A local mechanism as a motion of rigid bodies, {CODE} with NTC 2018; numbers of equations in "
            f"brackets are those of the Circolare. {CLAIMED}"
        ),
        headline="not complete" if found.left_out else rounded_down(worst.ratio),
        quantity=_quantity(found, worst),
        values=(),
        judges=True,
        warnings=found.remarks,
        parts=(
            _checks(found),
            *_steps(found.quantities),
            Text(f"Blocks of the mechanism: {few(found.moving)}."),
            _masses(found),
        ),
    )


def _quantity(found: Verification, worst: Inequality) -> str:
    """What the headline is, or what was not done for there to be one."""
    said = f"least ratio of capacity to demand: {worst.name}, {_word(worst.satisfied)}"
    if not found.left_out:
        return said
    return f"verification: {found.left_out}; of the checks made {rounded_down(worst.ratio)} is the {said}"


def _checks(found: Verification) -> Table:
    rows = [
        (one.name, _shown(one.capacity, one.unit), _shown(one.demand, one.unit), rounded_down(one.ratio),
         _word(one.satisfied), one.source)
        for one in found.checks
    ]  # fmt: skip
    rows += [("non-linear", "", "", "", "NOT made", "C8.7.1.2.1.8")] if found.left_out else []
    said = f"Checks, {CODE}: satisfied where capacity over demand is at least one"
    return Table.of(
        said, ("Check", "Capacity", "Demand", "Ratio", "Result", "Section"), rows, right=(1, 2, 3)
    )


def _steps(found: Sequence[Quantity]) -> Iterator[Table]:
    """A table a step, its quantities in the order in which they are found."""
    heads = ("Symbol", "Quantity", "Formula", "Value", "Equation or section")
    for step in STEPS:
        rows = [
            (_typeset(one.symbol), one.meaning + _italian(one.symbol), _typeset(one.formula),
             _shown(one.value, one.unit), one.source)
            for one in found if one.step == step
        ]  # fmt: skip
        if rows:
            yield Table.of(CAPTIONS[step], heads, rows, right=(3,))


def _masses(found: Verification) -> Table:
    """The weights and virtual displacements that the sums are of."""
    P, x, y = np.array([(one.weight / 1e3, one.horizontal, one.vertical) for one in found.masses]).T
    shares = [[f"{value:.{DIGITS}f}" for value in values] + [""] for values in (x, y)]
    weights, *moments = (_column(values) for values in (P, P * x, P * x**2))
    names = [*(one.name for one in found.masses), "Sum"]
    rows = list(zip(names, weights, *shares, *moments, strict=True))
    heads = ("Mass", "P + Q, kN", "δ_PQx", "δ_Py", "(P + Q) δ_PQx, kN", "(P + Q) δ_PQx², kN")
    said = "Weights and virtual displacements, the largest horizontal one 1 [C8.7.1.1]"
    return Table.of(said, heads, rows, right=(1, 2, 3, 4, 5))


def _column(values: np.ndarray) -> list[str]:
    """Numbers and their sum, with as many decimals as the largest of them needs for its digits."""
    largest = float(np.abs(values).max())
    decimals = max(DIGITS - 1 - int(np.floor(np.log10(largest))), 0) if largest else 0
    return [f"{value:.{decimals}f}" for value in (*values, values.sum())]


def _shown(value: float, unit: str) -> str:
    """A number with its unit, forces in kN and masses in t."""
    if unit in LARGER:
        value, unit = value / 1e3, LARGER[unit]
    return f"{value:.{DIGITS}g} {unit.replace('s2', 's²')}".strip()


def _italian(symbol: str) -> str:
    """The word of the text for a symbol, in brackets; nothing where it has none."""
    word = ITALIAN.get(re.sub(r"_(SLD|SLV|SLC)(,c)?$", "", symbol), "")
    return f" ({word})" if word else ""


def _typeset(formula: str) -> str:
    """A formula with Greek letters and raised squares."""
    for word, letter in GREEK.items():
        formula = re.sub(rf"\b{word}(?![a-z])", letter, formula)
    return formula.replace("^2", "²")


def _word(satisfied: bool) -> str:
    return "satisfied" if satisfied else "NOT satisfied"
