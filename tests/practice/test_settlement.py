"""Settlement of a support: closed forms, the arch of least thickness, weak duality, misuse."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq
from stones import model_of

import limitblocks as lb
from limitblocks.practice import (
    capacity_curve,
    reinforced,
    settlement,
    settlement_to_collapse,
    settling,
    tie,
    uplift,
)

LENGTH, BEARING, DEPTH, WEIGHT = 3.0, 0.4, 0.5, 20e3
JOINTS = [lb.PointContact(0.6), lb.OrdunaLourenco(0.6)]
UPRIGHT = np.eye(3)
DOWN, UP = (0, 0, -1), (0, 0, 1)


def lintel(joint, turn=UPRIGHT):
    """A lintel on two supports."""
    stones = [
        lb.Block.box("left", (BEARING, 1, 1), (BEARING / 2, 0, -0.5)),
        lb.Block.box("right", (BEARING, 1, 1), (LENGTH - BEARING / 2, 0, -0.5)),
        lb.Block.box("lintel", (LENGTH, 1, DEPTH), (LENGTH / 2, 0, DEPTH / 2), WEIGHT),
    ]
    stones = [lb.Block(s.name, s.vertices @ turn.T, s.faces, s.unit_weight) for s in stones]
    return model_of(stones, ["left", "right"], joint)


@pytest.mark.parametrize("joint", JOINTS, ids=["point contact", "paper"])
def test_lintel_follows_a_support_that_sinks(joint):
    """It turns about the inner edge of the other support and rests on the far edge of this one."""
    weight = WEIGHT * LENGTH * DEPTH
    found = settlement(lintel(joint), "right", DOWN)
    least = weight * (LENGTH / 2 - BEARING) / (LENGTH - BEARING)
    assert found.lower <= least * (1 + 1e-9)
    assert found.upper >= least * (1 - 1e-9)
    assert found.upper - found.lower <= 1e-6 * weight
    assert found.lower == found.settling.reaction(found.bounds.upper) < found.upper
    assert found.nonassociated == pytest.approx(least, rel=1e-8)
    assert lb.check_mcp(found.settling.model, found.result).passed


def test_water_presses_on_the_support_that_sinks():
    """Moments about the other inner edge: water p b at the middle of the bearing, stone on its far edge."""
    model, weight, head = lintel(JOINTS[0]), WEIGHT * LENGTH * DEPTH, 0.5
    bearing = [one for one in model.interfaces if "right" in (one.block_i, one.block_j)]
    wet = replace(model, dead=model.dead + uplift(model, head, interfaces=bearing))
    water, arm = 9810.0 * head * BEARING, LENGTH - BEARING
    stone = (weight * (LENGTH / 2 - BEARING) - water * (arm - BEARING / 2)) / arm
    found = settlement(wet, "right", DOWN)
    assert found.nonassociated == pytest.approx(stone + water, rel=1e-8)
    assert found.lower <= (stone + water) * (1 + 1e-9)
    assert found.upper == pytest.approx(stone + water, rel=1e-6)
    with pytest.raises(lb.ModelError, match="JointPressure, which does not move with the blocks"):
        settlement_to_collapse(wet, "right", DOWN)
    with pytest.raises(lb.ModelError, match="JointPressure, which does not move with the blocks"):
        capacity_curve(wet)


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


def half_arch(voussoirs, thickness, centred=False):
    """Intrados and extrados joints of the left half from the springing on; area and moment above each joint.

    The mass of a voussoir is where it is, or, `centred`, that of a curved one on the centre line.
    """
    angles = np.linspace(np.pi, np.pi / 2, voussoirs // 2 + 1)
    ring = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    inner, outer = (1 - thickness / 2) * ring, (1 + thickness / 2) * ring
    half = np.pi / voussoirs / 2
    middle = np.cos((angles[:-1] + angles[1:]) / 2)
    if centred:
        areas, x = np.full(len(middle), thickness * 2 * half), middle * np.sin(half) / half
    else:  # trapezoids: centroid at the mean of three chords over 3, by both radii
        a, b = 1 - thickness / 2, 1 + thickness / 2
        areas = np.full(len(middle), (b * b - a * a) / 2 * np.sin(2 * half))
        x = middle * np.cos(half) * 2 / 3 * (b**3 - a**3) / (b**2 - a**2)
    above = np.cumsum(areas[::-1])[::-1], np.cumsum((areas * x)[::-1])[::-1]
    return inner, outer, *above


def thrusts(voussoirs, thickness, centred=False):
    """Least and greatest thrust over unit weight x t x depth x radius.

    The line of the least passes the extrados of the crown and the intrados of a joint, that of the greatest
    the extrados of the springing and the intrados of a joint.
    """
    inner, outer, area, moment = half_arch(voussoirs, thickness, centred)
    k = slice(0, -1)
    least = ((moment - area * inner[k, 0]) / (outer[-1, 1] - inner[k, 1])).max()
    springing = moment[0] - area[0] * outer[0, 0]
    above = slice(1, -1)
    greatest = ((springing - moment[1:] + area[1:] * inner[above, 0]) / inner[above, 1]).min()
    return least / thickness, greatest / thickness


def critical(voussoirs, centred=False):
    """Thickness over radius at which both are one."""
    return brentq(lambda t: np.subtract(*thrusts(voussoirs, t, centred)), 0.1, 0.12, xtol=1e-15, rtol=1e-14)


@pytest.mark.parametrize(
    ("centred", "thickness", "thrust"), [(True, 0.1074265, 0.6217715), (False, 0.1074780, 0.6208812)]
)
def test_closed_form_of_many_voussoirs(centred, thickness, thrust):
    """.107426 and .621772 with the mass on the centre line (Cocchetti, Colasante & Rizzi 2011).

    .107478 with the mass where it is (Milankovitch); its thrust is then .620881.
    """
    t = critical(4000, centred)
    assert t == pytest.approx(thickness, abs=1e-7)
    assert thrusts(4000, t, centred) == pytest.approx([thrust] * 2, abs=1e-6)


@pytest.mark.parametrize("centred", [False, True])
def test_arch_of_least_thickness_has_one_thrust(centred):
    """Spread or pushed together: the closed forms of its voussoirs, at the critical thickness one number."""
    voussoirs = 60
    thickness = critical(voussoirs, centred) * 1.0001  # it must stand
    arch = lb.structures.arch(
        lb.PointContact(2.0), radius=1.0, thickness=thickness, voussoirs=voussoirs, unit_weight=WEIGHT
    )
    unit = WEIGHT * thickness * np.ptp(arch.free_blocks[0].vertices[:, 1])
    if centred:  # the weight of each on the centre line
        angles = np.pi - (np.arange(voussoirs) + 0.5) * np.pi / voussoirs
        radius = np.sin(np.pi / voussoirs / 2) / (np.pi / voussoirs / 2)
        dead = sum(
            (
                lb.loads.force(block.name, (0, 0, -unit * np.pi / voussoirs),
                               at=(radius * np.cos(a), 0, radius * np.sin(a)))
                for block, a in zip(arch.free_blocks, angles, strict=True)
            ),
            lb.loads.Load(),
        )  # fmt: skip
        arch = lb.Model(arch.blocks, arch.supports, arch.interfaces, dead, arch.live)
    spread, pushed = (
        settlement(arch, "right support", (way, 0, 0), without_dilatancy=False) for way in (1, -1)
    )
    least, greatest = thrusts(voussoirs, thickness, centred)
    assert spread.lower / unit == pytest.approx(least, rel=1e-6)
    assert spread.upper / unit == pytest.approx(least, rel=1e-6)
    assert -pushed.upper / unit == pytest.approx(greatest, rel=1e-6)
    assert thrusts(voussoirs, critical(voussoirs, centred), centred) == pytest.approx([least] * 2, rel=2e-4)


def test_reaction_is_that_of_an_admissible_state():
    own = settling(lintel(JOINTS[0]), "right", DOWN)
    assert own.reaction(0.0) == own.held
    assert 0 < own.held < WEIGHT * LENGTH * DEPTH


@pytest.mark.parametrize("joint", JOINTS, ids=["point contact", "paper"])
def test_joints_of_a_settling_structure_have_states(joint):
    """The lintel lifts off one support's inner part and turns; the guide at its strength would be wrong."""
    found = settlement(lintel(joint), "right", DOWN)
    states = lb.interface_states(found.settling.model, found.result)
    assert states.state[:2].count("hinge") >= 1
    assert states.utilisation[-1] < 0.1


