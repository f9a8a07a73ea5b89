"""Least reinforcement, water, vehicles, rocking: closed forms and misuse."""

from dataclasses import replace

import facades
import numpy as np
import pytest
from stones import model_of

import limitblocks as lb
from limitblocks.practice import (
    PartialFactors,
    Rocking,
    design_model,
    dowel,
    element_acceleration,
    element_force,
    least_masses,
    least_ties,
    passive_fill,
    reinforced,
    repair,
    strip,
    tie,
    uplift,
)

T, H, WEIGHT = 0.5, 5.0, 18e3
JOINT = lb.PointContact(0.7)


def wall():
    return model_of(facades.wall_stones(), ["ground"], JOINT)


def rod(height, capacity=1e5, end=-6.0):
    return tie("wall", (-T / 2, 0, height), "ground", (end, 0, height), area=1e-3, strength=capacity / 1e-3)


def test_a_longer_tie_among_candidates_of_one_kind_gets_its_own_force():
    """Moments about the toe, as above: the highest of three, of which the others are of one length."""
    required, own = 0.3, WEIGHT * T * H
    found = least_ties(wall(), [rod(2.0), rod(4.5, end=-9.0), rod(3.0)], required)
    assert found.amounts == pytest.approx([0.0, own * (required * H - T) / 2 / 4.5, 0.0], rel=1e-6)


@pytest.mark.parametrize("share", [0.9, 1.35])
def test_an_added_mass_weighs_as_the_blocks_do(share):
    """gamma_G (W t / 2 + P x) = alpha (W H / 2 + P z) about the toe."""
    required, own = 0.14, WEIGHT * T * H
    design = design_model(wall(), PartialFactors(gamma_G=share, gamma_Q=1.0, gamma_M=1.0))
    by_hand = replace(wall(), dead=0.5 * share * lb.self_weight() + 0.5 * share * lb.self_weight())
    for model in (design, by_hand):
        found = least_masses(model, [("wall", (-T / 2, 0, 0.5))], required)
        least = own * (required * H - share * T) / 2 / (share * T - required * 0.5)
        assert found.total == pytest.approx(least, rel=1e-6)
        assert found.bounds.lower >= required * (1 - 1e-5)


def test_what_a_repair_brings_without_dilatancy():
    """A wedge in a groove: a tie along it adds its force; sliding without lift starts from less.

    Associated mu / sqrt(sin^2 w - mu^2 cos^2 w), without dilatancy mu / sin w (limitblocks.structures.wedge).
    """
    mu, w, required = 0.3, np.pi / 4, 0.7
    groove = lb.structures.wedge(lb.PointContact(mu), half_angle=w, height=1.0, length=6.0)
    weight = groove.free_blocks[0].weight
    at = groove.free_blocks[0].centroid
    rod = tie("wedge", at, "left plane", at - [9.0, 0.0, 0.0], area=1e-3, strength=1e9)
    found = least_ties(groove, [rod], required)
    dilating = mu / np.sqrt(np.sin(w) ** 2 - (mu * np.cos(w)) ** 2)
    assert found.total == pytest.approx((required - dilating) * weight, rel=1e-6)
    assert found.result.load_factor == pytest.approx(mu / np.sin(w) + found.total / weight, rel=2e-6)
    assert found.result.load_factor < 0.98 * required
    made = lb.report(groove, found)
    assert "less than the load factor 0.7 required" in made.markdown


def test_a_repair_that_does_not_reach_what_is_required_is_no_repair(monkeypatch):
    """Whatever the program says, the bounds of the reinforced structure judge it."""
    right = repair.least_stresses
    monkeypatch.setattr(repair, "least_stresses", lambda *given: 0.9 * right(*given))
    with pytest.raises(lb.errors.SolverFailure, match=r"reaches 0\.28.* only, required was 0\.3"):
        least_ties(wall(), [rod(4.5)], 0.3)


def test_a_structure_that_has_the_load_factor_gets_nothing():
    """The program leaves 1e-11 of a weight in a tie, which was built."""
    model = lb.structures.arch(lb.PointContact(0.6), radius=3.0, thickness=0.7, voussoirs=7)
    crown = model.free_blocks[3]
    rods = [
        tie(
            crown.name, crown.centroid, model.supports[0], crown.centroid - [x, 0, x], area=1e-3, strength=1e8
        )
        for x in (2.0, 3.0)
    ]
    enough = 0.7 * lb.bounds(model).lower
    found = least_ties(model, rods, enough)
    assert (found.total, found.amounts.tolist()) == (0.0, [0.0, 0.0])
    assert len(found.model.interfaces) == len(model.interfaces)
    heaped = least_masses(model, [(one.name, one.centroid) for one in model.free_blocks], enough)
    assert (heaped.total, heaped.model.digest) == (0.0, model.digest)


