"""Forces at a place in plan and line loads on whatever is on top."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import limitblocks as lb
from limitblocks.mechanics.loads.tops import stretches, tops
from limitblocks.structures.convex import hull

FORCE = (1e3, -2e3, -5e3)
SLABS = [
    lb.Block.box("left", (2, 2, 1), (-1, 0, 0.5), 1.0),
    lb.Block.box("right", (2, 2, 2), (1, 0, 1), 1.0),
    lb.Block.box("over", (1, 1, 0.5), (1.5, 0, 2.25), 1.0),
]
ARCH = lb.structures.arch(lb.PointContact(0.6), radius=5.0, thickness=0.6, voussoirs=9)


def about_origin(load, blocks):
    """Resultant and moment about the origin, (6,)."""
    arms = np.stack([block.centroid for block in blocks])
    return np.concatenate([load[:, :3].sum(axis=0), (load[:, 3:] + np.cross(arms, load[:, :3])).sum(axis=0)])


@pytest.mark.parametrize(
    ("place", "owner", "height"),
    [
        ((-1.5, 0.3), 0, 1.0),
        ((0.3, 0.0), 1, 2.0),
        ((1.5, 0.2), 2, 2.5),
        ((1.5, 0.9), 1, 2.0),
        ((0, 0), 1, 2.0),
    ],
)
def test_force_acts_on_the_highest_block_at_its_place(place, owner, height):
    load = lb.loads.top_force(FORCE, place).on(SLABS)
    assert load == pytest.approx(lb.loads.force(SLABS[owner].name, FORCE, (*place, height)).on(SLABS))


def test_force_on_an_arch_is_on_the_extrados():
    places = [(0.0, 0.2), (2.0, -0.3), (-4.9, 0.0)]
    for x, y in places:
        load = lb.loads.top_force(FORCE, (x, y)).on(ARCH.free_blocks)
        (k,) = np.flatnonzero(load.any(axis=1))
        block = ARCH.free_blocks[k]
        angles = np.linspace(-np.pi / 2, np.pi / 2, 10)
        z = np.interp(x, 5.3 * np.sin(angles), 5.3 * np.cos(angles))
        assert load == pytest.approx(lb.loads.force(block.name, FORCE, (x, y, z)).on(ARCH.free_blocks))


def test_an_edge_belongs_to_the_first_block():
    level = [SLABS[0], lb.Block.box("beside", (2, 2, 1), (1, 0, 0.5), 1.0)]
    for blocks in (level, level[::-1]):
        load = lb.loads.top_force(FORCE, (0.0, 0.0)).on(blocks)
        assert load.any(axis=1).tolist() == [True, False]


def test_at_an_edge_the_higher_block_is_on_top_if_only_by_a_little():
    low, high = SLABS[0], lb.Block.box("beside", (2, 2, 1.001), (1, 0, 0.5005), 1.0)
    load = lb.loads.top_force(FORCE, (0.0, 0.0)).on([low, high])
    assert load.any(axis=1).tolist() == [False, True]


TURNS = np.radians([0.0, 3.0, 17.0, 33.0, 50.0, 71.0])


def turned(turn, blocks, places):
    """Blocks and places in plan (m, 2) turned about Z."""
    c, s = np.cos(turn), np.sin(turn)
    about = np.array([(c, -s, 0), (s, c, 0), (0, 0, 1)])
    return [block.moved(about, (0, 0, 0)) for block in blocks], np.asarray(places) @ about[:2, :2].T


@pytest.mark.parametrize("turn", TURNS)
def test_a_wall_that_stands_upright_but_for_rounding_has_no_top(turn):
    """A gable: at its own plane the top is the slope of the roof, not anything up to the ridge."""
    gable = lb.Block.prism("gable", [(0, 0), (2, 0), (2, 3), (1, 5), (0, 3)], (0, 1), 1.0, along="x")
    y = np.array([0.1, 0.3, 0.7, 1.5, 1.9] * 2)
    blocks, places = turned(turn, [gable], np.column_stack([np.repeat([0.0, 1.0], 5), y]))
    owner, height = tops(blocks, places)
    assert not owner.any()
    assert height == pytest.approx(3.0 + 2.0 * np.minimum(y, 2.0 - y))


@pytest.mark.parametrize("turn", TURNS)
def test_a_place_on_the_edge_of_blocks_is_on_one_of_them(turn):
    blocks, places = turned(turn, SLABS[:2], [(0.0, y) for y in (-1.0, -0.4, 0.3, 1.0)])
    assert (tops(blocks, places)[0] >= 0).all()


def test_a_steep_face_reaches_no_higher_than_its_edge():
    """Beside a side that leans by 1e-7: .5 nm inside of its upper edge its plane is 5 mm higher."""
    corners = [(x, y) for x in (-0.5, 0.5) for y in (-0.5, 0.5)]
    top = [(x, y, 1.0) for x, y in corners]
    stone = hull("stone", [*top, *((x * (1.0 + 2e-7), y, 0.0) for x, y in corners)], 1.0)
    assert tops([stone], np.array([[0.5 - 5e-10, 0.1]]))[1] == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize(
    ("ends", "owner", "cuts"),
    [
        ([(-2, 0.6), (2, 0.6)], [0, 1], [0.5]),  # across a joint, beside the stone over one of them
        ([(0, 0.6), (2, 0.6)], [1], []),  # from a joint
        ([(-2, 0.0), (-4, 0.0)], [3, 4, 3], [0.25, 0.75]),  # from corner to corner of a stone
    ],
)
def test_a_line_is_cut_once_where_it_comes_to_another_block(turn, ends, owner, cuts):
    """Each edge is that of two faces, and meets the line twice."""
    slab = lb.Block.box("slab", (2, 2, 1), (-3, 0, 0.5), 1.0)
    corners = [(x - 3.0, y, z) for x, y in ((0.5, 0), (-0.5, 0), (0, 0.5), (0, -0.5)) for z in (1.0, 2.0)]
    blocks, (start, end) = turned(turn, [*SLABS, slab, hull("askew", corners, 1.0)], ends)
    places, below = stretches(start, end, blocks)
    assert below.tolist() == owner
    assert places == pytest.approx([0.0, *cuts, 1.0])


def test_line_load_is_shared_by_length():
    load = lb.loads.line_load((0, 0, -1e3), (-1.5, 0.1), (1.8, 0.1)).on(SLABS)
    assert load[:, 2] == pytest.approx([-1.5e3, -1.0e3, -0.8e3])
    expected = sum(
        (
            lb.loads.force("left", (0, 0, -1.5e3), (-0.75, 0.1, 1)),
            lb.loads.force("right", (0, 0, -1.0e3), (0.5, 0.1, 2)),
            lb.loads.force("over", (0, 0, -0.8e3), (1.4, 0.1, 2.5)),
        ),
        lb.loads.Load(),
    )
    assert load == pytest.approx(expected.on(SLABS), abs=1e-9)


@pytest.mark.parametrize(("start", "end"), [((-1.5, 0.1), (1.8, 0.1)), ((0.2, -0.9), (1.9, 0.8))])
def test_a_line_across_slabs_turned_in_plan_is_that_line_turned(start, end):
    c, s = np.cos(0.7), np.sin(0.7)
    turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    slabs = [lb.Block(one.name, one.vertices @ turn.T, one.faces, 1.0) for one in SLABS]
    load = lb.loads.line_load((0, 0, -1e3), start, end).on(SLABS)
    again = lb.loads.line_load((0, 0, -1e3), turn[:2, :2] @ start, turn[:2, :2] @ end).on(slabs)
    assert again == pytest.approx(np.hstack([load[:, :3] @ turn.T, load[:, 3:] @ turn.T]), abs=1e-9)


def test_a_line_askew_loads_each_slab_by_its_length_there():
    """From (.2, -.9) along (1, 1) to (1.9, .8): the upper slab is from (1, -.1) to (1.6, .5)."""
    load = lb.loads.line_load((0, 0, -1e3), (0.2, -0.9), (1.9, 0.8)).on(SLABS)
    assert load[:, 2] == pytest.approx(-1e3 * np.sqrt(2) * np.array([0.0, 1.1, 0.6]))


@given(st.floats(-4.9, 4.9), st.floats(-4.9, 4.9), st.floats(-0.5, 0.5), st.floats(-0.5, 0.5))
def test_line_load_on_an_arch_is_the_sum_of_its_parts(x0, x1, y0, y1):
    if abs(x1 - x0) < 0.1:
        x1 = x0 + (0.1 if x0 < 0 else -0.1)
    line = lb.loads.line_load(FORCE, (x0, y0), (x1, y1)).on(ARCH.free_blocks)
    length = np.hypot(x1 - x0, y1 - y0)
    assert line[:, :3].sum(axis=0) == pytest.approx(np.multiply(FORCE, length))
    n = 400
    s = (np.arange(n) + 0.5) / n
    places = np.column_stack([x0 + s * (x1 - x0), y0 + s * (y1 - y0)])
    parts = sum((length / n * lb.loads.top_force(FORCE, place) for place in places), lb.loads.Load()).on(
        ARCH.free_blocks
    )
    size = np.linalg.norm(FORCE) * length
    assert about_origin(line, ARCH.free_blocks) == pytest.approx(
        about_origin(parts, ARCH.free_blocks), abs=5e-3 * size
    )


def test_line_along_a_joint_acts_once():
    angle = np.linspace(-np.pi / 2, np.pi / 2, 10)[4]
    x = 5.3 * np.sin(angle)
    load = lb.loads.line_load((0, 0, -1e3), (x, -0.5), (x, 0.5)).on(ARCH.free_blocks)
    assert load[:, 2].sum() == pytest.approx(-1e3)


@pytest.mark.parametrize(
    ("load", "said"),
    [
        (lambda: lb.loads.top_force(FORCE, (9.0, 0.0)), "x = 9 m, y = 0 m"),
        (lambda: lb.loads.top_force(FORCE, (0, 0, 0)), "two finite numbers"),
        (lambda: lb.loads.top_force((1, 2), (0, 0)), "three finite numbers"),
        (lambda: lb.loads.line_load(FORCE, (-1.5, 0), (2.5, 0)), "no free block"),
        (lambda: lb.loads.line_load(FORCE, (1, 0), (1, 0)), "start and end"),
        (lambda: lb.loads.line_load(FORCE, (1, np.nan), (1, 0)), "start"),
    ],
)
def test_wrong_place_is_refused(load, said):
    with pytest.raises(lb.ModelError, match=said):
        load().on(SLABS)


def test_blocks_that_are_not_convex_have_the_top_right_there():
    """A step: high over its riser, low over its tread; a horizontal force tells the height by its moment."""
    outline = [(0, 0), (3, 0), (3, 1), (1, 1), (1, 3), (0, 3)]
    step = lb.Block.prism("step", outline, (0, 1), 1.0)
    for x, height in ((0.5, 3.0), (2.0, 1.0)):
        load = lb.loads.top_force((1e3, 0, 0), (x, 0.5)).on([step])
        assert load == pytest.approx(lb.loads.force("step", (1e3, 0, 0), (x, 0.5, height)).on([step]))
    line = about_origin(lb.loads.line_load((1e3, 0, 0), (0.1, 0.5), (2.9, 0.5)).on([step]), [step])
    assert line[[0, 4]] == pytest.approx([2.8e3, 0.9e3 * 3.0 + 1.9e3 * 1.0])
