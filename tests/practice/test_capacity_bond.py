"""Bonds of joints that have moved: cohesion and tensile strength hold until a joint opens or slides."""

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.practice import capacity_curve, settlement_to_collapse

B, H = 0.2, 1.0
WEIGHT = 20e3 * B * H  # per m of depth
COHESION, TENSION = 3e3, 2e3
PUSH = lb.mass_proportional((1, 0, 0))


def followed(width, height, largest=np.inf, **joint):
    """The curve of one block on a floor, and the load factors and turns about its toe."""
    stones = [
        lb.Block.box("floor", (6, 3, 0.2), (0, 0, -0.1)),
        lb.Block.box("block", (width, 1, height), (0, 0, height / 2), 20e3),
    ]
    found = lb.find_interfaces(stones, lb.OrdunaLourenco(cohesion=COHESION, **joint))
    model = lb.Model(stones, ["floor"], found, lb.self_weight(), PUSH)
    curve = capacity_curve(model, control=("block", (width / 2, 0, height)), steps=3, largest=largest)
    assert "floor|block loses its bond" in curve.points[1].changes
    return curve, curve.load_factors, np.arcsin(np.minimum(curve.displacements / height, 1.0))


def test_a_joint_that_opens_has_no_tensile_strength_any_more():
    """alpha = (W + A ft) (b / 2) / (W h / 2) before, tan(atan(b / h) - phi) from then on."""
    curve, found, phi = followed(B, H, friction=0.8, tensile_strength=TENSION)
    assert found[0] == pytest.approx((WEIGHT + B * TENSION) * B / (WEIGHT * H), rel=1e-6)
    assert found[1:] == pytest.approx(np.tan(np.arctan(B / H) - phi[1:]), abs=1e-9)
    assert curve.zero == pytest.approx(H * np.sin(np.arctan(B / H)), rel=1e-8)


def test_nor_has_one_that_crushes():
    """The stress block between both strengths before, that of W alone from then on."""
    strength = 5 * WEIGHT / B
    curve, found, phi = followed(B, H, friction=0.8, tensile_strength=TENSION, compressive_strength=strength)
    force, share = WEIGHT + B * TENSION, WEIGHT / (B * strength)
    moment = B / 2 * force * (1 - force / (B * (strength + TENSION)))
    assert found[0] == pytest.approx(moment / (WEIGHT * H / 2), rel=1e-6)
    s, c = np.sin(phi[1:]), np.cos(phi[1:])
    assert found[1:] == pytest.approx((B * c - H * s - share * B) / (B * s + H * c), abs=1e-8)
    assert curve.zero == pytest.approx(H * np.sin(np.arccos(share * B / np.hypot(B, H)) - np.arctan2(H, B)))


def test_a_joint_that_slides_has_no_cohesion_any_more():
    """alpha = mu + c A / W before, mu from then on."""
    _, found, _ = followed(1.0, 0.4, largest=0.2, friction=0.2)
    assert found[0] == pytest.approx(0.2 + COHESION / (20e3 * 0.4), rel=1e-6)
    assert found[1:] == pytest.approx(0.2, rel=1e-6)


def test_a_joint_at_rest_keeps_its_bond():
    stones = [
        lb.Block.box("floor", (3, 3, 0.2), (0, 0, -0.1)),
        lb.Block.box("below", (1.0, 1, 0.2), (0, 0, 0.1), 20e3),
        lb.Block.box("above", (B, 1, H), (0, 0, 0.2 + H / 2), 20e3),
    ]
    found = lb.find_interfaces(stones, lb.OrdunaLourenco(0.8, cohesion=COHESION, tensile_strength=TENSION))
    model = lb.Model(stones, ["floor"], found, lb.self_weight(), PUSH)
    last = capacity_curve(model, steps=2, largest=0.02).points[-1].model
    assert {own.name: own.joint.cohesion for own in last.interfaces} == {
        "floor|below": COHESION,
        "below|above": 0.0,
    }


def test_a_beam_whose_support_slides_away_loses_its_bond():
    """The support is dragged back by mu N + c A at first, then by mu N; N from moments on the left."""
    stones = [
        lb.Block.box("left", (0.5, 1, 0.5), (-1.75, 0, -0.25)),
        lb.Block.box("right", (0.5, 1, 0.5), (1.75, 0, -0.25)),
        lb.Block.box("beam", (4, 1, 0.4), (0, 0, 0.2), 20e3),
    ]
    held, bonded = lb.PointContact(2.0), lb.OrdunaLourenco(0.3, cohesion=COHESION)
    found = lb.find_interfaces(stones, lambda a, b: bonded if "right" in (a.name, b.name) else held)
    model = lb.Model(stones, ["left", "right"], found, lb.self_weight(), PUSH)
    curve = settlement_to_collapse(model, "right", (1, 0, 0), step=0.05, largest=0.1)
    drag = -curve.reactions
    weight = 20e3 * 4 * 0.4
    least, most = weight * 1.5 / 3.5, weight * 2.0 / (3.5 + curve.displacements)
    assert drag[0] >= 0.3 * least + COHESION * 0.5 * (1 - 1e-6)
    assert (drag[1:] <= 0.3 * most[1:] * (1 + 1e-6)).all()
    assert any("loses its bond" in said for said in curve.points[1].changes)
