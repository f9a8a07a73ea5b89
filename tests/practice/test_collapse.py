"""A support that settles until the structure falls: closed forms of three-hinged arches, misuse."""

import numpy as np
import pytest
from scipy.optimize import brentq
from spreading_arch import first_hinge, fourth_hinge, half_ring, three_hinged

import limitblocks as lb
from limitblocks.loads import pressure
from limitblocks.practice import settlement_to_collapse

DEPTH, WEIGHT = 1.0, 20e3
SPREAD = (1.0, 0.0, 0.0)


def arch(voussoirs, thickness, joint=None):
    ring = lb.structures.arch(
        joint or lb.PointContact(0.8),
        radius=1.0,
        thickness=thickness,
        voussoirs=voussoirs,
        unit_weight=WEIGHT,
    )
    return ring, sum(block.weight for block in ring.free_blocks)


@pytest.mark.parametrize(
    ("voussoirs", "thickness", "without_dilatancy"), [(8, 0.2, True), (8, 0.2, False), (16, 0.15, False)]
)  # fmt: skip
def test_arch_spreads_until_its_thrust_leaves_the_springing(voussoirs, thickness, without_dilatancy):
    """Its fourth hinge is at the extrados of the springing; in between the thrust of a three-hinged arch.

    The case of Ochsendorf (2006), The masonry arch on spreading supports, by another program.
    """
    hinge = first_hinge(voussoirs, thickness)
    ring, weight = arch(voussoirs, thickness)
    fourth = fourth_hinge(voussoirs, thickness)
    curve = settlement_to_collapse(
        ring, "right support", SPREAD, step=0.1, accuracy=1e-2, without_dilatancy=without_dilatancy
    )
    expected = [three_hinged(voussoirs, thickness, d, hinge)[0] * weight for d in curve.displacements]
    assert curve.reactions == pytest.approx(expected, rel=1e-6)
    assert curve.stands_to <= fourth <= curve.falls
    assert curve.falls - curve.stands_to <= 2e-2
    assert curve.ended.startswith("the structure falls between")
    assert all(point.found.bounds.proven and not point.across for point in curve.points)
    assert len(curve.points[1].changes) == 3
    crown = f"voussoir {voussoirs // 2}|voussoir {voussoirs // 2 + 1} opens"
    assert set(curve.points[1].changes) >= {crown, f"voussoir {hinge}|voussoir {hinge + 1} opens"}


@pytest.mark.parametrize("thickness", [0.15, 0.2])
def test_another_program_has_the_limits_of_spreading(thickness):
    """A thinner arch falls earlier; at its least thickness (.1075 with many voussoirs) it does at once."""
    assert fourth_hinge(16, thickness) < fourth_hinge(16, thickness + 0.03)
    assert fourth_hinge(30, 0.108) < 5e-3


def test_two_stones_that_lean_on_one_another():
    """Thrust W x / h of the half at any spread; they slide off at their friction.

    The normal of an opened joint is half way between both faces, so that friction begins at atan(mu) and half
    the turn of a stone.
    """
    friction, thickness = 0.5, 0.3
    ring, weight = arch(2, thickness, lb.PointContact(friction))
    inner, outer, _, centres = half_ring(2, thickness)
    arm, mass = outer[-1] - inner[0], centres[0] - inner[0]

    def turn(spread):
        return np.arccos((arm[0] + spread / 2) / np.hypot(*arm)) - np.arctan2(arm[1], arm[0])

    def thrust(spread):
        x = mass[0] * np.cos(turn(spread)) - mass[1] * np.sin(turn(spread))
        return weight / 2 * x / np.sqrt(arm @ arm - (arm[0] + spread / 2) ** 2)

    def left(spread):
        return np.arctan(friction) - turn(spread) / 2 - np.arctan(2 * thrust(spread) / weight)

    slides = brentq(left, 0.0, 2 * (np.hypot(*arm) - arm[0]) - 1e-9)
    curve = settlement_to_collapse(ring, "right support", SPREAD, step=0.3, accuracy=1e-2)
    assert curve.reactions == pytest.approx([thrust(d) for d in curve.displacements], rel=1e-6)
    assert curve.stands_to <= slides <= curve.falls
    assert curve.falls - curve.stands_to <= 2e-2


def test_a_beam_slides_off_the_edge_that_it_rests_on():
    """A beam of 5 m, a support sinking: it slides along the edge of the other one for as long as it is on it.

    At the fall its lower corners are on that edge and on the top of the sunk support, 5 m from one another.
    """
    stones = [
        lb.Block.box("left", (1, 1, 1), (-0.5, 0, -0.5)),
        lb.Block.box("right", (1, 1, 1), (4.5, 0, -0.5)),
        lb.Block.box("beam", (5, 1, 0.3), (2.0, 0, 0.15), unit_weight=20e3),
    ]
    joints = lb.find_interfaces(stones, lb.PointContact(0.5))
    beam = lb.Model(stones, ["left", "right"], joints, lb.self_weight(), lb.mass_proportional((1, 0, 0)))
    curve = settlement_to_collapse(beam, "right", (0, 0, -1), step=0.5, accuracy=1e-2)
    low = curve.points[-1].model.blocks[2].vertices[:, [0, 2]]
    x = low[low[:, 1].argmin(), 0]  # where the lower end has stopped sliding on the support
    assert curve.stands_to <= np.sqrt(5.0**2 - x**2) <= curve.falls
    assert curve.falls - curve.stands_to <= 2e-2


def test_it_ends_where_it_is_told_to():
    ring, _ = arch(2, 0.3)
    told = []
    curve = settlement_to_collapse(
        ring, "right support", SPREAD, step=0.02, largest=0.03, progress=told.append
    )
    assert curve.displacements[-1] == pytest.approx(0.03, rel=1e-9)
    assert curve.falls is None
    assert curve.ended == "the settlement 0.03 m is reached"
    assert tuple(told) == curve.points
    assert curve.digest == ring.digest
    assert [one["displacement"] for one in curve.to_dict()["points"]] == curve.displacements.tolist()
    assert str(curve).endswith("the settlement 0.03 m is reached")


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"step": 0.0}, "step is 0.0, expected a finite number > 0"),
        ({"accuracy": -1.0}, "accuracy is -1.0, expected a finite number > 0"),
        ({"largest": 0.0}, "largest is 0.0, expected a settlement > 0"),
    ],
)
def test_misuse(settings, words):
    with pytest.raises(lb.ModelError, match=words):
        settlement_to_collapse(arch(2, 0.3)[0], "right support", SPREAD, **settings)


def test_support_that_is_a_free_block_and_load_that_stays_behind():
    ring, _ = arch(2, 0.3)
    with pytest.raises(lb.ModelError, match="'voussoir 1' is a free block"):
        settlement_to_collapse(ring, "voussoir 1", SPREAD)
    wind = ring.dead + pressure("voussoir 1", 100.0, facing=(-1, 0, 0))
    loaded = lb.Model(ring.blocks, ring.supports, ring.interfaces, wind, ring.live)
    with pytest.raises(lb.ModelError, match="does not move with the blocks; a settlement until collapse"):
        settlement_to_collapse(loaded, "right support", SPREAD)
