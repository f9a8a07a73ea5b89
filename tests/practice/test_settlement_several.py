"""Several supports that settle as one body: the closed forms of one support, levers, misuse."""

import json
import sys
from dataclasses import replace

import numpy as np
import pytest
from settling_blocks import beam_on
from stones import model_of
from typer.testing import CliRunner

import limitblocks as lb
from limitblocks.cli import app
from limitblocks.joints import Guide
from limitblocks.practice import reinforced, settlement, settlement_to_collapse, settling, tie, uplift

LENGTH, BEARING, DEPTH, WEIGHT = 3.0, 0.4, 0.5, 20e3
DOWN = (0, 0, -1)
LEAST = WEIGHT * LENGTH * DEPTH * (LENGTH / 2 - BEARING) / (LENGTH - BEARING)


def lintel(halves):
    """A lintel on the support "left" and on others of the widths and places across it of `halves`."""
    stones = [lb.Block.box("left", (BEARING, 1, 1), (BEARING / 2, 0, -0.5))]
    stones += [
        lb.Block.box(name, (BEARING, width, 1), (LENGTH - BEARING / 2, y, -0.5))
        for name, (width, y) in halves.items()
    ]
    stones.append(lb.Block.box("lintel", (LENGTH, 1, DEPTH), (LENGTH / 2, 0, DEPTH / 2), WEIGHT))
    return model_of(stones, ["left", *halves], lb.PointContact(0.6))


PIER = lintel({"near": (0.3, -0.35), "far": (0.7, 0.15)})


@pytest.mark.parametrize("order", [("near", "far"), ("far", "near")])
def test_stones_that_a_pier_stands_on_settle_as_one(order):
    """They carry together what one support in their place does; each by itself is spared by the other."""
    found = settlement(PIER, order, DOWN)
    assert found.settling.supports == order
    assert found.lower <= LEAST * (1 + 1e-9)
    assert found.upper == pytest.approx(LEAST, rel=1e-6)
    assert found.nonassociated == pytest.approx(LEAST, rel=1e-8)
    assert lb.check_mcp(found.settling.model, found.result).passed
    rates = found.result.displacement_rates[[b.name for b in found.settling.model.blocks].index("far")]
    assert rates == pytest.approx([0, 0, rates[2], 0, 0, 0], abs=1e-9 * abs(rates[2]))


def test_which_supports_move_and_which_rest_is_the_same_motion():
    """Across the reaction all supports give nothing: what drags some one way drags the others the other way.

    Nor does the order of their names count. Guides as soft as joints gave 17.7 or 15.7 kN, and 3.6 for 5.0.
    """
    places, sides = (("a", 0), ("b", 2), ("c", 4)), (("n", -0.25), ("f", 0.25))
    piers = [(name + side, (x, y, -0.25)) for name, x in places for side, y in sides]
    stones = [lb.Block.box(name, (0.4, 0.5, 0.5), at) for name, at in piers]
    stones += [lb.Block.box(name, (2.2, 1, 0.4), (x, 0, 0.2), WEIGHT) for name, x in (("l", 0.9), ("r", 3.1))]
    stones.append(lb.Block.box("t", (2, 1, 0.4), (2, 0, 0.6), WEIGHT))
    walls = model_of(stones, [name for name, _ in piers], lb.PointContact(0.7))

    def dragged(names, way):
        return settlement(walls, names.split(), (way, 0, 0)).nonassociated

    outer = dragged("an af cn cf", 1)
    assert dragged("cf an cn af", 1) == pytest.approx(outer, rel=1e-4)
    assert dragged("bn bf", -1) == pytest.approx(outer, rel=1e-3)
    assert dragged("af bn bf cn cf", -1) == pytest.approx(dragged("an", 1), rel=1e-3)


