"""What practice computes, in reports: every fact in every rendering, and refusals."""

import json
import re
from dataclasses import replace
from types import SimpleNamespace

import facades
import jsonschema
import numpy as np
import pytest
from chapters import chapter, rows
from facades import ARM, FC, FLOOR, OWN, SITE, H, T
from renderings import RENDERINGS, missing

import limitblocks as lb
from limitblocks.practice import (
    Deck,
    Vehicle,
    capacity_curve,
    least_ties,
    reinforced,
    settlement,
    settlement_to_collapse,
    tie,
    verification,
    worst_position,
)
from limitblocks.reports.curve import line_curve
from limitblocks.reports.curve_sections import _changes
from limitblocks.reports.document import Text
from limitblocks.reports.facts import facts

TIES = [tie("wall", (-T / 2, 0, z), "ground", (-6, 0, z), area=1e-3, strength=100e6) for z in (2.0, 4.5)]


@pytest.fixture(scope="module")
def facade():
    return facades.facade()


@pytest.fixture(scope="module")
def beam():
    return facades.beam()


@pytest.fixture(scope="module")
def answers(facade):
    solved = lb.nonassociated(facade)
    curve = capacity_curve(facade, control=("wall", (T / 2, 0.5, H)), steps=3)
    verified = verification(facade, solved, SITE, q=2.0, confidence=FC, curve=curve, collapse_demand=SITE)
    return solved, verified, curve, least_ties(facade, TIES, 0.3)


@pytest.fixture(scope="module")
def settled(beam):
    return settlement(beam, "right", (0, 0, -1))


@pytest.fixture(scope="module")
def vehicle(beam):
    return worst_position(beam, Vehicle((10e3,)), Deck(0.5), (3.2, 3.8), positions=3)


@pytest.fixture(scope="module")
def reports(facade, answers, beam, settled, vehicle):
    return lb.report(facade, *answers, title="Facade"), lb.report(beam, settled, vehicle, title="Beam")


@pytest.mark.parametrize("rendering", RENDERINGS)
def test_every_fact_is_in_every_rendering(rendering, reports):
    assert [missing(report, rendering) for report in reports] == [[], []]


def test_the_answer_names_the_verification(reports):
    first = " ".join(getattr(part, "text", "") for part in reports[0].document.chapters[0].parts)
    assert "Safety: chapter Kinematic verification of the mechanism: 0.4" in first
    assert "says nothing about safety" not in first


def test_a_capacity_curve_has_its_points_and_its_drawing(reports):
    shown = rows(reports[0], "Capacity curve", "Points")
    alpha = (OWN * T / 2 + FLOOR * ARM) / (OWN * H / 2 + FLOOR * H)
    first, *_, last = shown.values()
    assert float(first[1]) == pytest.approx(alpha, rel=1e-5)
    assert float(last[0]) == pytest.approx(H * np.sin(np.arctan(alpha)), rel=1e-5)
    (drawing,) = (p for p in chapter(reports[0], "Capacity curve").parts if hasattr(p, "sheet"))
    assert len(drawing.sheet.dots) == len(shown)
    assert "displacement of wall along" in " ".join(label.text for label in drawing.sheet.labels)


def test_a_repair_lists_its_candidates(reports):
    """The upper tie alone, T z = alpha (sum of P h) - the moments that hold."""
    force = (0.3 * (OWN * H / 2 + FLOOR * H) - OWN * T / 2 - FLOOR * ARM) / 4.5
    shown = list(rows(reports[0], "Least reinforcement", "Reinforcement").values())
    assert shown[0][1] == "not needed"
    assert float(shown[1][1].split()[0]) == pytest.approx(force / 1e3, rel=1e-4)


def test_a_settlement_has_reactions_and_its_mechanism(reports):
    """The beam rests on the left support's inner edge and the far edge of the right one."""
    shown = rows(reports[1], "Settlement of right", "Result")
    least = 40.0 * (2.0 - 0.5) / (3.0 - 0.5)
    assert float(shown["Without dilatancy"][1].split()[0]) == pytest.approx(least, rel=1e-5)
    (drawing,) = (p for p in chapter(reports[1], "Settlement of right").parts if hasattr(p, "sheet"))
    assert "2 of 3 blocks move" in drawing.sheet.text
    assert [label.text for label in drawing.sheet.labels] == ["X", "Y", "Z"]  # no live load acts


