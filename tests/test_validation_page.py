"""The validation page is that of the registry; its cases are met, and can fail."""

import re
from dataclasses import replace
from pathlib import Path

import pytest
import scripts_as_modules

PAGE = (Path(__file__).parents[1] / "docs" / "validation.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def validation():
    return scripts_as_modules.script("validation")


@pytest.fixture(scope="module")
def cases(validation):
    return validation.cases()


def test_page_has_a_row_for_every_case_and_each_is_met(validation, cases):
    rows = [line for line in PAGE.splitlines() if line.startswith("| ") and line.endswith(" |")]
    rows = [row for row in rows if not row.startswith(("| structure", "| ---"))]
    assert len(rows) == len(cases)
    for case, row in zip(cases, rows, strict=True):
        expected = validation.cells(case, case.published, True)
        cells = row.strip("| ").split(" | ")
        assert cells[:5] == [cell.replace("|N|", "abs(N)") for cell in expected[:5]]
        assert cells[7:] == expected[7:]
    assert f"**{len(cases)} of {len(cases)} within" in PAGE


def test_every_source_is_named(cases):
    assert len({(case.structure, case.quantity, case.source) for case in cases}) == len(cases)
    assert all(case.source and case.quantity for case in cases)


@pytest.mark.parametrize("group", re.findall("^## (.+)", PAGE, re.M))
def test_every_case_is_met(validation, cases, group):
    own = [case for case in cases if case.group == group]
    assert own
    assert [case.structure for case in own if not validation.run(case)[1]] == []


def test_a_wrong_value_is_not_met(validation, cases):
    case = next(case for case in cases if case.quick and case.quantity == "associated")
    wrong = replace(case, published=1.001 * case.published)
    done, met = validation.run(wrong)
    assert not met
    assert validation.cells(wrong, done, met)[-1] == "**no**"


def test_a_case_without_an_answer_is_not_met(validation, cases):
    def fails():
        raise validation.lb.SolveError("no answer")

    assert not validation.run(replace(cases[0], run=fails))[1]
    assert not validation.run(replace(cases[0], run=lambda: float("nan")))[1]
