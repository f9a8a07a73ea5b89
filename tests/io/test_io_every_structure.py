"""Every structure through every format: the same interfaces, and the same bounds."""

from dataclasses import replace

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.geometry.polygon import areas
from limitblocks.structures import EXAMPLES

JOINT = lb.PointContact(friction=0.7)
LIVE = lb.mass_proportional((0.6, 0.8, 0.0))
EXACT = [".obj", ".stl", ".ply", ".dxf", ".3dm", ".json"]
PRECISION = dict.fromkeys(EXACT, 1e-9) | {".glb": 1e-6}  # glTF is single precision by its standard
NAMES = list(EXAMPLES)


def example(name):
    """The structure with all the interfaces that its blocks have; a two-leaf wall leaves out some."""
    model = EXAMPLES[name](JOINT)
    interfaces = lb.find_interfaces(model.blocks, JOINT)
    return replace(model, interfaces=interfaces, dead=lb.self_weight(), live=LIVE)


def through(model, file):
    """The model of the blocks alone, written and read; supports are where they were."""
    held = np.array([block.centroid for block in model.blocks if block.name in model.supports])

    def supported(block):
        return np.abs(held - block.centroid).max(axis=1).min() < 1e-4

    lb.files.write_blocks(model, file)
    return lb.read(file, joint=JOINT, supports=supported, unit_weight=20e3, live=LIVE)


def total_area(model):
    return sum(areas(interface.polygon) for interface in model.interfaces)


@pytest.mark.parametrize("suffix", PRECISION)
@pytest.mark.parametrize("name", NAMES)
def test_interfaces_survive(tmp_path, name, suffix):
    model = example(name)
    again = through(model, tmp_path / f"structure{suffix}")
    assert len(again.blocks) == len(model.blocks)
    assert len(again.interfaces) == len(model.interfaces)
    assert total_area(again) == pytest.approx(total_area(model), rel=PRECISION[suffix])


@pytest.mark.parametrize("k", range(len(NAMES)), ids=NAMES)
def test_bounds_survive(tmp_path, k):
    """Each structure through one of the formats, in turn."""
    model = example(NAMES[k])
    again = through(model, tmp_path / f"structure{EXACT[k % len(EXACT)]}")
    before, after = lb.bounds(model), lb.bounds(again)
    assert after.lower == pytest.approx(before.lower, abs=1e-6)
    assert after.upper == pytest.approx(before.upper, abs=1e-6)
