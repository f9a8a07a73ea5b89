"""Load factors along a push the other way, and what begins to flow before collapse."""

from dataclasses import replace

import pytest

import limitblocks as lb
from limitblocks.reports.scene import scene


def test_an_acceleration_below_zero_is_rounded_to_the_safe_side():
    """What is certified is cut towards zero, an upper estimate away from it: 9.80665 times .29955395."""
    arch = lb.structures.arch(lb.PointContact(0.7), radius=2.0, thickness=0.4, voussoirs=9)
    back = replace(arch, live=-1.0 * lb.mass_proportional((1, 0, 0)))
    for result, said in (
        (lb.nonassociated(back), "-0.2995 g = -2.937 m/s²"),
        (lb.bounds(back), "-0.2996 g = -2.938 m/s²"),
    ):
        assert said in lb.report(back, result).text


@pytest.mark.parametrize(("dead", "live"), [(1.0, 1.0), (2.0, 2.0), (1.35, 1.0), (0.9, 0.9)])
def test_no_acceleration_is_said_of_masses_that_weigh_more_than_once(dead, live):
    """A block of .5 m by 1 m tips at .5 g whatever its mass; with both loads twice it was told as 1 g."""
    block = lb.structures.block(lb.PointContact(0.7), width=0.5, height=1.0)
    model = replace(block, dead=dead * block.dead, live=live * block.live)
    solved = lb.nonassociated(model)
    assert solved.load_factor * live / dead == pytest.approx(0.5)
    text = " ".join(lb.report(model, solved).text.split("Assumptions")[0].split())
    assert ("acceleration along +X of 0.5000 g" in text) == (dead == 1.0)
    assert ("acceleration" in text) == (dead == 1.0)


@pytest.mark.parametrize("joint", [lb.PointContact(0.7), lb.OrdunaLourenco(0.7, compressive_strength=2e6)])
def test_what_begins_to_flow_on_the_way_is_named_though_it_stops(joint):
    model = lb.structures.column(joint, count=4, width=0.5, height=0.4)
    path = lb.load_path(model)
    drawn = scene(model, [path], "")
    names = [one.name for one in model.interfaces]
    began = 0
    for step, shown in zip(path.steps[:-1], drawn["results"][0]["steps"], strict=False):
        for name, modes in zip(names, shown["modes"], strict=True):
            began += len(modes)
            assert sorted(drawn["modes"][k] for k in modes) == sorted(
                str(mode) for where, mode in step.active if where == name
            )
    assert began
