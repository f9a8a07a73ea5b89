import dataclasses

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.evidence.interface_states import LOADED, interface_states
from limitblocks.evidence.utilisation import utilisation

CORNER = {"length": 1.6, "return_length": 1.2, "courses": 3}
JOINTS = [lb.OrdunaLourenco, lb.PointContact, lb.joints.ExactTorsion]
GROUND = lb.Block.box("ground", size=(6, 6, 1), at=(0, 0, -0.5))


def stone(name="stone", size=(1.0, 1.0, 1.0), at=(0.0, 0.0, 0.5)):
    return lb.Block.box(name, size=size, at=at, unit_weight=20e3)


def model_of(blocks, joint, live, supports=("ground",)):
    return lb.Model(blocks, supports, lb.find_interfaces(blocks, joint), lb.self_weight(), live)


def states_of(blocks, joint, live, analysis=lb.bounds):
    model = model_of(blocks, joint, live)
    result = analysis(model)
    return interface_states(model, result), result


def kinds_of(modes):
    """What the modes of an interface do: slide, or lift one side."""
    return {"slides" if mode.slides else "opens" if mode.opens else mode for mode in modes}


@pytest.mark.parametrize("joint", JOINTS)
@pytest.mark.parametrize("analysis", [lb.bounds, lb.nonassociated, lb.load_path])
def test_slender_block_rocks_about_its_toe(joint, analysis):
    block = stone(size=(0.5, 1.0, 2.0), at=(0, 0, 1))
    push = lb.mass_proportional((1, 0, 0))
    found, _ = states_of([GROUND, block], joint(friction=0.6), push, analysis)
    assert found.state == ("hinge",)
    assert kinds_of(found.active_modes[0]) == {"opens"}
    assert np.allclose(found.centre_of_pressure, [[0.25, 0, 0]], atol=1e-5)
    assert np.isclose(found.utilisation[0], 1.0, atol=1e-5)
    # block j is the stone: W 0.25 / 1.0 along -X from the ground, W along Z
    assert np.allclose(found.force[0] / block.weight, [-0.25, 0.0, 1.0], atol=1e-5)
    # unit work of W at the height 1 m turns it by 1 / W about Y; the middle of the base lifts 0.25 / W
    rates = np.abs(found.strain_rates[0]) * block.weight
    assert np.allclose(np.sort(rates), [0, 0, 0, 0, 0.25, 1.0], atol=1e-4)
    assert found.strain_rates[0, 2] > 0.0


@pytest.mark.parametrize("joint", JOINTS)
@pytest.mark.parametrize("analysis", [lb.bounds, lb.nonassociated])
def test_low_block_slides_with_its_weight_off_the_middle(joint, analysis):
    block = stone(size=(2.0, 1.0, 0.5), at=(0, 0, 0.25))
    found, _ = states_of([GROUND, block], joint(friction=0.5), lb.mass_proportional((1, 0, 0)), analysis)
    # at a corner of a polytope of the limit surface the mechanism is not unique: it may twist, too
    assert found.state == ("slide",) or (joint is lb.joints.ExactTorsion and found.state == ("slide-twist",))
    assert joint is lb.joints.ExactTorsion or kinds_of(found.active_modes[0]) == {"slides"}
    assert np.allclose(found.centre_of_pressure, [[0.5 * 0.25, 0, 0]], atol=1e-5)  # mu h / 2
    assert np.isclose(found.utilisation[0], 1.0, atol=1e-5)
    lift = 0.5 if analysis is lb.bounds else 0.0  # associated sliding lifts by mu
    assert np.isclose(found.strain_rates[0, 2] * block.weight, lift, atol=1e-4)