def test_the_worst_position_is_marked(reports, vehicle):
    shown = rows(reports[1], "Vehicle on the deck", "Load factor by position")
    assert [row[0] for row in shown.values() if row[2] == "worst"] == [f"{vehicle.position:.3f}"]


def test_the_envelope_of_a_vehicle_has_a_gap_where_the_load_is_unlimited(beam, vehicle):
    places, factors = np.arange(5.0), np.array([2.0, 3.0, np.inf, 4.0, 2.5])
    drawn = replace(vehicle, positions=places, load_factors=factors, position=0.0)
    report = lb.report(beam, drawn)
    (curve,) = (
        p.sheet for p in chapter(report, "Vehicle on the deck").parts if hasattr(p, "sheet") and p.sheet.dots
    )
    (line,) = (shape.path for group in curve.groups if group.style == "line" for shape in group.shapes)
    assert [len(part.split()) for part in line.split("M")[1:]] == [2, 2]
    assert len(curve.dots) == 4
    assert "gap" in report.text


def test_a_curve_without_extent_is_drawn_at_the_start_of_its_axis():
    """A file may say one displacement of all points."""
    x, y = np.array([2.0, 2.0]), np.array([1.0, 0.5])
    drawn = line_curve(("title", "caption", "x", "y"), (x, y), ["first", "last"])
    assert [x for x, _, _ in drawn.dots] == [110.0, 110.0]


def test_the_envelope_of_a_vehicle_far_from_the_origin_fills_its_axis(beam, vehicle):
    """1 m of bridge at X = 1000 m was a stroke at the end of an axis from 0, places told in metres."""
    places, factors = 1000.0 + np.arange(5.0) / 4.0, np.array([2.0, 3.0, 5.0, 4.0, 2.5])
    drawn = replace(vehicle, positions=places, load_factors=factors, position=1000.25)
    made = chapter(lb.report(beam, drawn), "Vehicle on the deck")
    assert made.parts[0].quantity.endswith("X = 1000.25 m")
    (curve,) = (part.sheet for part in made.parts if hasattr(part, "sheet") and part.sheet.dots)
    x = [dot.x for dot in curve.dots]
    assert x == pytest.approx(np.linspace(110.0, 970.0, 5), abs=0.1)  # the whole width between the margins
    assert [dot.text.split(":")[0] for dot in curve.dots][1::2] == ["X = 1000.25 m", "X = 1000.75 m"]


def words(chapter):
    return [part.text for part in chapter.parts if isinstance(part, Text)]


def test_a_report_without_a_load_factor_has_the_answer_at_its_head(beam, vehicle, settled):
    """Not "none"; with a load factor of the model itself that comes first."""
    for answers, word in (((vehicle,), "axle 1 at X"), ((settled, vehicle), "least reaction")):
        first = lb.report(beam, *answers).document.chapters[0]
        assert first.title == "Answer"
        assert word in first.parts[0].quantity
        assert not any("demand" in text for text in words(first))
        asked = lb.report(beam, *answers, demand=0.25).document.chapters[0]
        assert "Safety: the demand 0.25 is not compared with anything." in words(asked)
    both = lb.report(beam, lb.bounds(beam), vehicle).document.chapters[0]
    assert both.title == "Load factor to design with"


def test_a_vehicle_has_its_mechanism_and_its_weight(reports):
    made = chapter(reports[1], "Vehicle on the deck")
    drawn = [part.sheet.style for part in made.parts if hasattr(part, "sheet")]
    assert "mechanism" in drawn
    shown = rows(reports[1], "Vehicle on the deck", "Result")
    assert shown["Axles on the structure"][1] == "10 kN"
    assert made.parts[0].quantity.startswith("associated load factor of the vehicle")
    assert shown["Without dilatancy"][1] == "not computed"


def test_the_json_follows_its_schema(reports):
    for report in reports:
        jsonschema.validate(json.loads(report.json, parse_constant=pytest.fail), lb.files.report_schema())


def test_a_mechanism_that_the_viewer_does_not_play_is_on_the_screen_too(facade, reports):
    """Of a vehicle and a settlement there is no other picture; that of bounds is for paper."""
    assert reports[1].html.count("<figure>") > reports[1].html.count('<svg class="mechanism"') == 2
    assert '<figure class="static">' not in reports[1].html
    assert lb.report(facade, lb.bounds(facade)).html.count('<figure class="static">') == 1


