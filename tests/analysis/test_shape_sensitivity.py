"""Derivatives by the shape of structures with ties, fill, and joints whose yield planes move."""

from dataclasses import replace

import numpy as np
import pytest
from facades import OWN, H, T, wall_stones
from stones import model_of

import limitblocks as lb
from limitblocks import structures
from limitblocks.analysis.shape import moved
from limitblocks.errors import ModelError
from limitblocks.joints import ExactTorsion
from limitblocks.practice import passive_fill, reinforced, strip, tie
from limitblocks.studies import shape_sensitivity

WIDTH, HEIGHT, MU = 1.0, 2.0, 0.7


def block(joint, **sizes):
    return structures.block(joint, **({"width": WIDTH, "height": HEIGHT} | sizes))


def differences(build, value, step):
    """Central difference of the load factor of models solved again."""
    ahead, back = (lb.bounds(build(value + t * step)).lower for t in (1.0, -1.0))
    return (ahead - back) / (2.0 * step)


def test_shape_moves_ties_with_their_anchors_and_keeps_their_sections():
    """Facade b x h of weight W, held at z: a = (W b / 2 + F z cos) / (W h / 2), about the toe."""
    b, h, z, W, F, away = T, H, 4.5, OWN, 8e3, 5.75
    wall = model_of(wall_stones(), ["ground"], lb.PointContact(0.6))
    rod = tie("wall", (-b / 2, 0, z), "ground", (-b / 2 - away, 0, z), area=1e-4, strength=1e9, pull_out=F)
    tied = reinforced(wall, rod)
    bounds = lb.bounds(tied)
    held = F * z / (W * h / 2)
    assert bounds.lower == pytest.approx(b / h + held)
    higher = shape_sensitivity(tied, bounds, lambda r: r * [0, 0, 1])  # W, h and z grow as one
    assert higher == pytest.approx(-bounds.lower, rel=1e-6)
    deeper = shape_sensitivity(tied, bounds, lambda r: r * [0, 1, 0])  # W alone
    assert deeper == pytest.approx(-held, rel=1e-6)
    # the far anchor rises by t: the rod, away long, pulls up by t / away of its force, b before the toe
    anchor = shape_sensitivity(tied, bounds, lambda r: (r[:, :1] < -3) * np.array([0, 0, 1.0]))
    assert anchor == pytest.approx(-F * b / away / (W * h / 2), rel=1e-6)
    bonded = reinforced(wall, strip(wall.interfaces[0], (-b / 2, 0, 0), width=0.1, capacity=F))
    deeper = shape_sensitivity(bonded, lb.bounds(bonded), lambda r: r * [0, 1, 0])
    assert deeper == pytest.approx(-F * b / (W * h / 2), rel=1e-6)


def test_shape_of_ties_that_were_alike_and_are_no_more():
    """Two rods, one anchor rises: one grows longer than the other, and joints come in another order."""
    b, h, W, F, away = T, H, OWN, 4e3, 5.75
    wall = model_of(wall_stones(), ["ground"], lb.PointContact(0.6))
    rods = [
        tie("wall", (-b / 2, y, 4.5), "ground", (-b / 2 - away, y, 4.5), area=1e-4, strength=1e9, pull_out=F)
        for y in (-0.3, 0.3)
    ]
    tied = reinforced(wall, *rods)
    one, other = (k for k in tied.interfaces if k not in wall.interfaces)
    between = replace(tied, interfaces=[one, *wall.interfaces, other])
    anchor = shape_sensitivity(
        between, lb.bounds(between), lambda r: ((r[:, :1] < -3) & (r[:, 1:2] > 0)) * np.array([0, 0, 1.0])
    )
    assert anchor == pytest.approx(-F * b / away / (W * h / 2), rel=1e-6)


STRETCH = np.diag([1.0, 0.0, 0.0])
SKEW = np.array([[0.0, 0, 0], [1, 0, 0], [0, 0, 0]])  # x grows with y
TURN = np.array([[0.0, 1, 0], [-1, 0, 0], [0, 0, 0]])