def test_a_twist_that_is_just_seen_has_its_mode():
    """At a corner 1.2e-3 of the fastest block, by a multiplier of .65e-3 of it; one that sticks has none."""
    blocks = [GROUND, stone("fast", at=(-1, 0, 0.5)), stone("twists", at=(1, 0, 0.5))]
    model = model_of(blocks, lb.OrdunaLourenco(0.5), lb.mass_proportional((1, 0, 0)))
    found, problem = lb.nonassociated(model), model.problem
    y, rates = np.zeros(len(problem.g)), np.zeros((3, 6))
    rates[1, 0], rates[2, 5] = 1.0, 1.2e-3 / np.sqrt(0.5)
    k = [interface.name for interface in model.interfaces].index("ground|twists")
    own = [row for row in np.flatnonzero(problem.row_interface == k) if problem.row_mode[row] == "slip-twist"]
    y[own[0]] = 0.65e-3
    claimed = dataclasses.replace(found, displacement_rates=rates, flow_multipliers=y)
    states = interface_states(model, claimed)
    assert states.state[k] == "twist"
    assert states.active_modes[k] == ("slip-twist",)
    still = dataclasses.replace(claimed, displacement_rates=np.zeros((3, 6)) + rates * [[0], [1], [0]])
    assert interface_states(model, still).active_modes[k] == ()


@pytest.mark.parametrize("joint", JOINTS)
def test_unmoved_joint_below_a_sliding_block_uses_half_its_friction(joint):
    blocks = [GROUND, stone("low", (3, 3, 0.2), (0, 0, 0.1)), stone("top", (3, 3, 0.2), (0, 0, 0.3))]
    push = lb.loads.force("top", (blocks[2].weight, 0, 0), at=(0, 0, 0.3))
    found, _ = states_of(blocks, joint(friction=0.5), push)
    states = dict(zip(found.names, found.state, strict=True))
    used = dict(zip(found.names, found.utilisation, strict=True))
    assert states == {"ground|low": "stick", "low|top": "slide"}
    assert np.isclose(used["ground|low"], 0.5, atol=1e-4)  # mu W / (mu 2 W)
    assert found.active_modes[found.names.index("ground|low")] == ()
    slip = ("slip-twist",) if joint is lb.joints.ExactTorsion else ("slip",)  # rows of the limit surface
    assert found.active_modes[found.names.index("low|top")] == slip


@pytest.mark.parametrize("joint", JOINTS)
def test_torque_twists(joint):
    found, _ = states_of([GROUND, stone()], joint(friction=0.5), lb.loads.moment("stone", (0, 0, 1)))
    assert found.state == ("twist",)
    assert np.isclose(abs(found.strain_rates[0, 5]), 1.0, rtol=1e-5)  # unit work of a unit moment


def test_a_bond_that_a_moment_alone_breaks_is_used_up():
    """Without a force, on a unit square: c A c_T in torsion, ft A l1 in bending by Eq. (36)."""
    joint = lb.OrdunaLourenco(0.6, cohesion=1e5, tensile_strength=5e4)
    light = lb.Block.box("stone", size=(1, 1, 1), at=(0, 0, 0.5), unit_weight=0.0)
    contacts = lb.find_interfaces([GROUND, light], joint)
    c_T = (np.sqrt(2.0) + np.arcsinh(1.0)) / 6
    for about, strength, does in (((0, 0, 1), 1e5 * c_T, "twist"), ((1, 0, 0), 5e4 / 2, "hinge")):
        live = lb.loads.moment("stone", about)
        model = lb.Model([GROUND, light], ["ground"], contacts, lb.self_weight(), live)
        found = lb.bounds(model)
        assert found.lower == pytest.approx(strength, rel=1e-6)
        states = interface_states(model, found)
        assert states.state == (does,)
        assert states.utilisation[0] == pytest.approx(1.0, rel=1e-6)


@pytest.mark.parametrize("joint", JOINTS)
def test_force_off_the_middle_slides_and_twists(joint):
    live = lb.loads.force("stone", (0, 20e3, 0), at=(0.15, 0, 0))
    found, _ = states_of([GROUND, stone()], joint(friction=0.3), live)
    assert found.state == ("slide-twist",)


