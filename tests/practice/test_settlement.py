"""Settlement of a support: closed forms, the arch of least thickness, weak duality, misuse."""

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.practice import settlement, settling

LENGTH, BEARING, DEPTH, WEIGHT = 3.0, 0.4, 0.5, 20e3
JOINTS = [lb.PointContact(0.6), lb.OrdunaLourenco(0.6)]
UPRIGHT = np.eye(3)
DOWN, UP = (0, 0, -1), (0, 0, 1)
LEAST_THICKNESS, THRUST = 0.107478, 0.621772  # over the mean radius; over unit weight x t x depth x radius


def lintel(joint, turn=UPRIGHT):
    """A lintel on two supports."""
    stones = [
        lb.Block.box("left", (BEARING, 1, 1), (BEARING / 2, 0, -0.5)),
        lb.Block.box("right", (BEARING, 1, 1), (LENGTH - BEARING / 2, 0, -0.5)),
        lb.Block.box("lintel", (LENGTH, 1, DEPTH), (LENGTH / 2, 0, DEPTH / 2), WEIGHT),
    ]
    stones = [lb.Block(s.name, s.vertices @ turn.T, s.faces, s.unit_weight) for s in stones]
    found = lb.find_interfaces(stones, joint)
    return lb.Model(stones, ["left", "right"], found, lb.self_weight(), lb.mass_proportional((1, 0, 0)))


@pytest.mark.parametrize("joint", JOINTS, ids=["point contact", "paper"])
def test_lintel_follows_a_support_that_sinks(joint):
    """It turns about the inner edge of the other support and rests on the far edge of this one."""
    weight = WEIGHT * LENGTH * DEPTH
    found = settlement(lintel(joint), "right", DOWN)
    least = weight * (LENGTH / 2 - BEARING) / (LENGTH - BEARING)
    assert found.lower <= least * (1 + 1e-9)
    assert found.upper >= least * (1 - 1e-9)
    assert found.upper - found.lower <= 1e-6 * weight
    assert found.nonassociated == pytest.approx(least, rel=1e-8)
    assert lb.check_mcp(found.settling.model, found.result).passed


def test_lintel_is_lifted_by_the_greatest_reaction():
    weight = WEIGHT * LENGTH * DEPTH
    found = settlement(lintel(JOINTS[0]), "right", UP)
    assert -found.nonassociated == pytest.approx(weight * LENGTH / 2 / (LENGTH - BEARING), rel=1e-8)


def test_direction_turns_with_the_structure():
    """Turned about the vertical, and a support that sinks obliquely: the same, and less work for the same."""
    a = 0.7
    turn = np.array([(np.cos(a), -np.sin(a), 0), (np.sin(a), np.cos(a), 0), (0, 0, 1)])
    plain = settlement(lintel(JOINTS[0]), "right", (0.3, 0, -1), without_dilatancy=False)
    turned = settlement(lintel(JOINTS[0], turn), "right", turn @ (0.3, 0, -1), without_dilatancy=False)
    assert turned.upper == pytest.approx(plain.upper, rel=1e-6)


@pytest.mark.parametrize("voussoirs", [60])
def test_arch_of_least_thickness_has_one_thrust(voussoirs):
    """Spread or pushed together: .621772 gamma t d R (Cocchetti, Colasante & Rizzi 2011; radial joints)."""
    thickness = LEAST_THICKNESS * 1.0002  # it must stand
    arch = lb.structures.arch(
        lb.PointContact(2.0), radius=1.0, thickness=thickness, voussoirs=voussoirs, unit_weight=WEIGHT
    )
    depth = np.ptp(arch.free_blocks[0].vertices[:, 1])
    thrust = THRUST * WEIGHT * thickness * depth
    support = arch.supports[-1]
    out = np.sign(next(b for b in arch.blocks if b.name == support).centroid[0])
    spread = settlement(arch, support, (out, 0, 0), without_dilatancy=False)
    pushed = settlement(arch, support, (-out, 0, 0), without_dilatancy=False)
    assert spread.upper == pytest.approx(thrust, rel=2e-3)
    assert -pushed.upper == pytest.approx(thrust, rel=2e-3)
    assert spread.lower <= -pushed.lower


def test_reaction_is_that_of_an_admissible_state():
    own = settling(lintel(JOINTS[0]), "right", DOWN)
    assert own.reaction(0.0) == own.held
    assert 0 < own.held < WEIGHT * LENGTH * DEPTH


@pytest.mark.parametrize(
    ("support", "direction", "words"),
    [
        ("lintel", DOWN, "'lintel' is a free block"),
        ("post", DOWN, "'post' is not a block of the model"),
        ("right", (0, 0, 0), "direction is .0, 0, 0."),
    ],
)
def test_misuse(support, direction, words):
    with pytest.raises(lb.ModelError, match=words):
        settlement(lintel(JOINTS[0]), support, direction)


@pytest.mark.parametrize("joint", JOINTS, ids=["point contact", "paper"])
def test_joints_of_a_settling_structure_have_states(joint):
    """The lintel lifts off one support's inner part and turns; the guide at its strength would be wrong."""
    found = settlement(lintel(joint), "right", DOWN)
    states = lb.interface_states(found.settling.model, found.result)
    assert states.state[:2].count("hinge") >= 1
    assert states.utilisation[-1] < 0.1


def test_only_support():
    model = lb.structures.block(JOINTS[0], width=1.0, height=1.0)
    with pytest.raises(lb.ModelError, match="the only support"):
        settlement(model, model.supports[0], DOWN)
