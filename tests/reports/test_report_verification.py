"""What a report says of a verification: every quantity, mass and check."""

from dataclasses import replace

import numpy as np
import pytest
from chapters import chapter, rows
from facades import ARM, FC, FLOOR, OWN, SITE, G, H, T, facade

import limitblocks as lb
from limitblocks.practice import capacity_curve, verification
from limitblocks.practice.verification_result import without_curve
from limitblocks.reports.terminal import print_result

TITLE = "Kinematic verification of the mechanism"
P, DELTA = np.array([OWN, FLOOR]), np.array([H / 2, H])  # weights and their displacements
ALPHA = (OWN * T / 2 + FLOOR * ARM) / (P @ DELTA)
E = (P @ DELTA) ** 2 / (P @ DELTA**2 * P.sum())  # participating share
A0 = ALPHA * G / (E * FC)
D0 = H * np.sin(np.arctan(ALPHA)) * (P @ DELTA**2) / (H * P @ DELTA)


@pytest.fixture(scope="module")
def answers():
    model = facade()
    curve = capacity_curve(model, control=("wall", (T / 2, 0.5, H)), steps=3)
    settings = {"q": 2.0, "confidence": FC, "collapse_demand": SITE}
    solved = lb.nonassociated(model)
    return model, solved, settings, verification(model, solved, SITE, curve=curve, **settings), curve


@pytest.fixture(scope="module")
def report(answers):
    return lb.report(answers[0], answers[3])


def quantities(report, title):
    """Step and cells of each quantity of a verification, in their order."""
    found = {}
    for part in chapter(report, title).parts:
        if getattr(part, "heads", ("",))[0] == "Symbol":
            found |= {row[0].text: (part.caption, [cell.text for cell in row]) for row in part.rows}
    return found


def test_each_quantity_is_there_with_its_formula_and_its_source(report):
    """Each from its formula; the facade of tests/practice/test_verification.py."""
    period = 1.68 * np.pi * np.sqrt(0.4 * D0 / (0.6 * A0))
    expected = {
        "α0": ALPHA,
        "Σ P": P.sum() / 1e3,
        "M*": E * P.sum() / G / 1e3,
        "e*": E,
        "FC": FC,
        "a0*": A0,
        "a_g": 0.25 * G,
    }
    expected |= {"S": 1.2, "F0": 2.5, "q": 2.0, "a_d": 0.25 * G * 1.2 / 2, "d0*": D0, "T_SLV": period}
    units = {"Σ P": "kN", "M*": "t", "a0*": "m/s²", "a_g": "m/s²", "a_d": "m/s²", "d0*": "m", "T_SLV": "s"}
    shown = {symbol: cells for symbol, (_, cells) in quantities(report, TITLE).items()}
    for symbol, value in expected.items():
        number, _, unit = shown[symbol][3].partition(" ")
        assert float(number) == pytest.approx(value, rel=6e-4), symbol  # four digits
        assert unit == units.get(symbol, "")
        assert all(shown[symbol]), symbol  # meaning, formula and source, too
    assert shown["e*"][2:] == ["(Σ P dx)² / (Σ P  Σ P dx²)", f"{E:.4g}", "[C8.7.1.5]"]
    sources = {"α0": "[C8.7.1.1]", "a0*": "[C8.7.1.8]", "d0*": "[C8.7.1.4]", "a*_SLV,c": "[C8.7.1.3]"}
    sources |= {"T_SLV": "[C8.7.1.10]", "q": "C8.7.1.2.1.7", "d*_SLV": "C8.7.1.2.1.6"}
    assert {symbol: shown[symbol][4] for symbol in sources} == sources
    assert shown["FC"][1] == "confidence factor (fattore di confidenza)"
    assert shown["ξ_SLC"][1].endswith("(smorzamento viscoso equivalente)")


def test_the_steps_stand_in_the_order_of_the_text(report):
    steps = quantities(report, TITLE)
    assert list(dict.fromkeys(caption.split(" (")[0] for caption, _ in steps.values())) == [
        "Activation of the mechanism",
        "Seismic action",
        "Linear check at SLV",
        "Non-linear check at SLV",
        "Non-linear check at SLC",
    ]
    assert "cinematica lineare, C8.7.1.2.1.7" in steps["q"][0]


def test_the_masses_have_their_sums(report):
    masses = rows(report, TITLE, "Weights and virtual displacements")
    wall, floor = ([float(cell) for cell in masses[of][1:4]] for of in ("wall", "mass on wall"))
    assert float(masses["Sum"][1]) == pytest.approx(P.sum() / 1e3, rel=6e-4)
    assert float(masses["Sum"][5]) == pytest.approx(P @ DELTA**2 / H**2 / 1e3, rel=6e-4)
    assert wall == pytest.approx([OWN / 1e3, 0.5, T / 2 / H], rel=6e-4)
    assert floor[:2] == pytest.approx([FLOOR / 1e3, 1.0], rel=6e-4)