def test_twist_about_an_eccentric_centre_of_pressure_does_not_slide():
    block = stone()
    blocks = [GROUND, block]
    joint = lb.OrdunaLourenco(friction=0.5)
    # a load of the same weight at (0.7, 0.3) puts the centre of pressure half as far
    dead = lb.self_weight() + lb.loads.force("stone", (0, 0, -block.weight), at=(0.7, 0.3, 1.0))
    live = lb.loads.moment("stone", (0, 0, 1))
    model = lb.Model(blocks, ["ground"], lb.find_interfaces(blocks, joint), dead, live)
    found = interface_states(model, lb.nonassociated(model, turning="centre of pressure"))
    assert found.active_modes == (("moment-twist",),)
    assert np.linalg.norm(found.strain_rates[0, :2]) > 0.3 * abs(found.strain_rates[0, 5])
    assert np.allclose(found.centre_of_pressure, [[0.35, 0.15, 0.0]], atol=1e-5)
    assert found.state == ("twist",)


@pytest.mark.parametrize("push", [(-1, 0, 0), (1, 0, 0)])
def test_prism_on_a_triangle_hinges_about_a_side_or_a_corner(push):
    corners = [(0, -0.5, 0), (0, 0.5, 0), (1.5, 0, 0)]  # centroid at x = 0.5; s1 along an oblique side
    vertices = [*corners, *((x, y, 4.0) for x, y, _ in corners)]
    faces = [(2, 1, 0), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)]
    faces = [face[::-1] for face in faces] if _volume(vertices, faces) < 0 else faces
    prism = lb.Block("prism", vertices, faces, unit_weight=20e3)
    model = model_of([GROUND, prism], lb.OrdunaLourenco(friction=0.9), lb.mass_proportional(push))
    bounds = lb.bounds(model)
    found = interface_states(model, bounds)
    assert np.isclose(bounds.lower, (0.5 if push[0] < 0 else 1.0) / 2.0, rtol=1e-5)
    assert found.state == ("hinge",)
    assert np.isclose(found.centre_of_pressure[0, 0], 0.0 if push[0] < 0 else 1.5, atol=1e-4)


def _volume(vertices, faces):
    points = np.array(vertices)
    return sum(
        np.linalg.det(points[[face[0], face[k], face[k + 1]]])
        for face in faces
        for k in range(1, len(face) - 1)
    )


def test_weak_stone_crushes_where_a_hard_one_hinges():
    block = stone(size=(0.5, 1.0, 2.0), at=(0, 0, 1))
    push = lb.mass_proportional((1, 0, 0))
    strength = 8 * block.weight / 0.5  # a strip of 1/8 of the width carries the weight
    found, bounds = states_of(
        [GROUND, block], lb.OrdunaLourenco(friction=0.6, compressive_strength=strength), push
    )
    assert found.state == ("crush",)
    arm = 0.25 * (1 - 1 / 8)  # centre of the stress block
    assert np.isclose(bounds.lower, arm, rtol=1e-5)
    assert np.allclose(found.centre_of_pressure, [[arm, 0, 0]], atol=1e-5)


@pytest.mark.parametrize("joint", JOINTS)
def test_head_joint_opens_when_one_block_is_pushed_away(joint):
    blocks = [GROUND, stone("left", at=(-0.5, 0, 0.5)), stone("right", at=(0.5, 0, 0.5))]
    found, _ = states_of(blocks, joint(friction=0.3), lb.loads.force("right", (1, 0, 0), at=(0.5, 0, 0)))
    assert dict(zip(found.names, found.state, strict=True)) == {
        "ground|left": "stick",
        "ground|right": "slide",
        "left|right": "open",
    }
    k = found.names.index("left|right")
    assert np.isnan(found.centre_of_pressure[k]).all()
    assert found.utilisation[k] == 0.0


@pytest.mark.parametrize("joint", [lb.OrdunaLourenco, lb.joints.ExactTorsion])
@pytest.mark.parametrize("settings", [{}, {"cohesion": 2e3}])
def test_utilisation_is_what_the_joint_answers(joint, settings):
    if joint is lb.joints.ExactTorsion and settings:
        settings = {"fineness": 2}
    model = lb.structures.corner(joint(friction=0.6, **settings), **CORNER)
    bounds = lb.bounds(model)
    found = interface_states(model, bounds)
    Q = bounds.stress_resultants
    loaded = np.linalg.norm(Q[:, :3], axis=1) > 1e3 * LOADED * model.problem.units.interface_force
    assert loaded.sum() > 10
    answers = [i.joint.utilisation(i, q) for i, q in zip(model.interfaces, Q, strict=True)]
    assert np.allclose(found.utilisation[loaded], np.minimum(answers, 1.0)[loaded], atol=1e-6)


