"""Strips of opened joints along their closed corners."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.practice.touching import STRIP, narrowed

WIDE, DEEP = 1.2, 0.8


@pytest.mark.parametrize("apart", [0.0, 1e-12, 1e-10])
def test_corners_that_an_overlay_left_next_to_each_other_are_one_in_a_strip(apart):
    """An opened joint shut along x = -WIDE/2, with two corners next to each other on the side that opened."""
    model = lb.structures.block(lb.OrdunaLourenco(0.5), width=WIDE, height=1.0, depth=DEEP)
    (interface,) = model.interfaces
    a, b = WIDE / 2, DEEP / 2
    flat = np.array([[-a, -b], [0.0, -b], [apart, -b], [a, -b], [a, b], [apart, b], [0.0, b], [-a, b]])
    axes = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    joint = replace(interface, polygon=flat, axes=axes)
    gap = np.where(flat[:, 0] > -a, 1e-3 * (flat[:, 0] + a), 0.0)
    opened = SimpleNamespace(interface=joint, ways=np.column_stack([0.0 * gap, 0.0 * gap, gap]))
    strip = narrowed(opened, 1.0)
    assert replace(model, interfaces=(strip,)).interfaces  # sound, as the model says
    sizes = np.ptp(strip.polygon, axis=0)
    assert sorted(sizes) == pytest.approx([STRIP * a, DEEP])
    assert strip.centroid[0] == pytest.approx(interface.centroid[0] - a + STRIP * a / 2)
