"""Bounds proven where no stresses or no mechanism is strictly admissible: what carries or moves nothing."""

from dataclasses import replace

import numpy as np
import pytest
from stones import model_of

import limitblocks as lb
from limitblocks import structures
from limitblocks.analysis.interior import _without_room, carried
from limitblocks.analysis.repair import Repair
from limitblocks.analysis.scales import scaled
from limitblocks.analysis.splitting import Splitting
from limitblocks.evidence.proof import proof_of
from limitblocks.problem import State

CLOSE = 1e-8  # relative width promised where an interior exists
WEIGHT, FRICTION = 1e4, 0.3  # of the stone that slides, N
box = lb.Block.box
CRUSHING = lb.OrdunaLourenco(0.6, compressive_strength=1e8)  # its rows have constants
JOINTS = [lb.PointContact(0.6), lb.OrdunaLourenco(0.6), CRUSHING]


def framed(joint_of, *more):
    """A stone of 1 m between two walls, on a floor, other stones, and the joint that each support has."""
    frame = [box("floor", (3, 1, 0.3), (0, 0, -0.15))]
    frame += [box(name, (1, 1, 1), (x, 0, 0.5)) for name, x in (("left", -1), ("right", 1))]
    stones = [*frame, box("stone", (1, 1, 1), (0, 0, 0.5), WEIGHT), *more]
    joints = {frozenset((name, "stone")): joint for name, joint in joint_of.items()}
    found = lb.find_interfaces(stones, lb.PointContact(FRICTION))
    contacts = [one for one in found if not {one.block_i, one.block_j} <= {"floor", "left", "right"}]
    contacts = [replace(i, joint=joints.get(frozenset((i.block_i, i.block_j)), i.joint)) for i in contacts]
    return stones, contacts


def slider_on_a_wedged_stone():
    """The lower stone cannot move: sliding asks for dilatancy, for which the walls leave no room."""
    rough = lb.PointContact(0.6)
    stones, contacts = framed(
        {"left": rough, "right": rough, "floor": rough}, box("slider", (0.5, 0.5, 0.2), (0, 0, 1.1), WEIGHT)
    )
    supports, push = ["floor", "left", "right"], lb.mass_proportional((0, 1, 0))
    return lb.Model(stones, supports, contacts, lb.self_weight(), push)


def light_stones(joint):
    """A stone of no weight on two others that slide at their friction, .6, and one more leaning beside."""
    stones = [box("ground", (6, 4, 0.3), (0, 0, -0.15)), box("light", (0.8, 0.8, 0.5), (0.5, 0, 0.75), 0.0)]
    stones += [box(f"stone {x}", (1, 1, 0.5), (x, 0, 0.25), WEIGHT / 0.5) for x in (0, 1)]
    stones.append(box("beside", (0.5, 0.5, 0.5), (1.75, 0, 0.25), 0.0))
    return model_of(stones, ["ground"], joint)


def proof_with(model, found, **changes):
    """The proof of bounds with one array of its state changed, as whoever checks them makes it."""
    given = {
        "load_factor": found.lower,
        "x": found.generalised_stresses,
        "u": found.displacement_rates[-len(model.free_blocks) :].ravel(),  # supports come first
        "y": found.flow_multipliers,
    }
    return proof_of(model.problem, State(**(given | changes)), found.dead_load_stresses)


@pytest.mark.parametrize("joint", JOINTS)
def test_stones_of_no_weight_leave_the_bounds_proven(joint):
    found = lb.bounds(light_stones(joint))
    assert found.proof.width < CLOSE
    assert found.lower <= 0.6 * (1 + 1e-14)
    assert found.upper >= 0.6 * (1 - 1e-14)


def test_a_force_on_a_stone_of_no_weight_is_no_proof():
    """What its joints carry cannot be balanced by anything else, be it the least."""
    model = light_stones(lb.PointContact(0.6))
    found, problem = lb.bounds(model), model.problem
    light = [k for k, name in enumerate(problem.interfaces) if "light" in name]
    assert not found.generalised_stresses[np.isin(problem.stress_interface, light)].any()
    x = found.generalised_stresses.copy()
    x[np.isin(problem.stress_interface, light)] = -1e-9 * WEIGHT
    assert proof_with(model, found).complete
    assert proof_with(model, found, x=x).static


def test_stones_that_are_wedged_leave_the_bounds_proven():
    found = lb.bounds(slider_on_a_wedged_stone())
    assert found.proof.width < CLOSE
    assert found.lower <= FRICTION * (1 + 1e-14)
    assert found.upper >= FRICTION * (1 - 1e-14)