def test_forces_of_points_that_carry_the_most_count():
    """At collapse the only joint there is is exhausted, wherever its pressure acts."""
    slab = stone(size=(1.0, 1.0, 0.2), at=(0, 0, 0.1))
    W = slab.weight
    model = model_of([GROUND, slab], lb.PointContact(0.5), lb.loads.force("stone", (W, 0, 0), (0, 1.5, 0)))
    corner = lb.loads.force("stone", (0, 0, -4 * W), (0.5, 0.5, 0))
    model = dataclasses.replace(model, dead=lb.self_weight() + corner)
    assert interface_states(model, lb.bounds(model)).utilisation == pytest.approx([1.0], abs=1e-5)


@pytest.mark.parametrize(
    "joint", [lb.PointContact(0.6), lb.PointContact(0.4, 2, "inner"), lb.PointContact(0.0)]
)
def test_utilisation_of_points_is_that_of_the_linear_programs_of_the_joint(joint):
    model = lb.structures.corner(lb.PointContact(0.6), **CORNER)
    share = np.random.default_rng(0).uniform(0.05, 0.8, (len(model.interfaces), 1))
    share = share * (1.0 if joint.friction else np.array([0.0, 0, 1, 1, 1, 0])) * [1.0, 1, 0, 1, 1, 1]
    Q = lb.bounds(model).stress_resultants * (share + np.eye(6)[2])
    model = dataclasses.replace(
        model, interfaces=[dataclasses.replace(i, joint=joint) for i in model.interfaces]
    )
    problem = model.problem
    x = np.linalg.lstsq(problem.resultants.toarray(), Q.ravel() / problem.units.resultants, rcond=None)[0]
    pressed = -Q[:, 2] > 1e3 * LOADED * problem.units.interface_force
    assert pressed.sum() > 10
    pairs = zip(model.interfaces, Q, pressed, strict=True)
    answers = np.minimum([i.joint.utilisation(i, q) for i, q, one in pairs if one], 1.0)
    assert np.ptp(answers) > 0.5
    assert utilisation(model, x * problem.stress_units)[pressed] == pytest.approx(answers, rel=1e-5, abs=1e-9)


def test_a_joint_that_is_pressed_in_its_middle_says_how_near_it_is_to_crushing():
    """A column of 1 m2 weighs 40 kN over its base, 99 % of fc A; its moments of 0 say nothing."""
    strength = 40e3 / 0.99
    column = [GROUND, stone(size=(1, 1, 2), at=(0, 0, 1))]
    joint = lb.OrdunaLourenco(0.6, compressive_strength=strength)
    model = model_of(column, joint, lb.mass_proportional((1, 0, 0)))
    resting = np.array([0.0, 0.0, -40e3, 0.0, 0.0, 0.0])
    assert joint.utilisation(model.interfaces[0], resting) == pytest.approx(0.99)
    used = utilisation(model, resting)
    assert used == pytest.approx([0.99])


def test_a_joint_that_is_pulled_says_how_near_it_is_to_tearing():
    """A stone of 40 kN hangs from 1 m2, by 97 % of what counts of its tensile strength, cohesion / mu."""
    counted = 40e3 / 0.97
    joint = lb.OrdunaLourenco(0.5, cohesion=0.5 * counted, tensile_strength=2.0 * counted)
    ceiling = lb.Block.box("ceiling", (2, 2, 0.2), (0, 0, 2.1))
    model = lb.Model(
        [ceiling, stone(size=(1, 1, 2), at=(0, 0, 1))],
        ["ceiling"],
        lb.find_interfaces([ceiling, stone(size=(1, 1, 2), at=(0, 0, 1))], joint),
        lb.self_weight(),
        lb.mass_proportional((0, 0, -1)),
    )
    hanging = np.array([0.0, 0.0, 40e3, 0.0, 0.0, 0.0])
    assert joint.utilisation(model.interfaces[0], hanging) == pytest.approx(0.97)
    assert utilisation(model, hanging) == pytest.approx([0.97])
    assert lb.bounds(model).upper == pytest.approx(1.0 / 0.97 - 1.0, rel=1e-6)  # torn off
    dry = lb.OrdunaLourenco(0.5)
    assert dry.utilisation(model.interfaces[0], (0, 0, -1.0, 0, 0, 0)) == 0.0