def test_a_lever_between_supports_that_settle():
    """A beam whose ends sink tips about the edge of what stays, on the far end; the near one leaves it."""
    beam = beam_on({"a": (0.0, 0.4), "b": (1.0, 1.4), "c": (9.6, 10.0)}, (0.0, 10.0), lb.PointContact(0.6))
    found = settlement(beam, ["a", "c"], DOWN)
    least = WEIGHT * 10.0 * 0.5 * (5.0 - 1.4) / (10.0 - 1.4)
    assert found.nonassociated == pytest.approx(least, rel=1e-8)
    assert [found.lower, found.upper] == pytest.approx([least, least], rel=1e-6)


def yielded(interface):
    """The interface; a tie without any strength beyond its prestress."""
    force = getattr(interface.joint, "prestress", 0.0)
    joint = replace(interface.joint, strength=force * (1 + 1e-12)) if force else interface.joint
    return replace(interface, joint=joint)


def test_water_and_a_tie_count_on_each_of_them():
    """Moments about the inner edge of what stays: stone on the far edge, water at mid bearing, rod at x."""
    head, x, prestress = 0.5, 2.8, 2e3
    joints = [one for one in PIER.interfaces if {"near", "far"} & {one.block_i, one.block_j}]
    rod = tie("lintel", (x, 0.1, DEPTH), "far", (x, 0.1, -1), area=1e-4, strength=235e6, prestress=prestress)
    wet = reinforced(replace(PIER, dead=PIER.dead + uplift(PIER, head, interfaces=joints)), rod)
    wet = replace(wet, interfaces=tuple(map(yielded, wet.interfaces)))
    water, arm = 9810.0 * head * BEARING, LENGTH - BEARING
    weight = WEIGHT * LENGTH * DEPTH * (LENGTH / 2 - BEARING)
    stone = (weight - water * (arm - BEARING / 2) + prestress * (x - BEARING)) / arm
    found = settlement(wet, ["near", "far"], DOWN)
    assert found.nonassociated == pytest.approx(stone + water - prestress, rel=1e-7)


def test_what_supports_that_settle_are_given_is_what_pulls_and_holds_them():
    """Loads that stay as they were are not put back, nor is rounding of water, two rods and reactions."""
    joints = [one for one in PIER.interfaces if "far" in (one.block_i, one.block_j)]
    wet = replace(PIER, dead=PIER.dead + uplift(PIER, 0.3) + uplift(PIER, 0.7, interfaces=joints, share=0.3))
    rods = [
        tie("lintel", (x, 0.1, DEPTH), "far", (x, 0.1, -1), area=1e-4, strength=235e6, prestress=x * 1e3 / 7)
        for x in (2.7, 2.8)
    ]
    wet = reinforced(wet, *rods)
    terms = settling(wet, ["near", "far"], (0.1, 0.2, -1)).model.dead.terms
    assert terms[: len(wet.dead.terms)] == wet.dead.terms
    assert [term.block for _, term in terms[len(wet.dead.terms) :]] == ["far", "far", "near", "far"]


def test_several_until_collapse():
    """A beam whose bearing of .2 m, on two stones side by side, slides away below its end."""
    whole = beam_on({"left": (-2.0, -1.6), "right": (1.6, 3.0)}, (-2.0, 1.8), lb.PointContact(0.1))
    stones = [one for one in whole.blocks if one.name != "right"]
    stones += [lb.Block.box(name, (1.4, 0.5, 1), (2.3, y, -0.5)) for name, y in (("r1", -0.25), ("r2", 0.25))]
    split = model_of(stones, ["left", "r1", "r2"], lb.PointContact(0.1))
    way = settlement_to_collapse(split, ["r1", "r2"], (1, 0, 0), accuracy=1e-3)
    one = settlement_to_collapse(whole, "right", (1, 0, 0), accuracy=1e-3)
    assert way.supports == ("r1", "r2")
    assert way.stands_to == pytest.approx(0.2, abs=2e-3)
    assert way.ended.split(" at ")[0] == one.ended.split(" at ")[0]
    assert way.points[0].found.upper == pytest.approx(one.points[0].found.upper, rel=1e-6)
    assert str(way).startswith("'r1', 'r2' settle from a reaction of")


