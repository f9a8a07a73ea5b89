"""The oracle against formulas, by itself and with the library where that is known to be good."""

from dataclasses import replace

import closed_forms
import draw
import judge
import kinds
import numpy as np
import pytest
import random_models
import shapes
from coulomb import Truth, truth

import limitblocks as lb
from limitblocks import structures

EXACT = 1e-12  # what the doubles of the geometry leave


def assert_load_factor(model, expected, rel=EXACT):
    known = truth(model)
    assert known.verdict == "number"
    assert known.load_factor == pytest.approx(expected, rel=rel)


def on_floor(boxes, joints, direction=(1, 0, 0)):
    """Model of boxes {name: (low, high, weight)} on a floor, joints {"i|j": joint}."""
    ends = {name: box[:2] for name, box in boxes.items()}
    ends = {**draw.floor_under(ends), **ends}
    interfaces = [replace(one, joint=joints[one.name]) for one in shapes.touching(ends, lambda: None)]
    blocks = [shapes.box(name, *box, boxes[name][2] if name in boxes else None) for name, box in ends.items()]
    return lb.Model(blocks, ["floor"], interfaces, lb.self_weight(), lb.mass_proportional(direction))


@pytest.mark.parametrize("friction", [1e-9, 1e-6, 0.3, 0.9, 1e8])
@pytest.mark.parametrize("direction", [(1, 0, 0), (1, 1, 0), (-0.3, 0.8, 0)])
def test_block_slides_or_rocks(friction, direction):
    width, height = 1.0, 2.0
    c, s = np.abs(direction)[:2] / np.hypot(*direction[:2])
    least = min(friction, width / height / max(c, s))
    model = structures.block(lb.PointContact(friction), width=width, height=height, direction=direction)
    assert_load_factor(model, least)


@pytest.mark.parametrize("sides", [3, 4, 5, 8])
@pytest.mark.parametrize("cone", ["inner", "outer"])
def test_block_slides_on_a_polygonal_cone(cone, sides):
    angle, mu = 0.2, 0.3
    model = structures.block(
        lb.PointContact(mu, cone=cone, sides=sides),
        width=1.0,
        height=0.5,
        direction=(-np.cos(angle), np.sin(angle), 0),
    )
    axes = model.interfaces[0].axes
    # block i is the base, on which the block presses along the load
    on_base = axes[:2] @ (-np.cos(angle), np.sin(angle), 0.0)
    step = 2 * np.pi / sides
    towards = np.arctan2(on_base[1], on_base[0]) - (step / 2 if cone == "inner" else 0.0)
    off = abs((towards + step / 2) % step - step / 2)  # from the nearest side of the polygon
    assert_load_factor(model, mu * (np.cos(step / 2) if cone == "inner" else 1.0) / np.cos(off))


@pytest.mark.parametrize("count", [1, 5])
@pytest.mark.parametrize("fraction", [0.2, 0.9])
def test_overhang(count, fraction):
    model = structures.overhang(lb.PointContact(0.7), count=count, length=1.0, height=0.3, fraction=fraction)
    assert_load_factor(model, min(0.7, (1 - fraction) / (0.3 * count)))


def test_overhang_beyond_balance_falls():
    joint = lb.PointContact(0.7)
    assert (
        truth(structures.overhang(joint, count=4, length=1.0, height=0.3, fraction=1.001)).verdict == "falls"
    )


@pytest.mark.parametrize("half_angle", [0.4, 0.8, 1.2])
@pytest.mark.parametrize("share", [0.01, 0.5, 0.9, 1.1])
def test_groove(half_angle, share):
    """A prism in a groove slides, or is wedged for good from mu = tan w on."""
    mu = share * np.tan(half_angle)
    parts = kinds.in_groove(Fixed(half_angle, mu))
    model = lb.Model(
        parts.blocks, parts.supports, parts.interfaces, lb.self_weight(), lb.mass_proportional((0, 1, 0))
    )
    expected = closed_forms.groove(mu, half_angle)
    if expected == np.inf:
        assert truth(model).verdict == "unlimited"
    else:
        assert_load_factor(model, expected)


class Fixed:
    """What `in_groove` draws, given."""

    def __init__(self, half_angle, friction):
        self.numbers = iter([half_angle, friction / np.tan(half_angle)])

    def uniform(self, *_):
        return next(self.numbers)

    def size(self):
        return 1.0

    def weight(self):
        return 1.0


@pytest.mark.parametrize("weights", [(1.0, 1.0, 1.0), (1e8, 1.0, 1e-8), (1e-8, 1e8, 1.0), (1.0, 1e-7, 1e7)])
@pytest.mark.parametrize("friction", [(0.2, 0.4, 0.7), (0.7, 0.3, 0.5), (0.1, 0.6, 0.3)])
def test_low_blocks_push_each_other(friction, weights):
    boxes = {f"b{k}": ((k, 0.0, 0.0), (k + 1.0, 1.0, 0.1), w) for k, w in enumerate(weights)}
    joints = {f"floor|b{k}": lb.PointContact(mu) for k, mu in enumerate(friction)}
    joints |= {f"b{k}|b{k + 1}": lb.PointContact(0.0) for k in range(2)}
    assert_load_factor(on_floor(boxes, joints), closed_forms.pushing(friction, weights))


