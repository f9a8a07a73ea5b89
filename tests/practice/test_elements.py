"""Ties, strips and dowels: closed forms, properties, misuse."""

from dataclasses import replace

import numpy as np
import pytest
from facades import ARM, FLOOR, OWN, H, T, facade
from stones import model_of

import limitblocks as lb
from limitblocks.analysis.nonassociated.start import state_of
from limitblocks.analysis.scales import frictional
from limitblocks.evidence.locked_tension import locked_tension
from limitblocks.evidence.spanning_tree import spanning_tree
from limitblocks.joints import Guide, Tie
from limitblocks.practice import dowel, reinforced, strip, tie
from limitblocks.problem import Flow

JOINTS = [lb.PointContact(0.6), lb.OrdunaLourenco(0.6)]
JOINT_NAMES = ["point contact", "paper"]
every_joint = pytest.mark.parametrize("joint", JOINTS, ids=JOINT_NAMES)


def rocking(force=0.0, height=0.0):
    """Moments about the outer edge."""
    return (OWN * T / 2 + FLOOR * ARM + force * height) / (OWN * H / 2 + FLOOR * H)


def rod(force, height=4.5, **settings):
    settings = {"area": 1e-4, "strength": 235e6, "pull_out": force} | settings
    return tie("wall", (-T / 2, 0, height), "ground", (-6.0, 0, height), **settings)


@every_joint
def test_tie_of_a_facade(joint):
    assert rocking() == pytest.approx(0.0907692, abs=5e-8)
    assert rocking(8e3, 4.5) == pytest.approx(0.3123077, abs=5e-8)
    model = reinforced(facade(joint), rod(8e3))
    found, result = lb.bounds(model), lb.nonassociated(model)
    assert found.lower <= rocking(8e3, 4.5) * (1 + 1e-9)
    assert found.proven
    assert found.upper == pytest.approx(rocking(8e3, 4.5), rel=1e-8)
    assert result.load_factor == pytest.approx(rocking(8e3, 4.5), rel=1e-8)
    assert lb.check_mcp(model, result).passed
    states = lb.interface_states(model, result)
    assert states.state[1] == "yield"
    assert states.utilisation[1] == pytest.approx(1.0)
    assert result.stress_resultants[1] == pytest.approx([0, 0, 8e3, 0, 0, 0], abs=1e-3)
    assert not any("is locked in" in remark for remark in result.remarks)  # it yields: its force is known


def test_strength_of_the_section_governs_where_it_is_less():
    model = reinforced(facade(), rod(1e9, area=2e-5, strength=200e6, number_of=2))
    assert lb.bounds(model).upper == pytest.approx(rocking(2 * 2e-5 * 200e6, 4.5), rel=1e-8)


def test_tie_that_goes_slack_does_nothing():
    inward = tie("wall", (T / 2, 0, 4.5), "ground", (6.0, 0, 4.5), area=1e-4, strength=235e6)
    model = reinforced(facade(), inward)
    result = lb.nonassociated(model)
    assert result.load_factor == pytest.approx(rocking(), rel=1e-8)
    assert lb.interface_states(model, result).state[1] == "slack"


@pytest.mark.parametrize("share", [0.0, 0.3])
def test_inclined_ties_and_several(share):
    """Two ties of half the force, inclined by 3 to 4, one with a prestress: moments add up."""
    down = tie("wall", (-T / 2, 0, 4.0), "ground", (-T / 2 - 4.0, 0, 1.0), area=1e-4, strength=5e7)
    pulled = rod(3e3, height=3.0, prestress=share * 3e3)
    moment = 5e3 * (0.8 * 4.0 + 0.6 * T) + 3e3 * 3.0
    model = reinforced(facade(), down, pulled)
    assert lb.bounds(model).upper == pytest.approx(rocking(moment, 1.0), rel=1e-8)
    assert lb.nonassociated(model).load_factor == pytest.approx(rocking(moment, 1.0), rel=1e-8)