def test_the_checks_are_made_and_nothing_is_claimed_beyond_them(report):
    demand = 0.25 * G * 1.2 * 2.5 * 0.5 * 2.6 / (2 * np.pi) ** 2 * np.sqrt(10 / 13)  # beyond T_D, 8 %
    checks = rows(report, TITLE, "Checks")
    assert checks["linear, SLV"][3:5] == ["0.495", "NOT satisfied"]  # .495985, never rounded up
    assert float(checks["linear, SLV"][1].split()[0]) == pytest.approx(A0, rel=6e-4)
    assert checks["non-linear, SLV"][4] == ("satisfied" if demand <= 0.4 * D0 else "NOT satisfied")
    _, cells = quantities(report, TITLE)["d*/S_De_SLV"]
    assert float(cells[3]) == pytest.approx(0.4 * D0 / demand, rel=6e-4)
    per = 1.2 * 2.5 * 0.5 * np.sqrt(10 / 13) / (2 * np.pi) ** 2  # demand per a_g and T_D = 4 a_g / g + 1.6
    a_g = max(np.roots([4 * per / G, 1.6 * per, -0.4 * D0]))
    assert float(checks["non-linear, SLV"][1].split()[0]) == pytest.approx(a_g, rel=6e-4)
    said = " ".join(getattr(part, "text", "") for part in chapter(report, TITLE).parts)
    assert "Nothing is claimed beyond the inequalities named" in said
    assert "not against the Gazzetta itself" in said


def test_what_snaps_through_zero_ends_before_it_does(answers):
    """A last point that snapped, wherever it lies, is beyond the zero: it changes no number."""
    model, solved, settings, verified, curve = answers
    for share in (0.4, 3.0):
        there = replace(curve.points[-1], displacement=share * curve.zero, load_factor=-0.05, snapped=True)
        beyond = replace(curve, points=(*curve.points, there))
        (shown,), (expected,) = (lb.report(model, one).sections for one in (beyond, curve))
        assert (shown.headline, shown.values[:2]) == (expected.headline, expected.values[:2])
        again = verification(model, solved, SITE, curve=beyond, **settings)
        assert [one.value for one in again.quantities] == [one.value for one in verified.quantities]


def test_a_verification_that_lacks_a_check_has_no_ratio_at_its_head(answers):
    """Linear at .01 g: satisfied; the curve ends early. Who read the head alone took it for the whole."""
    model, solved, *_ = answers
    made = verification(model, solved, replace(SITE, a_g=0.01 * G), q=2.0, confidence=FC)
    lacking = without_curve(made, "blocks meet at 0.01 m")
    assert made.checks[0].satisfied
    said = lb.report(model, solved, lacking)
    head = chapter(said, TITLE).parts[0]
    assert head.number == "not complete"
    assert head.quantity.startswith(
        "verification: no non-linear check: the capacity curve does not end at zero"
    )
    assert head.quantity.endswith("least ratio of capacity to demand: linear, SLV, satisfied")
    assert "not complete" in said.text.split("Side by side")[0]  # what is said about safety
    checks = rows(said, TITLE, "Checks")
    assert checks["non-linear"] == ["non-linear", "", "", "", "NOT made", "C8.7.1.2.1.8"]
    assert "not complete" not in lb.report(model, solved, made).text  # nobody asked for the other
    assert "no non-linear check" in str(lacking)
    assert lacking.to_dict()["left_out"] == lacking.left_out


def test_on_a_screen_the_verdict_is_last_and_a_long_table_short(answers, capsys):
    """Of 80 masses and their sum, 81 rows, the first and the last eight."""
    model, _, _, found, _ = answers
    many = tuple(replace(found.masses[0], name=f"stone {k}") for k in range(80))
    for masses, left in ((found.masses, False), (many, True)):
        print_result(model, replace(found, masses=masses))
        said = capsys.readouterr().out
        assert ("(65 rows left out: --json or --report FILE)" in " ".join(said.split())) == left
        assert said.rstrip().splitlines()[-1].lstrip().startswith("0.495")  # where a screen ends, and begins
        assert said.lstrip().startswith("0.495")
    shown = [line.split("  ")[0] for line in said.splitlines() if line.startswith("stone")]
    assert shown == [f"stone {k}" for k in (*range(8), *range(73, 80))]
    assert lb.report(model, replace(found, masses=many)).text.count("stone ") == 80
