"""Walls of two leaves, towers, buttresses, cantilever stairs."""

from dataclasses import replace

import numpy as np
import pytest
from stones import volume

import limitblocks as lb
from limitblocks import structures

JOINT = lb.OrdunaLourenco(0.7)
OUT = (0.0, 1.0, 0.0)


def leaves(**change):
    given = {"length": 1.6, "courses": 6, "block_length": 0.4, "block_height": 0.2, "thickness": 0.15}
    return structures.two_leaf_wall(JOINT, **given | change)


def load_factor(model):
    result = lb.bounds(model)
    assert result.gap < 1e-6
    return result.lower


def test_headers_tie_the_leaves():
    """From the leaves by themselves towards one piece, the closer the headers the stronger."""
    b, height = 0.15, 1.2
    spacings = [(0.8, 3), (0.8, 2), (0.4, 1)]
    load_factors = [load_factor(leaves(header_spacing=s, header_courses=c)) for s, c in spacings]
    assert np.all(np.diff(load_factors) > 0.0)
    assert load_factors[0] > 1.2 * b / height
    assert load_factors[-1] < 2 * b / height


def test_a_collar_joint_helps_the_headers():
    tied = {"header_spacing": 0.8, "header_courses": 3}
    smooth = load_factor(leaves(**tied, collar=lb.OrdunaLourenco(0.0)))
    rough = load_factor(leaves(**tied, collar=lb.OrdunaLourenco(0.7)))
    assert rough >= smooth - 1e-6
    joints = {i.joint.friction for i in leaves(**tied, collar=lb.OrdunaLourenco(0.2)).interfaces}
    assert joints == {0.7, 0.2}


def test_headers_are_counted():
    model = leaves(header_spacing=0.8, header_courses=2)
    assert volume(model) == pytest.approx(1.6 * 1.2 * 0.3)
    headers = [block for block in model.free_blocks if block.name.startswith("header")]
    assert len(headers) == 3 * 2
    for header in headers:
        assert np.ptp(header.vertices, axis=0) == pytest.approx([0.2, 0.3, 0.2])
    assert {round(header.vertices[:, 2].min(), 6) for header in headers} == {0.2, 0.6, 1.0}


def test_headers_keep_clear_of_openings():
    opening = structures.Opening(0.4, 0.0, 0.6, 0.6)
    model = leaves(header_spacing=0.4, header_courses=1, openings=[opening])
    assert volume(model) == pytest.approx((1.6 * 1.2 - 0.36) * 0.3)
    assert len([block for block in model.free_blocks if "lintel" in block.name]) == 2
    for block in model.free_blocks:
        if block.name.startswith("header"):
            x, _, z = block.centroid
            assert not (0.4 < x < 1.0 and z < 0.6)
            assert not (0.2 < x < 1.2 and 0.6 < z < 0.8)


@pytest.mark.parametrize(
    ("n_front", "n_side", "courses"),
    [(3, 3, 1), (3, 4, 2), (4, 2, 5), (2.5, 3, 4), (3, 2.5, 3), (2.5, 3.5, 2)],
)
def test_tower_is_interlocked(n_front, n_side, courses):
    stone, height = 0.8, 0.4
    model = structures.tower(JOINT, length=n_front * stone, width=n_side * stone, courses=courses)
    stones = round(2 * (n_front + n_side - 1))  # a closed ring in every course
    assert len(model.free_blocks) == courses * stones
    # a head joint behind every stone of a ring, and a bed joint above every half of it
    assert len(model.interfaces) == courses * stones + (courses - 1) * 2 * stones + stones
    assert volume(model) == pytest.approx(courses * stones * stone * stone / 2 * height)


def test_tower_with_openings():
    model = structures.tower(
        JOINT, length=2.4, width=2.4, courses=6, openings={"left": [(0.8, 0.4, 0.8, 0.8)], "back": []}
    )
    whole = structures.tower(JOINT, length=2.4, width=2.4, courses=6)
    assert volume(whole) - volume(model) == pytest.approx(0.8 * 0.8 * 0.4)
    (lintel,) = [block for block in model.free_blocks if "lintel" in block.name]
    assert lintel.vertices[:, 0].max() == pytest.approx(0.4)
    assert load_factor(model) > 0.1


def test_tower_resists_less_than_one_piece():
    """As one piece it would overturn at the width over the height."""
    load_factors = [load_factor(structures.tower(JOINT, length=2.4, width=2.4, courses=c)) for c in (2, 4)]
    assert 0.4 / 1.6 < load_factors[1] < load_factors[0]
    assert load_factors[1] <= 2.4 / 1.6