def twisted(side, push=(0.6, 0.3), bent=0.0):
    """A flat stone on a joint of planes that come in the order of a convex hull, pushed, twisted and bent."""
    stones = [
        lb.Block.box("ground", (3, 3, 0.2), (0, 0, -0.1)),
        lb.Block.box("stone", (1.3, 0.8, 0.4), (0, 0, 0.2), 20e3),
    ]
    W = stones[1].weight
    live = lb.loads.moment("stone", (bent * W, 0, W))
    live += lb.loads.force("stone", (push[0] * W, push[1] * W, 0), (0, 0, 0))
    found = lb.find_interfaces(stones, ExactTorsion(0.6, side=side))
    return lb.Model(stones, ["ground"], found, lb.self_weight(), live)


@pytest.mark.parametrize("side", ["inner", "outer"])
@pytest.mark.parametrize("by", [STRETCH, SKEW, TURN], ids=["stretch", "skew", "turn"])
def test_shape_of_joints_whose_planes_come_in_any_order_and_number(side, by):
    model = twisted(side)
    found = shape_sensitivity(model, lb.bounds(model), lambda r: r @ by)
    assert found == pytest.approx(
        differences(lambda t: moved(model, lambda r: r @ by, t), 0.0, 1e-4), abs=1e-6
    )


@pytest.mark.parametrize(
    ("side", "push", "bent"), [("inner", (0, 0), 1.0), ("outer", (0, 0), 1.0), ("inner", (0.6, 0.3), 0.3)]
)
def test_a_yield_set_that_jumps_has_no_derivative_by_shape(side, push, bent):
    """Bent and twisted: torsion of a rectangle has planes of its own, those of a skewed one are others.

    The pushed stone slides by planes that stay: it is its stresses that are outside the skewed ones.
    """
    model = twisted(side, push, bent)
    bounds = lb.bounds(model)
    beside = [lb.bounds(moved(model, lambda r: r @ SKEW, t)).lower for t in (1e-6, -1e-6)]
    assert beside[0] == pytest.approx(beside[1], rel=1e-4)
    assert abs(beside[0] / bounds.lower - 1.0) > 0.01
    with pytest.raises(
        ModelError, match=r"ground\|stone: the yield set of ExactTorsion.* jumps .* compare bounds"
    ):
        shape_sensitivity(model, bounds, lambda r: r @ SKEW)


@pytest.mark.parametrize(
    ("field", "said"),
    [
        (lambda r: r[:, 2:3], r"field gives shape \(8, 1\) for points \(8, 3\), expected finite numbers"),
        (lambda r: r[:, :2], r"field gives shape \(8, 2\)"),
        (lambda r: r * np.nan, "expected finite numbers of that shape"),
        (lambda r: None, "field gives None"),
        (None, "field is None, expected a function"),
    ],
)
def test_a_field_displaces_each_point(field, said):
    model = block(lb.PointContact(MU))
    with pytest.raises(ModelError, match=said):
        shape_sensitivity(model, lb.bounds(model), field)


def test_a_moved_tie_is_as_long_as_its_anchors_are_apart_and_fill_pushes_along_the_deck_still():
    ring = structures.arch(lb.PointContact(0.6), radius=2.0, thickness=0.4, voussoirs=9)
    block = ring.free_blocks[-1]
    x, y, z = block.centroid
    rod = tie(
        block.name, (x, y, z), min(ring.supports), (x + 3, y, z - 4), area=1e-4, strength=1e9, pull_out=1e3
    )
    fill = passive_fill(ring, 3.0, unit_weight=1e4, coefficient=2.0)
    held = reinforced(ring, rod, *fill)
    lean = moved(held, lambda r: np.array([1.0, 0, 0]) * r[:, 2:], 0.5)  # X + Z / 2
    (length,) = (one.joint.length for one in lean.interfaces if getattr(one.joint, "length", 0.0))
    assert length == pytest.approx(np.hypot(3 - 2, 4))
    axes = [[one.axes for one in each.interfaces[-len(fill) :]] for each in (held, lean)]
    np.testing.assert_array_equal(*axes)
