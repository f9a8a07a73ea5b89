"""Added masses, directions and the tilting plane."""

from dataclasses import replace

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.mechanics.loads import turned
from limitblocks.mechanics.loads.load import resultant

W, B, H = 40e3, 1.0, 2.0  # one block of 20 kN/m3


def block(joint, dead, live, depth=1.0):
    blocks = [
        lb.Block.box("ground", (4, 4, 0.2), (0, 0, -0.1)),
        lb.Block.box("block", (B, depth, H), (0, 0, H / 2), W / (B * depth * H)),
    ]
    return lb.Model(blocks, ["ground"], lb.find_interfaces(blocks, joint), dead, live)


@pytest.mark.parametrize("height", [2.0, 3.5])
@pytest.mark.parametrize("added", [5e3, 80e3])
def test_added_mass_counts_in_dead_and_in_live_load(added, height):
    """Rocking: (W + P) b / 2 over W h / 2 + P z."""
    mass = lb.loads.added_mass("block", at=(0, 0, height), weight=added)
    model = block(lb.PointContact(5.0), lb.self_weight([mass]), lb.mass_proportional((1, 0, 0), [mass]))
    formula = (W + added) * B / 2 / (W * H / 2 + added * height)
    assert lb.bounds(model).lower == pytest.approx(formula, rel=1e-6)


def test_added_mass_does_not_change_sliding():
    mass = lb.loads.added_mass("block", at=(0, 0, 1), mass=3e3)
    model = block(lb.PointContact(0.2), lb.self_weight([mass]), lb.mass_proportional((1, 0, 0), [mass]))
    assert lb.bounds(model).lower == pytest.approx(0.2, rel=1e-6)


def test_mass_and_weight_are_one():
    by_mass = lb.loads.added_mass("block", (0, 0, 1), mass=1e3)
    assert by_mass == lb.loads.added_mass("block", (0, 0, 1), weight=9806.65)


def test_load_of_masses_is_their_weight_at_their_place():
    mass = lb.loads.added_mass("block", (0.5, 0.2, 3), weight=7e3)
    blocks = [lb.Block.box("block", (1, 1, 2), (0, 0, 1), 20e3)]
    for direction in ((0, 0, -1), (3, 4, 0)):
        unit = np.array(direction) / np.linalg.norm(direction)
        load = lb.mass_proportional(direction, [mass])
        expected = lb.mass_proportional(direction) + lb.loads.force("block", 7e3 * unit, (0.5, 0.2, 3))
        assert load.on(blocks) == pytest.approx(expected.on(blocks))


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({}, "either weight in N or mass in kg"),
        ({"weight": 1.0, "mass": 1.0}, "either"),
        ({"weight": -1.0}, "weight is -1.0"),
        ({"mass": 0.0}, "mass is 0.0"),
        ({"mass": np.nan}, "mass is nan"),
    ],
)
def test_wrong_mass_is_refused(arguments, said):
    with pytest.raises(lb.ModelError, match=said):
        lb.loads.added_mass("block", (0, 0, 1), **arguments)


def test_mass_on_an_unknown_block_is_refused_by_the_model():
    mass = lb.loads.added_mass("roof", (0, 0, 1), weight=1.0)
    with pytest.raises(lb.ModelError, match="'roof'"):
        block(lb.PointContact(0.5), lb.self_weight([mass]), lb.mass_proportional((1, 0, 0)))


@pytest.mark.parametrize("friction", [0.2, 0.9])
@pytest.mark.parametrize("analysis", [lb.bounds, lb.nonassociated])
def test_tangent_of_the_tilting_angle_is_friction_or_slenderness(friction, analysis):
    tilt = lb.loads.tilting((2.0, 0.0, 0.0))
    result = analysis(block(lb.PointContact(friction), tilt.dead, tilt.live))
    load_factor = result.lower if analysis is lb.bounds else result.load_factor
    assert np.tan(tilt.angle(load_factor)) == pytest.approx(min(friction, B / H), rel=1e-5)


def test_loads_at_the_tilting_angle_are_at_the_limit():
    tilt = lb.loads.tilting((1, 0, 0))
    angle = np.arctan(B / H)
    for factor, stands in ((0.999, True), (1.001, False)):
        model = block(lb.PointContact(0.9), tilt.at(factor * angle), tilt.live)
        if stands:
            assert lb.bounds(model).lower > 0.0
        else:
            with pytest.raises(lb.errors.NoEquilibrium):
                lb.bounds(model)


@pytest.mark.parametrize("angle", [0.3, -0.3])
def test_a_weight_on_a_plane_that_tilts(angle):
    """W sin t down the plane and W cos t across it."""
    own = lb.Block.box("block", (B, 1, H), (0, 0, H / 2), W / (B * H))
    (load,) = lb.loads.tilting((1, 0, 0)).at(angle).on([own])
    assert load[:3] == pytest.approx(W * np.array([np.sin(angle), 0.0, -np.cos(angle)]))
    assert (3 * (2 * lb.self_weight())).on([own])[0, 2] == pytest.approx(-6 * W)


def test_a_tilting_angle_in_degrees_is_refused():
    tilt = lb.loads.tilting((1, 0, 0))
    with pytest.raises(lb.ModelError, match=r"angle is 30, expected rad .* math\.radians\(30\)"):
        tilt.at(30)
    assert len(tilt.at(np.pi / 2).terms) == 2


def test_a_horizontal_direction_may_rise_by_rounding():
    turned = lb.loads.tilting((3.0, 4.0, 1e-16)).at(0.3)
    assert turned == lb.loads.tilting((3.0, 4.0, 0.0)).at(0.3)


