"""Least thickness of arches beside those of docs/validation.md, and its convergence with the voussoirs."""

from functools import partial

import numpy as np
import pytest
from least_thickness import (
    circular_half,
    elliptical_half,
    least_thickness,
    least_thickness_of_thrust_lines,
    vertical_half,
)

import limitblocks as lb
from limitblocks import structures

FRICTION = 0.8
COUNTS = (25, 51)


def extrapolated(counts, values):
    """Limit of values whose error goes with the square of the voussoirs' size, from the last two."""
    (m, n), (a, b) = counts[-2:], values[-2:]
    return b + (b - a) / ((n / m) ** 2 - 1)


def test_thrust_lines_agree_with_the_published_least_thickness():
    """The reference of the other shapes: 0.1075 and 0.107426 as above."""
    true = least_thickness_of_thrust_lines(circular_half, 0.09, 0.13)
    centreline = least_thickness_of_thrust_lines(partial(circular_half, lumped=True), 0.09, 0.13)
    assert true == pytest.approx(0.1075, abs=5e-5)
    assert centreline == pytest.approx(0.107426, abs=1e-6)


def test_vertical_joints_need_a_thicker_semicircle():
    """t/R = 0.1095: Makris & Alexakis (2013), Arch. Appl. Mech. 83, 1511-1533, who let nothing slide."""
    limit = 0.1095
    assert least_thickness_of_thrust_lines(vertical_half, 0.09, 0.13) == pytest.approx(limit, abs=5e-5)

    def build(thickness, voussoirs):
        joint = lb.PointContact(20.0)
        return structures.arch(
            joint, radius=1.0, thickness=thickness, voussoirs=voussoirs, stereotomy="vertical"
        )

    found = [least_thickness(partial(build, voussoirs=n), 1.05 * limit) for n in COUNTS]
    assert extrapolated(COUNTS, found) == pytest.approx(limit, abs=1e-4)
    assert found == pytest.approx([limit] * 2, rel=5e-3)  # 1 to 1.4 % with one chord over the last voussoir


def shape(name, size):
    """A builder of blocks (thickness, voussoirs) and one of half a continuous ring (thickness)."""
    joint = lb.PointContact(FRICTION)
    if name == "circular":
        build = partial(structures.arch, joint, radius=1.0, embrace=size)
        return build, partial(circular_half, embrace=size)
    if name == "pointed":
        shift = (size**2 - 1.0) / 2.0
        build = partial(structures.pointed_arch, joint, span=2.0, rise=size, facets=4)
        return build, partial(circular_half, radius=1.0 + shift, shift=shift)
    build = partial(structures.elliptical_arch, joint, span=2.0, rise=size)
    return build, partial(elliptical_half, a=1.0, b=size)


@pytest.mark.parametrize(
    ("name", "size"),
    [
        ("circular", np.radians(157.5)),
        ("pointed", np.sqrt(3.0)),  # equilateral: the apex rises
        ("elliptical", 0.6),
        ("elliptical", 1.3),
    ],
)
def test_least_thickness_is_that_of_thrust_lines(name, size):
    """Heyman's assumptions, infinitely many voussoirs; 60 have an error of order (1 / 60)^2."""
    build, half = shape(name, size)
    limit = least_thickness_of_thrust_lines(half, 0.01, 0.4)
    thicknesses = least_thickness(lambda thickness: build(thickness=thickness, voussoirs=60), 1.02 * limit)
    assert thicknesses == pytest.approx(limit, rel=20.0 / 60**2)
