"""Sheets between stones: no contact goes through them."""

import json
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import limitblocks as lb

UNIT = (1.0, 1.0, 1.0)


box = lb.Block.box


def ends(items):
    return {(one.block_i, one.block_j) for one in items}


def sheet(thickness, size=1.0):
    """A cube on a sheet on a cube: three blocks."""
    return [
        box("low", UNIT, (0, 0, -0.5)),
        box("sheet", (size, 1.0, thickness), (0, 0, thickness / 2), 0.0),
        box("high", UNIT, (0, 0, 0.5 + thickness), 20e3),
    ]


def load_factor(blocks, joints, **tolerances):
    """Least friction counts: each interface with the sheet has its own joint."""
    contacts = lb.find_contacts(blocks, None, **tolerances)
    contacts.require()
    interfaces = [replace(i, joint=joints["sheet" in i.name]) for i in contacts.interfaces]
    live = lb.mass_proportional((1, 0, 0))
    return lb.bounds(lb.Model(blocks, ["low"], interfaces, lb.self_weight(), live)).lower


@pytest.mark.parametrize("thickness", [2e-4, 9e-4, 1.1e-3, 5e-3])
@pytest.mark.parametrize("gap", [None, 1e-2])
def test_no_contact_through_a_sheet_thinner_than_the_gap(thickness, gap):
    joints = {True: lb.PointContact(0.1), False: lb.PointContact(0.6)}
    blocks = sheet(thickness)
    assert load_factor(blocks, joints, gap=gap) == pytest.approx(0.1, abs=1e-6)
    found = lb.find_contacts(blocks, None, gap=gap)
    assert ends(found.interfaces) == {("low", "sheet"), ("sheet", "high")}
    assert found.near_misses == ()
    within = thickness < 1e-3 * (1.0 if gap is None else 10.0)
    assert [(one.between, one.gap) for one in found.through] == [("sheet", pytest.approx(thickness))] * within
    lines = [f"no contact where a third block lies between: {one}" for one in found.through]
    assert found.warnings == lines


def test_no_contact_through_a_sheet_of_one_outline_with_both_blocks():
    # GEOS 3.14 gives three points for what these triangles share
    outline = [(-1.0826224749179432, 1.5906080059394767), (-1.6236903546688657, -0.9961253203921594)]
    outline += [(-1.297334139339837, -1.411874789744348)]
    turn = np.array(
        [
            [-0.06552653773768188, -0.7321911501966856, -0.6779398147518457],
            [-0.9657541721699012, -0.12439471742113245, 0.2276946051494096],
            [-0.2510481065225171, 0.6696432437136743, -0.6989655029828636],
        ]
    )
    place = np.array([-7.202242697362427, 3.158860022483715, -14.325253506523497])
    heights = {"low": (0, 1), "sheet": (1, 1.003), "high": (1.003, 2)}
    faces = ((2, 1, 0), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5))
    blocks = []
    for name, levels in heights.items():
        corners = np.concatenate([np.column_stack([outline, np.full(3, z)]) for z in levels])
        blocks.append(lb.Block(name, corners @ turn.T + place, faces, 1e4))
    found = lb.find_contacts(blocks, None, gap=1e-2)
    assert ends(found.interfaces) == {("low", "sheet"), ("sheet", "high")}


def test_a_sheet_under_a_part_holds_all_apart():
    found = lb.find_contacts(sheet(9e-4, size=0.5), None)
    assert ends(found.interfaces) == {("low", "sheet"), ("sheet", "high")}


def test_sheets_on_one_another_hold_apart():
    blocks = [
        box("low", UNIT, (0, 0, -0.5)),
        *(box(f"sheet {k}", (1.0, 1.0, 2e-4), (0, 0, (k + 0.5) * 2e-4)) for k in range(3)),
        box("high", UNIT, (0, 0, 0.5 + 6e-4)),
    ]
    found = lb.find_contacts(blocks, None, gap=2e-3)
    assert ends(found.interfaces) == {
        ("low", "sheet 0"), ("sheet 0", "sheet 1"), ("sheet 1", "sheet 2"), ("sheet 2", "high")
    }  # fmt: skip


@settings(max_examples=10, deadline=None)
@given(seed=st.integers(0, 2**31))
def test_stones_side_by_side_are_not_between(seed):
    """A third stone that touches both, beside the joint, holds nothing apart."""
    rng = np.random.default_rng(seed)
    a, b = rng.uniform(0.2, 0.8, 2)
    blocks = [
        box("ground", (2.0, 1.0, 1.0), (0, 0, -0.5)),
        box("left", (1.0 + a - b, 1.0, 1.0), ((-1.0 + a - b) / 2, 0, 0.5)),
        box("right", (1.0 - a + b, 1.0, 1.0), ((1.0 + a - b) / 2, 0, 0.5)),
        box("top", (2.0, 1.0, 0.3), (0, 0, 1.15)),
    ]
    found = lb.find_contacts(blocks, None, gap=2e-2)
    assert (len(found.interfaces), found.through) == (5, ())


def test_findings_are_plain_data():
    found = lb.find_contacts(sheet(9e-4), None)
    again = json.loads(json.dumps(found.to_dict()))
    (one,) = again["through"]
    assert one == {"block_i": "low", "block_j": "high", "between": "sheet", "gap": pytest.approx(9e-4)}
    assert again["tolerances"] == {"gap": 1e-3, "angle": 1e-2, "width": 1e-3, "accuracy": None}