@pytest.mark.parametrize("light", [1e-15, 1e-8, 1.0, 1e8])
def test_light_and_heavy_blocks_on_one_another_and_side_by_side(light):
    """Three of friction .5, .4 (on top of the first) and .3 (apart): each its own weight's share."""
    boxes = {
        "a": ((0, 0, 0), (1, 1, 0.5), 1.0),
        "b": ((0.4, 0.4, 0.5), (0.6, 0.6, 0.6), light),
        "c": ((5, 0, 0), (5.02, 0.02, 0.02), light),
    }
    joints = {"floor|a": 0.5, "a|b": 0.4, "floor|c": 0.3}
    for name, least in (("floor|c", 0.3), ("a|b", 0.4), ("floor|a", 0.5)):
        model = on_floor(boxes, {key: lb.PointContact(mu) for key, mu in joints.items()})
        assert_load_factor(model, least)
        joints[name] = 0.9


def test_lifted_pressed_and_jammed():
    model = structures.block(lb.PointContact(0.4), width=1.0, height=1.0)
    assert_load_factor(replace(model, live=lb.mass_proportional((0, 0, 1))), 1.0)
    assert truth(replace(model, live=lb.mass_proportional((0, 0, -1)))).verdict == "unlimited"


def test_a_load_on_one_of_two_blocks_leaves_the_other_to_stand_or_fall():
    joint = lb.PointContact(0.4)
    parts = draw.named("p ", parts_of(structures.block(joint, width=1.0, height=1.0)))
    for fraction, verdict in ((0.5, "number"), (1.1, "falls")):
        other = structures.overhang(joint, count=3, length=1.0, height=0.3, fraction=fraction)
        both = parts_of(other)
        model = lb.Model(
            parts.blocks + both.blocks,
            parts.supports + both.supports,
            parts.interfaces + both.interfaces,
            lb.self_weight(),
            lb.loads.force("p block 1", (1.0, 0, 0), at=(0.5, 0, 0.1)),
        )
        known = truth(model)
        assert known.verdict == verdict
        if verdict == "number":
            assert known.load_factor == pytest.approx(0.4 * model.free_blocks[0].weight, rel=EXACT)


def parts_of(model):
    return draw.Parts(list(model.blocks), list(model.supports), list(model.interfaces))


@pytest.mark.parametrize("start", range(0, 200, 50))
def test_random_forests_spires_slopes_and_grooves(start):
    cases = [random_models.case(seed) for seed in range(start, start + 50)]
    cases = [case for case in cases if case.known is not None and case.kind != "paper"]
    assert len(cases) > 10
    for case in cases[:8]:
        known = truth(case.model)
        assert known.verdict == case.known.verdict, case
        if known.verdict == "number":
            assert known.load_factor == pytest.approx(case.known.load_factor, rel=1e-10), case


@pytest.mark.parametrize(
    "model",
    [
        structures.arch(lb.PointContact(0.7), radius=1.0, thickness=0.2, voussoirs=7),
        structures.block(lb.PointContact(0.7), width=1.0, height=3.0, direction=(1, 0.7, 0)),
    ],
    ids=["arch", "block"],
)
def test_library_agrees_where_blocks_are_alike(model):
    assert judge.judged(model, truth(model)).outcome == "right"


def test_a_wrong_answer_is_found():
    model = structures.block(lb.PointContact(0.3), width=1.0, height=0.5)
    for expected, outcome in (
        (Truth("number", 0.3), "right"),
        (Truth("number", 0.3 / (1 + 2e-6)), "lower too high"),
        (Truth("number", 0.3 * (1 + 2e-6)), "upper too low"),
        (Truth("falls"), "number for falls"),
        (Truth("unlimited", np.inf), "number for unlimited"),
        (Truth("undecided"), "undecided"),
    ):
        assert judge.judged(model, expected).outcome == outcome


def test_cases_depend_on_their_seed_alone():
    first, again, other = (random_models.case(seed).model.digest for seed in (3, 3, 4))
    assert first == again != other


def test_every_kind_is_drawn_and_contacts_are_whole():
    drawn = set()
    for seed in range(80):
        case = random_models.case(seed)
        drawn.add(case.kind.split()[0])
        for one in case.model.interfaces:
            assert np.allclose(one.axes @ one.axes.T, np.eye(3), atol=1e-12)
            assert np.linalg.det(one.axes) == pytest.approx(1.0)
            x, y = one.polygon.T
            assert (x * np.roll(y, -1) - y * np.roll(x, -1)).sum() > 0.0
    assert drawn == set(kinds.KINDS)