def test_prestress_that_pulls_a_wall_over_is_no_equilibrium():
    held = OWN * T / 2 + FLOOR * (T - ARM)  # about the inner edge
    for part, falls in ((0.99, False), (1.01, True)):
        model = reinforced(facade(), rod(8e3, prestress=part * held / 4.5))
        if falls:
            with pytest.raises(lb.LimitBlocksError, match="wall would fall"):
                lb.bounds(model)
        else:
            assert lb.bounds(model).lower > 0


def test_strip_across_the_base_is_a_force_at_the_edge():
    model = facade()
    own = strip(model.interfaces[0], (-T / 2, 0, 0), width=0.1, capacity=6e3)
    held = reinforced(model, own)
    result = lb.nonassociated(held)
    assert own.interface.name == "strip ground|wall"
    assert lb.bounds(held).upper == pytest.approx(rocking(6e3, T), rel=1e-8)
    assert result.load_factor == pytest.approx(rocking(6e3, T), rel=1e-8)  # debonds at its cap
    assert lb.interface_states(held, result).state == ("hinge", "yield")


@every_joint
def test_tension_that_a_slide_locks_in_a_strip_is_named(joint):
    """Across a joint that slides without dilatancy a strip may pull by any 0 <= F <= c: mu (1 + F/W) each."""
    model = lb.structures.block(joint, width=1.0, height=0.5)
    weight = model.free_blocks[0].weight
    held = reinforced(
        model, strip(model.interfaces[0], model.interfaces[0].centroid, width=0.1, capacity=weight / 4)
    )
    result = lb.nonassociated(held)
    F = result.stress_resultants[1, 2]
    assert 0.0 < F < weight / 4
    assert result.load_factor == pytest.approx(0.6 * (1 + F / weight), rel=1e-8) != pytest.approx(0.6)
    check = lb.check_mcp(held, result)
    assert check.passed
    for found in (result, check):
        assert f"a force of up to {F:.4g} N is locked in strip base|block 1" in found.remarks[-1]


def test_a_tie_whose_force_statics_determine_locks_nothing():
    """Two walls that hinge, tied at one height: the tie carries what the thin one lacks."""
    size, thick, z = (0.4, 1, 3.0), (0.9, 1, 3.0), 2.6
    blocks = [
        lb.Block.box("ground", (8, 1, 0.4), at=(1.5, 0, -0.2)),
        lb.Block.box("thin", size, at=(3, 0, 1.5), unit_weight=20e3),
        lb.Block.box("thick", thick, at=(0, 0, 1.5), unit_weight=20e3),
    ]
    push = lb.mass_proportional((1, 0, 0))
    model = lb.Model(
        blocks, ["ground"], lb.find_interfaces(blocks, lb.PointContact(0.8)), lb.self_weight(), push
    )
    tied = reinforced(model, tie("thick", (0.45, 0, z), "thin", (2.8, 0, z), area=1e-3, strength=1e9))
    result = lb.nonassociated(tied)
    W1, W2 = (block.weight for block in model.free_blocks)
    alpha = (W1 * 0.2 + W2 * 0.45) / ((W1 + W2) * 1.5)
    assert result.load_factor == pytest.approx(alpha, rel=1e-8)
    assert result.stress_resultants[-1, 2] == pytest.approx(W1 * (1.5 * alpha - 0.2) / z, rel=1e-8)
    assert not [said for said in (*result.remarks, *lb.check_mcp(tied, result).remarks) if "locked" in said]