def test_a_wedged_stone_that_moves_is_no_proof():
    model = slider_on_a_wedged_stone()
    found, wedged = lb.bounds(model), 6 * list(model.problem.blocks).index("stone")
    u = found.displacement_rates[-len(model.free_blocks) :].ravel().copy()
    assert proof_with(model, found).complete
    assert not u[wedged : wedged + 6].any()
    u[wedged] = 1e-9 * np.abs(u).max()
    assert proof_with(model, found, u=u).kinematic


def test_mechanisms_that_crush_strong_joints_are_found():
    """The stone, on ice, is pressed into one wall until the whole face crushes, at fc A (Eq. 39)."""
    strength = 1e7
    stones, contacts = framed(
        {
            "left": lb.OrdunaLourenco(0.8, compressive_strength=strength),
            "right": lb.PointContact(0.6),
            "floor": lb.PointContact(0.0),
        }
    )
    push = lb.mass_proportional((-1, 0, 0))
    model = lb.Model(stones, ["floor", "left", "right"], contacts, lb.self_weight(), push)
    assert Splitting(scaled(model.problem)).mechanism(model.problem.cones.identity) is None
    found = lb.bounds(model)
    assert found.proof.width < CLOSE
    assert found.lower == pytest.approx(strength * 1.0 / WEIGHT, rel=CLOSE)


def test_joints_between_wedged_stones_alone_are_left_closed():
    """The slider's joint opens, those of the stone below do not."""
    problem = slider_on_a_wedged_stone().problem
    repair = Repair(Splitting(scaled(problem)), np.ones(problem.C.shape[0], dtype=bool))
    u, y = repair.opened(problem.cones.identity)
    opened = problem.cones.margin(y) > 0.0
    slider = np.array(["slider" in problem.interfaces[k] for k in problem.member_interface])
    assert np.array_equal(opened, slider)
    assert np.abs(problem.C @ u + problem.F.T @ y).max() < 1e-14 * np.abs(u).max()


def test_why_there_is_no_lower_bound_is_said():
    """On ice only normal forces balance; a stack at its largest overhang stands on edges of its stones."""
    ice = structures.block(lb.PointContact(0.0), width=0.5, height=1.0)
    stack = structures.overhang(lb.PointContact(0.6), count=3, length=1.0, height=0.2)
    no_shear = (
        "base|block 1, such as a joint without friction, does not carry all that rounding leaves at block 1"
    )
    for model, said in (
        (ice, no_shear),
        (stack, "where the stresses under the dead loads are at yield, too"),
    ):
        assert lb.bounds(model).proof.static.endswith(said)


def test_stones_of_no_weight_do_not_hide_that_a_load_is_unlimited():
    """A stone pressed onto the ground; what leans on each other elsewhere carries none of it."""
    stones = [box("floor", (6, 4, 0.3), (0, 0, -0.15)), box("stone", (1, 1, 1), (-1, 0, 0.5), WEIGHT)]
    stones += [
        box("light", (0.6, 1, 0.5), (1, 0, 0.25), 0.0),
        box("tall", (0.7, 0.4, 1), (1.65, 0.1, 0.5), 0.0),
    ]
    stones.append(box("last", (0.5, 1, 0.3), (2.25, 0.2, 0.15), WEIGHT))
    found = lb.find_interfaces(stones, lb.OrdunaLourenco(0.6))
    rough = lb.PointContact(0.6)
    found = [replace(one, joint=rough) if "light" in (one.block_i, one.block_j) else one for one in found]
    down = lb.loads.force("stone", (0, 0, -WEIGHT), (-1.2, 0.1, 1))
    with pytest.raises(lb.errors.UnlimitedLoad):
        lb.bounds(lb.Model(stones, ["floor"], found, lb.self_weight(), down))


def test_stones_of_no_weight_apart_from_all_loads_change_nothing():
    """Nothing at all acts there, by which anything could be measured."""
    stones = [box("floor", (6, 4, 0.3), (0, 0, -0.15)), box("stone", (1, 1, 0.5), (-1, 0, 0.25), WEIGHT)]
    stones += [box(f"light {k}", (0.6, 0.6, 0.5), (1, 0, 0.25 + 0.5 * k), 0.0) for k in range(2)]
    model = model_of(stones, ["floor"], lb.PointContact(0.6))
    assert lb.nonassociated(model).load_factor == pytest.approx(0.6, rel=CLOSE)


def test_what_rounding_leaves_is_no_room():
    """Points that bear 1e-20 of a weight are within Coulomb's cone by .6 of that, which means nothing."""
    problem = light_stones(lb.PointContact(0.6)).problem
    x = carried(problem)
    light = np.array(["light" in name for name in problem.interfaces])
    assert np.array_equal(
        _without_room(problem, x), light | ["beside" in name for name in problem.interfaces]
    )
    faint = np.where(x == 0.0, np.tile([0.0, 0.0, -1e-20], len(x) // 3), x)
    assert np.array_equal(_without_room(problem, faint), _without_room(problem, x))
