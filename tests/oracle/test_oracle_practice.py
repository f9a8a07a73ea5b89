"""Water in joints and prestress against the oracle: conic programs in 50-digit arithmetic."""

from dataclasses import replace

import pytest
from coulomb import truth
from stones import model_of

import limitblocks as lb
from limitblocks.practice import reinforced, tie, uplift


def tower(level, share):
    """Three stones with an inclined joint, water up to `level`."""
    heights = [(0.0, 1.0), (1.0, 1.9), (1.9, 3.0)]
    stones = [lb.Block.box("base", (2, 1, 0.5), (0, 0, -0.25))]
    for k, (low, high) in enumerate(heights):
        tilt = [0.1 * k, 0.1 * (k + 1)]
        section = [(-0.5, low - tilt[0]), (0.5, low), (0.5, high), (-0.5, high - tilt[1])]
        stones.append(lb.Block.prism(f"stone {k + 1}", section, (-0.4, 0.4), 20e3))
    model = model_of(stones, ["base"], lb.PointContact(0.7), (1, 0.2, 0))
    return replace(model, dead=model.dead + uplift(model, level, share=share))


@pytest.mark.parametrize(("level", "share"), [(1.2, 1.0), (2.5, 0.6)])
def test_uplift(level, share):
    model = tower(level, share)
    expected = truth(model)
    found = lb.bounds(model)
    assert expected.verdict == "number"
    assert found.upper == pytest.approx(expected.load_factor, rel=1e-6)
    assert found.upper < 0.97 * lb.bounds(tower(1e-3, 1.0)).upper


def test_prestress():
    """A tie across all stones whose prestress is all it has left: the dead loads alone."""
    model = tower(1e-3, 1.0)
    rod = tie("stone 3", (0, 0, 2.5), "base", (-0.2, 0, -0.2), area=1e-4, strength=2e8, prestress=15e3)
    loads = rod.loads({block.name for block in model.free_blocks})
    pressed = replace(model, dead=model.dead + loads)
    expected = truth(pressed).load_factor
    assert lb.bounds(pressed).upper == pytest.approx(expected, rel=1e-6)
    assert expected > 1.1 * truth(model).load_factor
    assert lb.bounds(reinforced(model, rod)).upper >= expected * (1 - 1e-6)