def test_two_ties_of_the_same_blocks_are_counted_under_their_one_name():
    """They have the name of their blocks, which stood there twice."""
    model = lb.structures.block(lb.OrdunaLourenco(0.6), width=1.0, height=0.5)
    (joint,), capacity = model.interfaces, model.free_blocks[0].weight / 8
    places = [joint.centroid + np.array([x, 0.0, 0.0]) for x in (-0.2, 0.2)]
    held = reinforced(model, *(strip(joint, at, width=0.1, capacity=capacity) for at in places))
    flow = Flow(held.problem)
    state = state_of(held, flow.problem, lb.nonassociated(held))
    tied = flow.problem.stress_interface > 0
    state = replace(state, x=np.where(tied, 0.5, state.x))  # both pull, by no matter what
    (remark,) = locked_tension(held, flow, state)
    assert "is locked in 2 × strip base|block 1, whose" in remark


def test_what_stretches_or_carries_nothing_locks_nothing():
    """A strip that yields as its wall hinges; a level tie that a sliding block slackens."""
    model = facade()
    held = reinforced(model, strip(model.interfaces[0], (-T / 2, 0, 0), width=0.1, capacity=6e3))
    stone = lb.structures.block(lb.PointContact(0.3), width=1.0, height=0.5)
    ahead = tie("block 1", (0.5, 0, 0.1), "base", (4.0, 0, 0.1), area=1e-4, strength=1e8)
    for one in (held, reinforced(stone, ahead)):
        result = lb.nonassociated(one)
        assert not [
            said for said in (*result.remarks, *lb.check_mcp(one, result).remarks) if "locked" in said
        ]


@every_joint
def test_more_tie_is_never_weaker(joint):
    factors = [lb.bounds(reinforced(facade(joint), rod(force))).upper for force in (1.0, 1e3, 4e3, 3e4)]
    assert np.all(np.diff(factors) > -1e-9)
    assert factors[0] == pytest.approx(rocking(1.0, 4.5), rel=1e-8)


@pytest.mark.parametrize("dilatancy", [0.0, 0.3, 0.6])
def test_ties_have_no_friction_that_limits_dilatancy(dilatancy):
    """A wall that hinges does not slide: any dilatancy up to the friction of its joint gives one answer."""
    model = reinforced(facade(), rod(8e3))
    result = lb.nonassociated(model, dilatancy=dilatancy)
    assert result.load_factor == pytest.approx(rocking(8e3, 4.5), rel=1e-8)
    with pytest.raises(lb.ModelError, match=r"expected 0 to the least friction coefficient, 0\.6"):
        lb.nonassociated(model, dilatancy=0.61)


def test_what_is_unbalanced_is_not_carried_by_ties():
    """The tree of a proof leads through the joint, however little room it has: a tie carries one force."""
    model = reinforced(facade(), rod(8e3))
    tree = spanning_tree(model.problem, np.array([1e-3, 1.0]))
    assert tree.interface.tolist() == [0]


def test_shear_of_a_dowel_is_measured_as_any_force():
    """Shear of a joint is measured by its friction, .25; a dowel has none, and its shear is no small one."""
    model = lb.structures.block(lb.PointContact(0.25), width=1.0, height=0.5)
    (joint,) = model.interfaces
    held = reinforced(model, dowel(joint, joint.centroid, diameter=0.02, capacity=1e3))
    corners = [0.25, 0.25, 1.0] * 4
    assert frictional(held.problem).tolist() == [*corners, 1.0, 1.0]


def test_prestress_takes_from_what_a_tie_can_take():
    """The load factor does not depend on the prestress of a tie that yields; N is what comes on top."""
    result = lb.nonassociated(reinforced(facade(), rod(8e3, prestress=2e3)))
    assert result.load_factor == pytest.approx(rocking(8e3, 4.5), rel=1e-8)
    assert result.stress_resultants[1, 2] == pytest.approx(6e3, rel=1e-6)
    # on the side to which the wall turns the prestress stays, against it
    inward = tie("wall", (T / 2, 0, 4.5), "ground", (6, 0, 4.5), area=1e-4, strength=2e8, prestress=1e3)
    slack = lb.nonassociated(reinforced(facade(), inward))
    assert slack.load_factor == pytest.approx(rocking(-1e3, 4.5), rel=1e-8)