def test_load_factor_out_of_reach():
    with pytest.raises(
        lb.ModelError, match="the load factor 2; with their whole strengths it has "
    ) as caught:
        least_ties(wall(), [rod(4.5, 1e3)], 2.0)
    whole = lb.bounds(reinforced(wall(), rod(4.5, 1e3))).upper
    assert float(str(caught.value).split()[-1]) == pytest.approx(whole, rel=1e-5)
    with pytest.raises(lb.ModelError, match="at least one tie"):
        least_ties(wall(), [], 0.3)
    with pytest.raises(lb.ModelError, match="at least one place"):
        least_masses(wall(), [], 0.3)


def test_pressure_in_a_joint_of_no_block():
    model = lb.structures.block(lb.PointContact(0.3), width=2.0, height=1.0)
    ((_, term),) = uplift(model, 0.6).terms
    with pytest.raises(lb.ModelError, match="dead load: block 'grund' of a joint is missing"):
        replace(model, dead=lb.loads.Load(((1.0, replace(term, block_i="grund")),)))


def test_uplift_in_an_inclined_joint_acts_at_the_centre_of_pressure():
    """Water on a plane rectangle: the centre of pressure lies I / (A h) below the centroid."""
    a = np.pi / 4
    turn = np.array([(np.cos(a), 0, np.sin(a)), (0, 1, 0), (-np.sin(a), 0, np.cos(a))])
    base = lb.Block.box("base", (2, 1, 1), (0, 0, -0.5))
    top = lb.Block.box("top", (2, 1, 1), (0, 0, 0.5), 20e3)
    stones = [lb.Block(s.name, s.vertices @ turn.T, s.faces, s.unit_weight) for s in (base, top)]
    model = model_of(stones, ["base"], lb.PointContact(2.0), (0, 1, 0))
    load = uplift(model, 1.0, unit_weight=1.0).on(model.free_blocks)[0]
    below = 2.0**3 / 12 * np.sin(a) / 2.0  # I sin / (A depth), depth one
    way = below * np.array([np.cos(a), 0, -np.sin(a)])
    push = 2.0 * 1.0 * np.array([np.sin(a), 0, np.cos(a)])
    assert load[:3] == pytest.approx(push, abs=1e-12)
    assert load[3:] == pytest.approx(np.cross(way - model.free_blocks[0].centroid, push), abs=1e-12)


@pytest.mark.parametrize("share", [1.0, 0.5])
def test_uplift_in_a_joint_that_crosses_the_level(share):
    """Upright joint, wet to the depth h: gamma h^2 b / 2, at h / 3 over its foot."""
    b, h, height, gamma = 0.8, 0.6, 1.5, 9810.0
    stones = [
        lb.Block.box("left", (1, b, height), (-0.5, 0, height / 2)),
        lb.Block.box("right", (1, b, height), (0.5, 0, height / 2), 20e3),
    ]
    model = model_of(stones, ["left"], lb.PointContact(2.0), (0, 1, 0))
    load = uplift(model, h, unit_weight=gamma, share=share).on(model.free_blocks)[0]
    push = np.array([share * gamma * h**2 / 2 * b, 0, 0])
    at = np.array([0, 0, h / 3])
    assert load[:3] == pytest.approx(push, rel=1e-12, abs=1e-9)
    assert load[3:] == pytest.approx(np.cross(at - model.free_blocks[0].centroid, push), rel=1e-12, abs=1e-9)


def test_uplift_in_a_radial_joint_that_crosses_the_level():
    """A plane at 45 degrees, wet to the depth h: length h sqrt 2, centre of pressure at a third of it."""
    h, gamma = 0.4, 1.0
    sections = {"left": [(-1, 0), (0, 0), (1, 1), (-1, 1)], "right": [(0, 0), (2, 0), (2, 1), (1, 1)]}
    stones = [lb.Block.prism(name, section, (0, 1), 20e3) for name, section in sections.items()]
    model = model_of(stones, ["left"], lb.PointContact(2.0), (0, 1, 0))
    load = uplift(model, h, unit_weight=gamma).on(model.free_blocks)[0]
    push = gamma * h**2 / 2 * np.array([1, 0, -1])  # the lower face of the right block is free
    at = np.array([h / 3, 0.5, h / 3])
    assert load[:3] == pytest.approx(push, abs=1e-12)
    assert load[3:] == pytest.approx(np.cross(at - model.free_blocks[0].centroid, push), abs=1e-12)


def test_no_water_in_ties_strips_dowels_and_passive_fill():
    """Water of depth h lifts a wedge by gamma h A, whatever holds it; what is no joint is refused."""
    model, h = wedge(), 0.5
    bed = model.interfaces[0]
    held = reinforced(
        model,
        tie("wedge", (0, 0, 0.2), "ground", (-3, 0, 0.2), area=0.1, strength=1e5),
        strip(bed, (0, 0, 0), width=0.3, capacity=1e3),
        dowel(bed, (0.5, 0, 0), diameter=0.3, capacity=1e3),
        *passive_fill(model, 1.5, unit_weight=1e3, coefficient=2.0),
    )
    lift = uplift(held, h, unit_weight=9810.0).on(held.free_blocks)
    assert lift == pytest.approx(np.array([[0, 0, 9810.0 * h, 0, -9810.0 * h * (0.5 - 1 / 3), 0]]))
    for word, own in zip(("tie", "strip", "dowel", "fill"), held.interfaces[1:], strict=True):
        with pytest.raises(lb.ModelError, match=f"is of a {word}, in which there is no water"):
            uplift(held, h, interfaces=[own])