@pytest.mark.parametrize("direction", [(1, 0, 0.1), (0, 0, 0), (0, 0, 1)])
def test_tilting_towards_no_horizontal_direction_is_refused(direction):
    with pytest.raises(lb.ModelError, match="direction"):
        lb.loads.tilting(direction)


def test_compass_points():
    assert lb.loads.compass(1).tolist() == [[1, 0, 0]]
    assert lb.loads.compass(4).tolist() == [[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]]
    directions = lb.loads.compass(16, vertical=True)
    assert np.linalg.norm(directions, axis=1) == pytest.approx(1.0)
    assert directions[:16].sum(axis=0) == pytest.approx(0.0, abs=1e-12)
    assert directions[16:].tolist() == [[0, 0, 1], [0, 0, -1]]
    with pytest.raises(lb.ModelError, match="count"):
        lb.loads.compass(0)


def test_a_list_of_loads_has_a_sum():
    one, two = lb.self_weight(), lb.loads.moment("block", (1.0, 0.0, 0.0))
    assert sum([one, two]) == one + two
    with pytest.raises(lb.ModelError, match="1 cannot be added to a load"):
        sum([one, two], 1)


def test_forces_that_cancel_but_for_rounding_have_no_resultant():
    """.1 + .2 - .3 of a push: what rounding leaves would be the direction of a capacity curve."""
    blocks = [block(lb.PointContact(0.6), lb.self_weight(), lb.mass_proportional((1, 0, 0))).blocks[1]]
    push = lb.loads.force("block", (1.0, 0.0, 0.0), (0.0, 0.0, 1.0))
    none = 0.1 * push + 0.2 * push - 0.3 * push
    assert none.on(blocks)[:, :3].any()
    assert not resultant(none, blocks).any()
    assert resultant(none + push, blocks)[0] == pytest.approx(1.0)


def test_a_load_is_negated_subtracted_and_divided():
    push, weight = lb.mass_proportional((1, 0, 0)), lb.self_weight()
    assert -push == -1.0 * push
    assert weight - push == weight + -1.0 * push
    assert push / 2 == 0.5 * push
    assert (3 * push) / 3 == push
    with pytest.raises(lb.ModelError, match="divisor of a load is 0, expected any other number"):
        push / 0
    with pytest.raises(lb.ModelError, match="divisor of a load is 'two', expected a finite number"):
        push / "two"
    with pytest.raises(lb.ModelError, match="1 cannot be added to a load"):
        push - 1
    with pytest.raises(TypeError, match="unsupported operand"):
        2 / push


def test_turned_load_keeps_factors_and_masses():
    mass = lb.loads.added_mass("block", (0, 0, 3), weight=1e3)
    load = 0.3 * lb.mass_proportional((1, 0, 0), [mass])
    assert turned(load, (0, 2, 0)) == 0.3 * lb.mass_proportional((0, 1, 0), [mass])
    with pytest.raises(lb.ModelError, match="PointForce"):
        turned(load + lb.loads.force("block", (1, 0, 0), (0, 0, 0)), (0, 1, 0))


def test_a_turned_load_acts_along_the_new_direction_whatever_its_sign():
    push = lb.mass_proportional((1, 0, 0))
    assert turned(-0.3 * push + -0.1 * push, (0, 2, 0)).terms == tuple(
        (factor, lb.mass_proportional((0, 1, 0)).terms[0][1]) for factor in (0.3, 0.1)
    )
    for other in (0.3 * lb.self_weight(), -0.3 * push):  # 1 - 0.3 along the new direction would be unsafe
        with pytest.raises(lb.ModelError, match=r"acts along \(.*\) and \(1, 0, 0\), expected one direction"):
            turned(push + other, (0, 1, 0))


def test_load_on_a_block_turned_with_it():
    """Forces, moments and masses of a moved structure are those of the old one, moved."""
    turn = np.array([[0.0, -1.0, 0.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]])
    shift = np.array([3.0, -1.0, 2.0])
    old = lb.Block.box("block", (1, 2, 3), (0.2, 0.3, 0.4), 20e3)
    at, push = np.array([0.7, 1.3, 0.4]), np.array([1.0, 2.0, 3.0])
    mass = lb.loads.added_mass("block", at, weight=5e3)

    def moved(point):
        return turn @ point + shift

    for before, after in (
        (lb.loads.force("block", push, at), lb.loads.force("block", turn @ push, moved(at))),
        (
            lb.mass_proportional(push, [mass]),
            lb.mass_proportional(turn @ push, [replace(mass, at=tuple(moved(at)))]),
        ),
        (
            lb.loads.pressure("block", 2e3, facing=(1, 0, 0)),
            lb.loads.pressure("block", 2e3, facing=turn @ (1, 0, 0)),
        ),
    ):
        expected = before.on([old]).reshape(2, 3) @ turn.T
        assert after.on([old.moved(turn, shift)]).reshape(2, 3) == pytest.approx(expected, abs=1e-6)


def test_masses_tilt_with_their_block():
    """As heavy as the block, on its top: it overturns where (W + W) b / 2 = tan (W h / 2 + W h)."""
    model = lb.structures.block(lb.PointContact(0.9), width=0.6, height=1.0, depth=1.0)
    block = model.free_blocks[0]
    mass = lb.loads.added_mass(block.name, (block.centroid[0], 0, 1.0), weight=block.weight)
    tilt = lb.loads.tilting((1.0, 0.0, 0.0), [mass])
    bounds = lb.bounds(replace(model, dead=tilt.dead, live=tilt.live))
    assert bounds.lower == pytest.approx(0.6 / 1.5, rel=1e-6)
