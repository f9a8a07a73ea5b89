"""Published arches: least thickness under self weight, and Oppenheim's arch under horizontal load."""

from dataclasses import replace

import numpy as np
import pytest

import limitblocks as lb
from limitblocks import structures
from limitblocks.structures.cases import COCCHETTI_RIZZI, OPPENHEIM

RADIUS = 10.0
JOINT_TYPES = [lb.OrdunaLourenco, lb.PointContact]


def crown_force(model):
    """Load factor of a force on the keystone; one where the arch just stands under its dead load alone.

    The dead load is taken as lifted by the same force. The force works on the symmetrical mechanism of the
    dead load, so that the load factor passes one at the least thickness with a finite slope.
    """
    keystone = model.free_blocks[len(model.free_blocks) // 2]
    weight = 0.02 * sum(block.weight for block in model.free_blocks)
    push = lb.loads.force(keystone.name, (0, 0, -weight), at=keystone.centroid)
    result = lb.bounds(replace(model, dead=model.dead + (-1.0) * push, live=push))
    assert result.gap < 1e-6
    return result.lower


def is_least_within(joint, voussoirs, low, high, change=lambda model: model):
    """Whether the least t/R is between `low` and `high`: the arch needs help at one and none at the other."""
    need = [
        crown_force(
            change(structures.arch(joint, radius=RADIUS, thickness=ratio * RADIUS, voussoirs=voussoirs))
        )
        for ratio in (low, high)
    ]
    return need[0] < 1.0 < need[1]


def lumped_on_the_centreline(model):
    """Same angles, but each weight proportional to its angle and acting on the centreline."""
    n = len(model.free_blocks)
    angles = (np.arange(n) + 0.5) * np.pi / n - np.pi / 2
    weight = np.mean([block.weight for block in model.free_blocks])
    points = RADIUS * np.column_stack([np.sin(angles), np.zeros(n), np.cos(angles)])
    loads = [
        lb.loads.force(block.name, (0, 0, -weight), at=point)
        for block, point in zip(model.free_blocks, points, strict=True)
    ]
    return replace(model, dead=sum(loads, lb.loads.Load()))


@pytest.mark.parametrize("joint_type", JOINT_TYPES)
def test_least_thickness_of_27_voussoirs(joint_type):
    """Semicircular arch of 27 voussoirs, friction 0.5: t/R between 0.1067 and 0.1068."""
    assert is_least_within(joint_type(0.5), 27, 0.1067, 0.1068)


def test_least_thickness_of_many_voussoirs():
    """Milankovitch (1907), true centroids: t/R = 0.1075."""
    assert is_least_within(lb.PointContact(0.7), 201, 0.10745, 0.10755)


@pytest.mark.parametrize(
    ("friction", "expected"), [(k, one.value) for k, one in COCCHETTI_RIZZI["t/R"].items()]
)
def test_least_thickness_with_weights_on_the_centreline(friction, expected):
    """Cocchetti & Rizzi (2020), Table 3: t/R by friction, many voussoirs."""
    low, high = (1 - 2e-4) * expected, (1 + 2e-4) * expected  # 201 voussoirs are not infinitely many
    assert is_least_within(lb.PointContact(friction), 201, low, high, lumped_on_the_centreline)


def test_thrust_and_haunch_hinge_of_the_thinnest_arch():
    """Cocchetti & Rizzi (2020), Table 3: thrust 0.621772 gamma t d R, hinge 54.50 deg from the crown."""
    n = 201
    model = lumped_on_the_centreline(
        structures.arch(lb.PointContact(0.7), radius=RADIUS, thickness=0.10743 * RADIUS, voussoirs=n)
    )
    weight_per_angle = sum(block.weight for block in model.free_blocks) / np.pi
    keystone = model.free_blocks[n // 2]
    push = lb.loads.force(keystone.name, (0, 0, -0.02 * np.pi * weight_per_angle), at=keystone.centroid)
    result = lb.bounds(replace(model, dead=model.dead + (-1.0) * push, live=push))
    assert result.lower == pytest.approx(1.0, abs=0.01)
    thrust = COCCHETTI_RIZZI["thrust"]
    horizontal = [
        abs(i.axes.T @ Q[:3])[0] for i, Q in zip(model.interfaces, result.stress_resultants, strict=True)
    ]
    assert np.array(horizontal) / weight_per_angle == pytest.approx(thrust.value, abs=thrust.tolerance)
    spin = {b.name: u[4] for b, u in zip(model.blocks, result.displacement_rates, strict=True)}
    opening = np.array([abs(spin[i.block_j] - spin[i.block_i]) for i in model.interfaces])
    angle = np.degrees([np.arctan2(abs(i.centroid[0]), i.centroid[2]) for i in model.interfaces])
    haunch = (angle > 20) & (angle < 80)
    assert np.average(angle[haunch], weights=opening[haunch]) == pytest.approx(
        COCCHETTI_RIZZI["haunch"].value, abs=180 / n
    )


@pytest.mark.parametrize("joint_type", JOINT_TYPES)
def test_an_arch_thinner_than_the_least_thickness_falls(joint_type):
    thin = structures.arch(joint_type(0.5), radius=RADIUS, thickness=1.066, voussoirs=27)
    with pytest.raises(lb.errors.NoEquilibrium):
        lb.bounds(thin)
    thick = structures.arch(joint_type(0.5), radius=RADIUS, thickness=1.069, voussoirs=27)
    assert lb.bounds(thick).lower > 0.0


@pytest.mark.parametrize("joint_type", JOINT_TYPES)
def test_oppenheim(joint_type):
    """Oppenheim (1992): R = 10, t/R = 0.15, embrace 157.5 deg, 7 voussoirs: 0.37 g."""
    model = structures.arch(
        joint_type(0.7), radius=RADIUS, thickness=1.5, voussoirs=7, embrace=np.radians(157.5)
    )
    result = lb.bounds(model)
    assert result.lower == pytest.approx(OPPENHEIM.value, abs=OPPENHEIM.tolerance)
    assert result.gap < 1e-6