def two_stones(a, t):
    stones = [
        lb.Block.box("left", (1, 1, 1), (-a - 0.5, 0, -0.5 + t)),
        lb.Block.box("right", (1, 1, 1), (a + 0.5, 0, -0.5 + t)),
        lb.Block.box("one", (a, 1, t), (-a / 2, 0, t / 2), WEIGHT),
        lb.Block.box("two", (a, 1, t), (a / 2, 0, t / 2), WEIGHT),
    ]
    return model_of(stones, ["left", "right"], JOINTS[0])


def test_thrust_of_a_flat_arch_is_not_held_by_its_guide():
    """Two stones of 20 m x .1 m: thrust W a / 4 t = 50 W at the lower edges, below the support's centroid."""
    a, t = 20.0, 0.1
    spread = settlement(two_stones(a, t), "right", (1, 0, 0))
    thrust = 2 * WEIGHT * a * t * a / (4 * t)
    assert spread.nonassociated == pytest.approx(thrust, rel=1e-6)
    assert spread.upper == pytest.approx(thrust, rel=1e-6)
    rows = {row["answer"]: row["least_reaction"] for row in spread.rows()}
    assert list(rows) == ["associated, mechanism", "associated, stress state", "without dilatancy"]
    assert list(rows.values()) == [spread.lower, spread.upper, spread.nonassociated]
    assert f"least reaction of 'right': {thrust:.6g} to {thrust:.6g} N (associated), {thrust:.6g}" in str(
        spread
    )


