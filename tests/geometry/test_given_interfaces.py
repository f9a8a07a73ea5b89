"""Interfaces given by hand: numbers that are wrong are refused, sound ones count in any orientation."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import limitblocks as lb

BLOCKS = [
    lb.Block.box("ground", (4, 4, 1), (0, 0, -0.5)),
    lb.Block.box("stone", (1, 1.5, 2), (0, 0, 1), unit_weight=20e3),
]
SQUARE = np.array([(0.5, -0.75), (0.5, 0.75), (-0.5, 0.75), (-0.5, -0.75)])
SHARE = 0.3  # of the crushing force, 60 kN on 1.5 m2
CRUSHES = lb.OrdunaLourenco(2.0, compressive_strength=40e3 / SHARE)
OWN = lb.Interface("ground", "stone", np.zeros(3), np.eye(3), SQUARE, CRUSHES)
TURN = np.array([(0.8, 0.6), (-0.6, 0.8)])
TABLE = lb.joints.Materials({"stone": lb.joints.Material(joint=CRUSHES)})
OVER = np.diag([1.0, -1.0, -1.0])


def model(*interfaces):
    return lb.Model(BLOCKS, ["ground"], interfaces, lb.self_weight(), lb.mass_proportional((1, 0, 0)))


def turned(interface):
    axes = interface.axes.copy()
    axes[:2] = TURN @ axes[:2]
    return replace(interface, axes=axes, polygon=interface.polygon @ TURN.T)


def reversed_(interface):
    polygon = (interface.polygon * (1, -1))[::-1]
    return lb.Interface(
        "stone", "ground", interface.centroid, OVER @ interface.axes, polygon, interface.joint
    )


@pytest.mark.parametrize("given", [OWN, turned(OWN), reversed_(OWN), reversed_(turned(OWN))])
def test_any_orientation_gives_the_same(given):
    """Alpha = (b / h) (1 - n); the force on the ground is the weight downwards."""
    found = lb.bounds(model(given))
    assert found.lower == pytest.approx(0.5 * (1 - SHARE), rel=1e-6)
    force = lb.interface_states(model(given), found).force[0] * (1.0 if given.block_i == "ground" else -1.0)
    assert force[2] == pytest.approx(60e3, rel=1e-6)
    assert force[0] == pytest.approx(-60e3 * found.lower, rel=1e-5)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (replace(OWN, axes=2 * np.eye(3)), "off orthonormal by 3"),
        (replace(OWN, axes=np.diag([1.0, 1.0, -1.0])), "left-handed"),
        (replace(OWN, axes=np.full((3, 3), np.nan)), "off orthonormal by nan"),
        (replace(OWN, polygon=SQUARE[::-1]), "not counter-clockwise: its area is -1.5 m2"),
        (replace(OWN, polygon=SQUARE + 0.1), "is 0.1 m from its origin"),
        (replace(OWN, polygon=SQUARE[[0, 1, 3, 2]]), "not counter-clockwise"),
        (replace(OWN, polygon=np.zeros((3, 3))), "have shapes"),
        (replace(OWN, joint=SimpleNamespace(friction=0.5)), "cannot be hashed; expected a frozen dataclass"),
        (replace(OWN, joint=TABLE), "expected a frozen dataclass, or Materials.between"),
    ],
)
def test_numbers_that_are_wrong_are_refused(given, said):
    with pytest.raises(lb.ModelError, match=r"interface ground\|stone: ") as error:
        model(given)
    assert said in str(error.value)


@pytest.mark.parametrize(
    "again", [OWN, turned(OWN), reversed_(OWN), replace(OWN, centroid=np.array([0.3, 0, 0]))]
)
def test_a_contact_area_given_twice_is_refused(again):
    with pytest.raises(lb.ModelError, match="one contact area is given twice"):
        model(OWN, again)


def test_halves_side_by_side_and_other_joints_are_no_second_area():
    halves = [replace(OWN, centroid=np.array([x, 0, 0]), polygon=SQUARE * (0.5, 1.0)) for x in (-0.25, 0.25)]
    model(*halves)
    model(OWN, replace(OWN, joint=lb.PointContact(0.3)))
    held = lb.practice.strip(OWN, (-0.5, 0, 0), width=0.1, capacity=1e3)
    lb.practice.reinforced(model(OWN), held, held)
