"""Curves of a structure are those of its copies, however they lie: steps and ends are shares of its size."""

import numpy as np
import pytest
from few_blocks import sliding_block
from images import image
from scipy.spatial.transform import Rotation
from settling_blocks import SPREAD, arch

from limitblocks.practice import capacity_curve, settlement_to_collapse
from limitblocks.practice.displaced import assembly_of

TURNS = [
    pytest.param(Rotation.from_euler(axis, angle, degrees=True).as_matrix(), id=f"{axis} {angle}")
    for axis, angle in (("z", 20), ("z", 45), ("x", 30))
]


@pytest.mark.parametrize("turn", TURNS)
def test_the_size_of_a_structure_is_the_largest_distance_of_its_corners(turn):
    model = sliding_block()  # on a base of the same plan, a unit square
    for one in (model, image(model, turn, (5e5, 4.6e6, 0.0))):
        assert assembly_of(one).size == pytest.approx(np.sqrt(1 + 1 + 0.5**2), rel=1e-8)


@pytest.mark.parametrize("turn", TURNS)
def test_a_capacity_curve_turns_with_the_structure(turn):
    """A ring whose voussoirs open, so that contacts are brought together at each step."""
    ring, _ = arch(4, 0.3)
    curve = capacity_curve(ring, steps=4, largest=0.1)
    block, point = curve.control.block, turn @ curve.control.point
    again = capacity_curve(image(ring, turn), control=(block, point), steps=4, largest=0.1)
    assert len(curve.points) >= 3
    assert again.displacements == pytest.approx(curve.displacements, rel=1e-7)
    assert again.load_factors == pytest.approx(curve.load_factors, rel=1e-7)


@pytest.mark.parametrize("turn", TURNS)
def test_a_settlement_turns_with_the_structure(turn):
    ring, _ = arch(2, 0.3)
    curves = [
        settlement_to_collapse(one, "right support", way, largest=0.05)
        for one, way in ((ring, SPREAD), (image(ring, turn), turn @ SPREAD))
    ]
    assert len(curves[0].points) > 3
    for name in ("displacements", "reactions"):
        first, second = (getattr(curve, name) for curve in curves)
        assert second == pytest.approx(first, rel=1e-7)