def test_file_keeps_ties(tmp_path):
    model = reinforced(facade(), rod(8e3, prestress=1e3))
    again = lb.read(model.save(tmp_path / "tied.json"))
    assert again.digest == model.digest
    assert again.interfaces[1].joint == Tie(8e3 / 1e-4, 6.0 - T / 2, 1e3 / 1e-4)
    assert again.interfaces[1].name == "tie wall|ground"


def test_an_anchor_off_its_block_is_refused_with_the_distance():
    """A slip in a coordinate gave the tie another lever arm, and was not said."""

    def anchored(x, y, z):
        return reinforced(facade(), tie("wall", (x, y, z), "ground", (-6, 0, z), area=1e-4, strength=2e8))

    with pytest.raises(lb.ModelError, match=r"tie wall\|ground: its anchor .* is 40 m off block 'wall'"):
        anchored(-T / 2, 0, H + 40.0)
    with pytest.raises(lb.ModelError, match="4000 m off"):  # not 4e+03
        anchored(-T / 2, 0, H + 4000.0)
    with pytest.raises(lb.ModelError, match="5 m off"):  # 3 beside, 4 above the corner
        anchored(-T / 2 - 3.0, 0, H + 4.0)
    with pytest.raises(lb.ModelError, match="30 mm off"):
        anchored(-T / 2 - 0.03, 0, 1.0)
    with pytest.raises(
        lb.ModelError,
        match=r"within [0-9.]+ mm; in a support it may lie anywhere; that point is in block 'ground'",
    ):
        anchored(-T / 2, 0, -0.05)
    for x in (-T / 2 - 1e-4, -T / 2, 0.0):  # on the face, as far as drawings are good, and in the wall
        assert len(anchored(x, 0, 1.0).interfaces) == 2


@pytest.mark.parametrize("size", [0.01, 1.0, 100.0])
def test_an_anchor_counts_as_on_its_block_within_a_thousandth_of_the_blocks(size):
    """Cubes of any size, m: half of that off is on the face, twice is not."""
    cubes = [
        lb.Block.box(name, (size,) * 3, (0, 0, z * size), 2e4) for name, z in (("low", -0.5), ("top", 0.5))
    ]
    model = model_of(cubes, ["low"], lb.PointContact(0.6))
    near, far = (
        tie("top", (-size * (0.5 + off), 0, size / 2), "low", (-9 * size, 0, 0), area=1e-4, strength=2e8)
        for off in (0.5e-3, 2e-3)
    )
    assert len(reinforced(model, near).interfaces) == 2
    with pytest.raises(lb.ModelError, match="off block 'top', expected in or on it, within"):
        reinforced(model, far)


def test_a_strip_made_of_the_joint_of_another_model_is_refused():
    """The edge of a wall .5 m thick is .2 m off one of .3 m that begins at the same place."""
    thick, thin = (lb.structures.block(lb.PointContact(0.6), width=t, height=1.0) for t in (0.5, 0.3))
    edge = thick.interfaces[0].centroid + np.array([0.25, 0, 0])
    for own in (
        strip(thick.interfaces[0], edge, width=0.1, capacity=1e3),
        dowel(thick.interfaces[0], edge, diameter=0.1, capacity=1e3),
    ):
        assert len(reinforced(thick, own).interfaces) == 2
        with pytest.raises(lb.ModelError, match=r"0\) is 0.2 m off block 'block 1', expected on a joint"):
            reinforced(thin, own)


