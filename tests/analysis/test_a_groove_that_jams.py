"""A stone in a groove of 60 degrees, pushed across: it slides up at tan(60 + phi), or jams from 30 on."""

import numpy as np
import pytest
from stones import model_of

import limitblocks as lb

SLOPE = np.radians(60.0)
JAMS = 1.0 / np.tan(SLOPE)  # friction: Coulomb's cone of the far face holds the push, however large


def groove(joint, skew=0.0):
    """A stone between two supports; `skew`, m, of one end of the groove leaves no mirror plane."""
    rise = 0.6 * np.tan(SLOPE)
    sides = {
        "left": [(-2.0, 0.0), (0.0, 0.0), (-0.6, rise), (-2.0, rise)],
        "right": [(0.0, 0.0), (2.0, 0.0), (2.0, rise), (0.6, rise)],
        "stone": [(0.0, 0.0), (0.6, rise), (-0.6, rise)],
    }
    stones = [lb.Block.prism(name, corners, (0.0, 1.0), 20e3) for name, corners in sides.items()]
    if skew:
        stones[2] = lb.Block.prism("stone", sides["stone"], (0.0, 1.0 - skew), 20e3)
    return model_of(stones, ["left", "right"], joint)


@pytest.mark.parametrize(("joint", "skew"), [(lb.PointContact, 0.0), (lb.OrdunaLourenco, 0.1)])
def test_it_slides_up_or_jams(joint, skew):
    model = groove(joint(0.9 * JAMS), skew)
    expected = np.tan(SLOPE + np.arctan(0.9 * JAMS))
    assert lb.nonassociated(model).load_factor == pytest.approx(expected, rel=1e-7)
    jammed = groove(joint(1.1 * JAMS), skew)
    for analysis in (lb.nonassociated, lb.load_path):
        with pytest.raises(lb.errors.UnlimitedLoad, match="the blocks jam against it"):
            analysis(jammed)


def test_a_range_of_what_jams_has_no_load_path():
    found = lb.load_factor_range(groove(lb.PointContact(1.1 * JAMS)), paths=2, mechanisms=0)
    assert found.load_path is None
    assert not found.answers


@pytest.mark.parametrize("calls", [100, 400])
def test_who_interrupts_is_told_no_end_of_the_load(calls):
    """In the plane, and in the whole structure after its increments in the plane have climbed."""
    told = []

    def stop(now):
        told.append(now)
        if len(told) == calls:
            raise KeyboardInterrupt

    with pytest.raises(lb.NotConverged, match=r"^interrupted"):
        lb.nonassociated(groove(lb.PointContact(1.1 * JAMS)), progress=stop)