@pytest.mark.parametrize("thickness", [0.1, 1.0], ids=["the guide turns", "nothing turns"])
def test_stones_between_abutments_that_close_in_jam(thickness):
    with pytest.raises(lb.errors.UnlimitedLoad, match=r"'right': .* the structure jams against this"):
        settlement(two_stones(2.0, thickness), "right", (-1, 0, 0))


def test_a_stone_propped_between_supports_is_not_said_to_jam_alone():
    """The pier may sink freely without dilatancy; with it no stress state of the strut is the last."""
    stones = [
        lb.Block.box("floor", (1.0, 1.0, 0.2), (0, 0, -0.1)),
        lb.Block.box("wall", (0.5, 1.0, 1.2), (-0.75, 0, 0.5)),
        lb.Block.box("pier", (0.5, 1.0, 1.2), (0.75, 0, 0.5)),
        lb.Block.box("stone", (1.0, 1.0, 1.0), (0, 0, 0.5), 20e3),
    ]
    model = model_of(stones, ["floor", "wall", "pier"], lb.PointContact(0.6), (1, 0, 0))
    with pytest.raises(lb.errors.UnlimitedLoad, match=r"'pier': .* between what settles and another support"):
        settlement(model, "pier", DOWN)


def test_only_support():
    model = lb.structures.block(JOINTS[0], width=1.0, height=1.0)
    with pytest.raises(lb.ModelError, match="the only support"):
        settlement(model, model.supports[0], DOWN)


@pytest.mark.parametrize("prestress", [0.0, 1e3, 5e3])
def test_prestress_between_block_and_support_is_within_the_tie(prestress):
    """Rod at x into the support that sinks: N (L - b) = W (L/2 - b) + T (x - b), reaction N - T."""
    model, x, most = lintel(JOINTS[0]), LENGTH - BEARING / 2, 6e3
    rod = tie(
        "lintel", (x, 0, DEPTH), "right", (x, 0, -0.9), area=1e-4, strength=most / 1e-4, prestress=prestress
    )
    found = settlement(reinforced(model, rod), "right", DOWN)
    normal = (WEIGHT * LENGTH * DEPTH * (LENGTH / 2 - BEARING) + most * (x - BEARING)) / (LENGTH - BEARING)
    assert [found.lower, found.upper, found.nonassociated] == pytest.approx([normal - most] * 3, rel=1e-6)


def test_remarks_on_a_load_factor_say_that_a_higher_one_is_a_smaller_reaction():
    found = settlement(lintel(lb.PointContact(0.6)), "right", DOWN)
    assert found.remarks == ()
    said = replace(found, result=replace(found.result, remarks=("mostly higher",))).remarks
    assert said == (
        "of the load factor of the settling, higher where the reaction is smaller: mostly higher",
    )


@pytest.mark.parametrize("direction", [(1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, -1.0)])
def test_a_springer_of_a_groin_vault_settles_and_so_does_its_image(direction):
    """The least reaction is the work of the weights per settlement, the force that the vault presses with.

    The stones balance, each assembled from the forces of its joints; its image in y = 0 has the same one.
    """
    vault = lb.structures.groin_vault(
        lb.PointContact(0.7), radius=1.0, thickness=0.3, length=2.8, courses=3, stone_length=0.8
    )
    found = settlement(vault, "right left support", direction, without_dilatancy=False)
    pair, blocks = found.bounds, {block.name: block for block in found.settling.model.blocks}
    weights = {block.name: np.array([0.0, 0.0, -block.weight]) for block in vault.free_blocks}
    rates = dict(zip(blocks, pair.displacement_rates[:, :3], strict=True))
    work = sum(weights[name] @ rates[name] for name in weights)
    settled = rates["right left support"] @ direction
    least = max(abs(found.lower), WEIGHT * 1e-6)
    assert work / settled == pytest.approx(found.lower, abs=1e-6 * least)
    force = {name: np.pad(weights.get(name, np.zeros(3)), (0, 3)) for name in blocks}
    for own, given in zip(vault.interfaces, pair.stress_resultants, strict=False):  # the guide comes last
        pushed, turned = given[:3] @ own.axes, given[3:] @ own.axes
        for name, sense in ((own.block_i, 1.0), (own.block_j, -1.0)):
            moment = turned + np.cross(own.centroid - blocks[name].centroid, pushed)
            force[name] += sense * np.concatenate([pushed, moment])
    total = sum(block.weight for block in vault.free_blocks)
    assert max(np.abs(force[name]).max() for name in weights) < 1e-9 * total
    assert force["right left support"][:3] @ direction == pytest.approx(found.upper, abs=1e-6 * least)
    image = settlement(
        vault, "right right support", np.multiply(direction, (1, -1, 1)), without_dilatancy=False
    )
    assert [image.lower, image.upper] == pytest.approx([found.lower, found.upper], abs=1e-6 * least)