def test_an_anchor_in_the_hollow_of_a_block_is_off_it():
    """In the middle of the recess of a U, 0.5 m from its sides and 0.4 m above its floor."""
    outline = [(-1, 0), (1, 0), (1, 2), (0.5, 2), (0.5, 1), (-0.5, 1), (-0.5, 2), (-1, 2)]
    blocks = [
        lb.Block.box("ground", (4, 1, 0.4), (0, 0, -0.2)),
        lb.Block.prism("u", outline, (-0.5, 0.5), 2e4),
    ]
    model = model_of(blocks, ["ground"], lb.PointContact(0.6))
    with pytest.raises(lb.ModelError, match="m off block 'u'"):
        reinforced(model, tie("u", (0, 0, 1.4), "ground", (-6, 0, 1.4), area=1e-4, strength=2e8))


def test_a_guide_holds_forces_by_its_area_and_moments_by_that_times_its_root():
    """2 m x 3 m and 7 Pa: 42 N, 42 sqrt(6) N m, of either sign; V1 alone is free."""
    rows = Guide(7.0).yield_rows(np.array([[(-1, -1.5), (1, -1.5), (1, 1.5), (-1, 1.5)]], dtype=float))
    most = 42.0 * np.array([1.0, 1.0, *[np.sqrt(6.0)] * 3])
    assert rows.g[0] == pytest.approx(np.concatenate([most, most]))
    assert (np.abs(rows.F[0] @ rows.resultants[0].T) == np.vstack([np.eye(6)[1:]] * 2)).all()


@pytest.mark.parametrize("at", [(0.26, 0.0, 0.0), (0.25, 0.0, 0.01), (0.0, 0.51, 0.0)])
def test_a_strip_or_dowel_off_its_joint_is_refused(at):
    """The joint is 0.5 x 1 m; the circle about it reaches to 0.56 m. On its edge it is taken."""
    joint = lb.structures.block(lb.PointContact(0.6), width=0.5, height=1.0, depth=1.0).interfaces[0]
    start = joint.centroid
    for made, size in ((strip, {"width": 0.1}), (dowel, {"diameter": 0.1})):
        assert made(joint, start + np.array([0.25, 0.5, 0.0]), **size, capacity=1e3)
        assert made(joint, start + np.array([0.0, 0.5, 4e-4]), **size, capacity=1e3)  # within 1e-3 of 0.5 m
        with pytest.raises(lb.ModelError, match=r"not on the joint, 0\.01 m off it"):
            made(joint, start + np.array(at), **size, capacity=1e3)


def test_a_tie_across_slip_that_may_turn_is_locked():
    """A plate of weight W on a slope, pushed along its contours, with a tie of force N normal to it.

    It slides by the resultant of push and weight: (a W)^2 + (W sin)^2 = mu^2 (W cos + N)^2, for any N.
    """
    mu, angle = 0.6, np.arctan(0.25)
    sine, cosine = np.sin(angle), np.cos(angle)
    R = np.array([(cosine, 0.0, sine), (0.0, 1.0, 0.0), (-sine, 0.0, cosine)])
    slope = lb.Block.box("slope", (4, 1, 0.2), (0, 0, -0.1)).moved(R, (0, 0, 0))
    plate = lb.Block.box("plate", (1, 1, 0.3), (0, 0, 0.15), 20e3).moved(R, (0, 0, 0))
    found = lb.find_interfaces([slope, plate], lb.OrdunaLourenco(mu))
    push = lb.mass_proportional((0, 1, 0))
    model = lb.Model([slope, plate], ["slope"], found, lb.self_weight(), push)
    ends = R @ (0, 0, -0.15), R @ (0, 0, 0.3)
    held = reinforced(model, tie("slope", ends[0], "plate", ends[1], area=1e-3, strength=2e7))
    answers = lb.load_factor_range(held, paths=2, mechanisms=3).answers
    forces = [one.solution.stress_resultants[-1, 2] for one in answers]
    assert max(forces) > 5e3
    for force, one in zip(forces, answers, strict=True):
        expected = (mu * (cosine + force / 6e3)) ** 2 - sine**2
        assert one.load_factor == pytest.approx(np.sqrt(expected), rel=1e-6)
        assert any("is locked in tie" in said for said in one.solution.remarks) == (force > 1.0)