def test_exact_circle_and_crushing_are_cones_of_the_same_utilisation():
    joint = lb.OrdunaLourenco(friction=0.6, slip="exact", compressive_strength=2e5)
    model = lb.structures.corner(joint, **CORNER)
    bounds = lb.bounds(model)
    found = interface_states(model, bounds)
    answers = [
        i.joint.utilisation(i, q) for i, q in zip(model.interfaces, found.stress_resultants, strict=True)
    ]
    loaded = np.linalg.norm(found.force, axis=1) > 1e3 * LOADED * model.problem.units.interface_force
    assert np.allclose(found.utilisation[loaded], np.minimum(answers, 1.0)[loaded], atol=1e-6)


def test_forces_and_their_points_balance_every_block_of_an_arch():
    model = lb.structures.arch(lb.OrdunaLourenco(friction=0.7), radius=2, thickness=0.5, voussoirs=7)
    bounds = lb.bounds(model)
    found = interface_states(model, bounds)
    places = {block.name: k for k, block in enumerate(model.free_blocks)}
    load = model.dead.on(model.free_blocks) + bounds.lower * model.live.on(model.free_blocks)
    for k, interface in enumerate(model.interfaces):
        for name, sign in ((interface.block_i, -1.0), (interface.block_j, 1.0)):
            if name in places:
                block = model.free_blocks[places[name]]
                arm = found.centre_of_pressure[k] - block.centroid
                load[places[name]] += sign * np.r_[found.force[k], np.cross(arm, found.force[k])]
    assert np.abs(load).max() < 1e-5 * model.free_blocks[0].weight


def test_turned_model_has_the_same_states():
    c, s = np.cos(0.7), np.sin(0.7)
    turn = np.array([(c, -s, 0), (s, c, 0), (0, 0, 1)])
    straight = lb.structures.corner(lb.OrdunaLourenco(friction=0.6), **CORNER)
    blocks = [block.moved(turn, (1.0, 2.0, 3.0)) for block in straight.blocks]
    interfaces = [
        dataclasses.replace(i, centroid=turn @ i.centroid + (1.0, 2.0, 3.0), axes=i.axes @ turn.T)
        for i in straight.interfaces
    ]
    direction = straight.live.on(straight.free_blocks)[0, :3]
    live = lb.mass_proportional(turn @ direction)
    turned = lb.Model(blocks, straight.supports, interfaces, lb.self_weight(), live)
    one, other = lb.bounds(straight), lb.bounds(turned)
    same = dataclasses.replace(
        one, displacement_rates=one.displacement_rates @ np.kron(np.eye(2), turn.T), digest=turned.digest
    )
    first, second = interface_states(straight, one), interface_states(turned, same)
    assert first.state == second.state
    assert len(set(first.state)) > 2
    assert np.allclose(first.strain_rates, second.strain_rates, atol=1e-12)
    assert np.allclose(first.force @ turn.T, second.force)
    assert np.isclose(one.lower, other.lower, rtol=1e-5)


def test_result_of_another_model_is_refused():
    model = model_of([GROUND, stone()], lb.OrdunaLourenco(friction=0.5), lb.mass_proportional((1, 0, 0)))
    other = model_of([GROUND, stone()], lb.OrdunaLourenco(friction=0.4), lb.mass_proportional((1, 0, 0)))
    with pytest.raises(lb.LimitBlocksError, match="belongs to model"):
        interface_states(other, lb.bounds(model))
    with pytest.raises(lb.LimitBlocksError, match="Claim has no mechanism"):
        interface_states(model, lb.results.Claim(0.5, np.zeros((1, 6))))


def test_arrays_cannot_be_written_to():
    found, _ = states_of([GROUND, stone()], lb.OrdunaLourenco(friction=0.5), lb.mass_proportional((1, 0, 0)))
    for field in dataclasses.fields(found):
        value = getattr(found, field.name)
        assert isinstance(value, tuple) or not value.flags.writeable