@pytest.mark.parametrize("bonded", [True, False])
def test_buttress(bonded):
    n, courses, stone = 4, 5, 0.8
    change = {"length": n * stone, "courses": courses, "buttress_length": 2 * stone, "bonded": bonded}
    model = structures.buttressed_wall(JOINT, **change)
    assert volume(model) == pytest.approx(courses * 0.4 * 0.4 * (n * stone + 2 * stone))
    across = [
        i for i in model.interfaces
        if {i.block_i.split()[0], i.block_j.split()[0]} == {"wall", "buttress"} and abs(i.axes[2, 2]) > 0.9
    ]  # fmt: skip
    assert bool(across) == bonded  # wall and buttress bear on one another only if they are bonded
    shorter = structures.buttressed_wall(JOINT, **change, buttress_courses=2)
    assert volume(model) - volume(shorter) == pytest.approx(3 * 0.4 * 0.4 * 2 * stone)


def test_a_buttress_props_the_wall_and_holds_it_back_if_bonded():
    change = {"length": 2.0, "courses": 6, "buttress_length": 0.8}
    alone = 0.4 / 2.4
    values = {}
    for bonded in (True, False):
        model = structures.buttressed_wall(JOINT, **change, bonded=bonded)
        back = replace(model, live=lb.mass_proportional((0.0, -1.0, 0.0)))
        values[bonded] = load_factor(model), load_factor(back)
    assert values[True][0] > values[False][0] > 1.2 * alone
    assert values[True][1] > values[False][1] >= alone


def test_without_dilatancy_a_wall_leaves_its_loose_buttress_at_b_over_h():
    model = structures.buttressed_wall(
        JOINT, length=2.0, courses=6, buttress_length=0.8, bonded=False, direction=(0.0, -1.0, 0.0)
    )
    assert load_factor(model) > 1.05 * 0.4 / 2.4  # associated flow opens the joint that slides
    # the joint may press the least bit: b / h is the lower end of an interval of solutions
    assert 0.4 / 2.4 * (1 - 1e-8) <= lb.nonassociated(model).load_factor <= 0.4 / 2.4 * 1.005


@pytest.mark.parametrize("overlap", [0.0, 0.04])
def test_cantilever_stair(overlap):
    treads, length, going, rise, thick, above = 3, 0.9, 0.3, 0.17, 0.4, 4
    model = structures.cantilever_stair(
        JOINT, treads=treads, length=length, going=going, rise=rise, overlap=overlap,
        wall_thickness=thick, courses_above=above,
    )  # fmt: skip
    wall = 6 * going * thick * (treads + above) * rise
    free = (treads * going + (treads - 1) * overlap) * length * rise
    assert volume(model) == pytest.approx(wall + free)
    assert model.live.on(model.free_blocks)[:, 2].sum() == pytest.approx(-20e3 * free)
    rests = [i for i in model.interfaces if i.block_i.startswith("tread") and i.block_j.startswith("tread")]
    assert len([i for i in rests if abs(i.axes[2, 2]) > 0.9]) == (treads - 1 if overlap else 0)


def test_more_wall_above_carries_more():
    load_factors = [
        load_factor(structures.cantilever_stair(JOINT, treads=2, overlap=0.0, courses_above=k))
        for k in (1, 3, 5)
    ]
    assert np.all(np.diff(load_factors) > 0.0)


def test_a_single_corbel_by_hand():
    """One tread under one column of stones as wide: it turns about the edge of the wall."""
    length, going, rise, thick, courses = 0.5, 0.3, 0.2, 0.4, 6
    tread = lb.Block.box("tread", (going, thick + length, rise), (0, length / 2 - thick / 2, rise / 2), 20e3)
    pile = lb.Block.box(
        "pile", (going, thick, courses * rise), (0, -thick / 2, rise + courses * rise / 2), 20e3
    )
    ground = lb.Block.box("ground", (going, thick, rise), (0, -thick / 2, -rise / 2))
    load = lb.loads.force(
        "tread", (0, 0, -tread.weight * length / (length + thick)), at=(0, length / 2, rise / 2)
    )
    blocks = [ground, tread, pile]
    model = lb.Model(blocks, ["ground"], lb.find_interfaces(blocks, JOINT), lb.self_weight(), load)
    free, inside = length**2 / 2, (1 + courses) * thick**2 / 2
    assert load_factor(model) == pytest.approx((inside - free) / free)