def test_what_is_known_where_the_answer_without_dilatancy_does_not_converge(monkeypatch):
    """The bounds were lost, and what the message calls the live load was none of the user's."""

    def stuck(model):
        raise lb.errors.NotConverged("stuck", lb.nonassociated(model))

    monkeypatch.setattr(sys.modules[settlement.__module__], "nonassociated", stuck)
    with pytest.raises(lb.errors.NotConverged, match="stuck") as caught:
        settlement(PIER, ["near", "far"], DOWN)
    note = f"with dilatancy its least reaction is {LEAST:.6g} to {LEAST:.6g} N, and without_dilatancy=False"
    assert note in caught.value.__notes__[0]


@pytest.mark.parametrize(
    ("names", "said"),
    [
        ([], "settlement of no support: expected supports, each named once"),
        (["near", "near"], "settlement of 'near', 'near': expected supports, each named once"),
        (["near", "lintel"], "settlement: 'lintel' is a free block; expected one of the supports"),
        (
            ["left", "near", "far"],
            "'left', 'near', 'far' are all the supports; the whole structure would move",
        ),
        (["near", 3], "support holds 3, expected a sequence of str"),
        (7, "support is 7, expected a sequence of str"),
    ],
)
def test_supports_that_cannot_settle(names, said):
    with pytest.raises(lb.ModelError, match=said):
        settling(PIER, names, DOWN)


def test_report_and_command_name_all_of_them(tmp_path):
    page = lb.report(PIER, settlement(PIER, ["near", "far"], DOWN)).html
    assert (
        "Under the dead loads the supports near, far give way as one body, along (0, 0, -1), without" in page
    )
    model, out = PIER.save(tmp_path / "pier.json"), tmp_path / "found.json"
    way = ["settle", str(model), "--support", "near", "--support", "far", "-o", str(out)]
    done = CliRunner().invoke(app, way)
    assert done.exit_code == 0, done.output
    assert json.loads(out.read_text())["settling"]["supports"] == ["near", "far"]


def test_rigid_guide_makes_one_body_of_two_blocks(tmp_path):
    """Two cubes, the joint between them without friction: as one body they tip at 1/2."""
    stones = [lb.Block.box("ground", (3, 3, 1), (0, 0, -0.5))]
    stones += [lb.Block.box(name, (1, 1, 1), (0, 0, z), WEIGHT) for name, z in (("low", 0.5), ("high", 1.5))]
    model = model_of(stones, ["ground"], lb.PointContact(0.9))
    joints = [
        replace(one, joint=lb.PointContact(0.0)) if "high" in (one.block_i, one.block_j) else one
        for one in model.interfaces
    ]
    held = next(one for one in joints if "high" in (one.block_i, one.block_j))
    loose = replace(model, interfaces=joints)
    assert lb.bounds(loose).upper == pytest.approx(0.0, abs=1e-6)
    for slides, expected in ((False, 0.5), (True, 0.0)):
        s1_along = replace(held, axes=np.eye(3), joint=Guide(1e9, slides=slides))
        guided = replace(loose, interfaces=[*joints, s1_along])
        assert lb.bounds(guided).upper == pytest.approx(expected, abs=1e-6)
        assert lb.read(guided.save(tmp_path / f"{slides}.json")).interfaces[-1].joint == Guide(
            1e9, slides=slides
        )


@pytest.mark.parametrize(("slides", "forces"), [(True, 2), (False, 3)])
def test_forces_and_moments_up_to_which_a_guide_holds(slides, forces):
    """On 2 x 2 m with 3 Pa: 12 N, and 24 Nm."""
    corners = np.array([[(-1, -1), (1, -1), (1, 1), (-1, 1)]], dtype=float)
    rows = Guide(3.0, slides=slides).yield_rows(corners)
    assert rows.g[0] == pytest.approx(2 * [*forces * [12.0], *3 * [24.0]])
