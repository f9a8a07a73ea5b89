"""The table of docs/practice.md: its tests exist, its figures are those of the registry or of formulas."""

import ast
import re
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "practice.md").read_text(encoding="utf-8")
ROWS = [
    [cell.strip() for cell in line.strip("|").split("|")]
    for line in PAGE[PAGE.index("## What is checked") :].splitlines()
    if line.startswith("| ") and not line.startswith("| question")
]
FIGURES = {  # by hand
    "settlement": [40e3 * 1.5 / 2.5],
    "settlement at collapse": [0.377629],  # spreading_arch.py
    "tie": [(45e3 * 0.25 + 10e3 * 0.35 + 8e3 * 4.5) / (45e3 * 2.5 + 10e3 * 5)],
    "strip, dowel, prestress": [(45e3 * 0.25 + 10e3 * 0.35 + 6e3 * 0.5) / (45e3 * 2.5 + 10e3 * 5), 0.35],
    "capacity curve": [np.sin(np.arctan(0.2))],
    "verification": [
        0.9037433,
        0.7298419,
        0.2955306,
        0.495985,
    ],  # tests/practice/test_verification.py has the formulas
    "partial factors": [0.3 * 1.35 / (1.25 * 1.5)],
    "vehicles": [40e3 / 10e3],
    "fill": [0.2 + 2.0 * 1e3 * 1.0 / 10e3],
    "spans, piers, rings": [37.8540],  # planar_bridge.py
    "uplift": [0.3 * (1 - 9810 * 0.6 * 2 / 40e3)],
    "repair": [45e3 * (0.3 * 5 - 0.5) / (2 * 4.5)],
}


def test_every_question_has_its_row():
    assert [row[0] for row in ROWS] == list(FIGURES)
    assert all(all(row) and len(row) == 6 for row in ROWS)


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row[0])
def test_figures_are_those_of_the_formulas(row):
    shown = [
        float(number.replace(",", ""))
        for number in re.findall(r"[\d,]*\.?\d+", re.sub(r"[ad]0\*,?|C[\d.]+", "", row[2]))
    ]
    assert shown == pytest.approx(FIGURES[row[0]], rel=3e-6)


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row[0])
def test_named_tests_are_there(row):
    named = re.findall(r"`([\w.]+?)(?:::(\w+))?`", row[5])
    assert named
    for file, test in named:
        (path,) = (ROOT / "tests").glob(f"*/{file}")
        names = {part.name for part in ast.parse(path.read_text()).body if isinstance(part, ast.FunctionDef)}
        assert not test or test in names
        assert any(name.startswith("test_") for name in names)