def test_answers_of_another_model_are_refused(facade, beam, answers, settled, vehicle):
    for model, own in ((beam, answers[1:]), (facade, (settled, vehicle))):
        for answer in own:
            with pytest.raises(lb.LimitBlocksError, match=f"this {type(answer).__name__} belongs to model"):
                lb.report(model, answer)
    with pytest.raises(lb.LimitBlocksError, match="belongs to model"):
        lb.report(replace(facade, live=2.0 * facade.live), answers[1])


def test_a_support_that_settles_until_collapse():
    """Two stones that lean on one another: the thrust at rest, the points, where it falls."""
    ring = lb.structures.arch(lb.PointContact(0.5), radius=1.0, thickness=0.3, voussoirs=2)
    curve = settlement_to_collapse(ring, "right support", (1, 0, 0), largest=0.01)
    report = lb.report(ring, curve)
    title = "Settlement of right support until collapse"
    shown = list(rows(report, title, "Points of the settlement").values())
    assert [float(row[0]) for row in shown] == pytest.approx(curve.displacements, rel=1e-6)
    for row, reaction in zip(shown, curve.reactions, strict=True):
        assert [float(cell.split()[0]) for cell in row[1:4]] == pytest.approx([reaction / 1e3] * 3, rel=1e-5)
    assert "voussoir 1|voussoir 2 opens" in shown[1][4]
    _, moved = [p.sheet for p in chapter(report, title).parts if hasattr(p, "sheet")]
    assert [label.text for label in moved.labels] == ["X", "Y", "Z"]  # no live load acts
    assert "Falls at" not in report.text
    fallen = replace(curve, falls=0.012, ended="the structure falls between 0.01 and 0.012 m")
    assert "0.01200000 m" in lb.report(ring, fallen).text
    filled = replace(curve.points[-1], across=("a|b presses across a gap of 1 mm",))
    said = lb.report(ring, replace(curve, points=(curve.points[0], filled))).text
    assert "joints press across their gaps" in said


def test_the_interface_area_is_that_of_contacts():
    """A tie of 1e-2 m2 is no contact of the block, 0.5 m wide."""
    model = lb.structures.block(lb.PointContact(0.5), width=0.5, height=1.0)
    stone, ground = model.free_blocks[0], model.supports[0]
    rod = tie(stone.name, stone.centroid.tolist(), ground, (-3, 0, 0), area=1e-2, strength=1e6)
    areas = [facts(one)["interface_area"] for one in (model, reinforced(model, rod))]
    assert areas[1] == pytest.approx(areas[0], rel=1e-12)


def test_a_point_whose_dead_loads_alone_fall_says_so():
    point = SimpleNamespace(changes=("a|b opens",), shift=-0.458)
    assert _changes(point).endswith("the dead loads alone do not stand: solved from 0.458 of the live load")
    assert _changes(SimpleNamespace(changes=(), shift=0.0)) == "none"


def test_a_report_of_a_curve_alone_heads_with_its_displacement(facade, answers, reports):
    """H sin(a) where wall and floor are over the toe; beside a load factor that one is at the head."""
    head = lb.report(facade, answers[2]).text.split("Model\n")[0]
    turn = np.arctan((OWN * T / 2 + FLOOR * ARM) / (OWN * H / 2 + FLOOR * H))
    shown = re.search(r"([.\d]+) m  displacement at load factor zero", head)
    assert float(shown[1]) == pytest.approx(H * np.sin(turn), abs=1e-4)
    assert "none" not in head
    assert "Load factor to design with" in reports[0].text.split("Model\n")[0]
    ring = lb.structures.arch(lb.PointContact(friction=0.8), radius=1.0, thickness=0.2, voussoirs=8)
    settled = settlement_to_collapse(ring, "right support", (1, 0, 0), largest=0.01)
    head = lb.report(ring, settled).text.split("Model\n")[0]
    assert "0.01000 m  settlement up to which it stands" in head


def test_a_curve_of_one_point_is_warned_of(facade, answers):
    """Nothing but the load factor at rest is known: its end at 0 m is no displacement capacity."""
    one = replace(answers[2], points=answers[2].points[:1], zero=None, ended="no checked answer beyond 0 m")
    said = "the curve is its first point alone: no checked answer beyond 0 m"
    assert said in lb.report(facade, one).text.replace("\n", " ")
    assert "first point alone" not in lb.report(facade, answers[2]).text