def wedge(sign=1.0):
    """A wedge of 45 degrees on the ground, pushed along or against X."""
    outline = np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])
    points = np.concatenate([np.insert(outline, 1, y, axis=1) for y in (-0.5, 0.5)])
    faces = [(0, 1, 2), (5, 4, 3), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)]
    stones = [lb.Block.box("ground", (3, 1, 0.4), (0.5, 0, -0.2)), lb.Block("wedge", points, faces, 20e3)]
    return model_of(stones, ["ground"], lb.PointContact(0.2), (sign, 0, 0))


def test_passive_fill_holds_a_block_that_moves_into_it_only():
    """A wedge of 45 degrees that slides at mu: K_p gamma depth per area helps one way."""
    held = 2.0 * 1e3 * (1.5 - 0.5) * 1.0 * 1.0
    for sign, more in ((1.0, held / 10e3), (-1.0, 0.0)):
        model = wedge(sign)
        fill = passive_fill(model, 1.5, unit_weight=1e3, coefficient=2.0)
        result = lb.nonassociated(reinforced(model, *fill))
        assert result.load_factor == pytest.approx(0.2 + more, rel=1e-6)
    # the integral of (1.5 - z) z over that of 1.5 - z, 0 < z < 1, is the height of the resultant
    assert fill[0].interface.joint.strength == pytest.approx(2.0 * 1e3 * (1.5 - 5 / 12))


@pytest.mark.parametrize(("way", "held"), [(1, True), (-1, False)])
def test_fill_on_one_side_holds_a_wall_that_moves_into_it_alone(way, held):
    """alpha W = mu (W + E) + K_p gamma h^2 / 2 into the fill, and without the last off it."""
    mu, gamma, h, K, run = 0.3, 18e3, 2.0, 3.0, 0.5
    outline = [(-1, 0), (1, 0), (1 - run, h), (-1 + run, h)]
    stones = [
        lb.Block.box("ground", (8, 1, 0.4), (0, 0, -0.2)),
        lb.Block.prism("wall", outline, (0, 1), 20e3),
    ]
    side = {"beyond": (0, 0), "towards": (1, 0, 0)}
    bare = model_of(stones, ["ground"], lb.PointContact(mu))
    bare = replace(
        bare, dead=bare.dead + lb.loads.fill(gamma, h, **side), live=lb.mass_proportional((way, 0, 0))
    )
    given = {"unit_weight": gamma, "coefficient": K}
    model = reinforced(bare, *passive_fill(bare, h, **given, **side))
    W, E = bare.free_blocks[0].weight, gamma * run * h / 2
    expected = (mu * (W + E) + held * K * gamma * h**2 / 2) / W
    assert lb.bounds(model).lower == pytest.approx(expected, rel=1e-6)
    assert not [one for one in lb.diagnose(model).questions if "from the other side" in one]
    both = reinforced(bare, *passive_fill(bare, h, **given))
    assert [
        one for one in lb.diagnose(both).questions if "fill resists block 'wall' from the other side" in one
    ]


def test_eurocode_and_housner():
    """Top of a building in resonance: 5.5 alpha S; a block of 1 m x 4 m."""
    top = element_acceleration(0.2, 1.2, z=9.0, height=9.0, element_period=0.4, building_period=0.4)
    assert top == pytest.approx(0.2 * 1.2 * 5.5)
    low = element_acceleration(0.2, 1.2, z=0.0, height=9.0, element_period=9.0, building_period=0.4)
    assert low == pytest.approx(0.2 * 1.2)
    assert element_force(top, 1e3, q_a=2.0) == pytest.approx(660.0)
    assert element_force(top, 1e3, importance=1.5) == pytest.approx(990.0)
    block = Rocking(1.0, 4.0)
    R = np.sqrt(17.0) / 2
    assert np.tan(block.slenderness) == pytest.approx(0.25)
    assert block.frequency == pytest.approx(np.sqrt(3 * 9.81 / 4 / R))
    assert block.restitution == pytest.approx(1 - 1.5 / 17.0)
    assert block.period(0.5) == pytest.approx(4 / block.frequency * np.arccosh(2.0))
    assert block.period(0.0) == 0.0


def test_a_mass_far_off_its_block_is_refused():
    """In mm in place of m, it would lean on an arm a thousand times as long."""
    with pytest.raises(lb.ModelError, match=r"place .* is .* m off block 'wall', expected in or on it"):
        least_masses(wall(), [("wall", (-250.0, 0, 0.5))], 0.3)
