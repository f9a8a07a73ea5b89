"""What reports, plots and files of pictures share."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.drawing.elevations import dimensions, elevations
from limitblocks.drawing.motion import motion, travel
from limitblocks.drawing.sheet import polylines
from limitblocks.drawing.view import towards, view_of

JOINT = lb.OrdunaLourenco(0.6)


@pytest.fixture(scope="module")
def wall():
    return lb.structures.wall(JOINT, length=4.0, courses=6)


@pytest.mark.parametrize(("x", "y"), [one for one in product((-1, 0, 1), repeat=2) if any(one)])
def test_the_eye_is_on_the_side_to_which_the_blocks_move(wall, x, y):
    rates = np.zeros((len(wall.blocks), 6))
    rates[1:, 0], rates[1:, 1] = x, y
    eye = towards(wall, rates)
    assert np.linalg.norm(eye) == pytest.approx(1.0)
    assert eye @ (x, y, 0) > 0.0
    assert eye[2] > 0.0  # from above
    still = towards(wall)
    assert (np.abs(eye) == np.abs(still)).all()  # the same view, mirrored


def test_what_moves_to_both_sides_is_seen_from_the_front(wall):
    rates = np.zeros((len(wall.blocks), 6))
    rates[:, 1] = 1e-3
    rates[1::2, 1] = 1.0
    rates[2::2, 1] = -sum(block.volume for block in wall.blocks[1::2]) / sum(
        block.volume for block in wall.blocks[2::2]
    )
    assert (towards(wall, rates) == towards(wall)).all()


@pytest.mark.parametrize("eye", [(0.4, -0.8, 0.4), (0, 0, 1), (0, -1, 0), (-3, 2, 1)])
def test_views_are_right_handed_and_look_at_the_eye(eye):
    view = view_of(np.array(eye, dtype=float))
    assert view @ view.T == pytest.approx(np.eye(3), abs=1e-12)
    assert np.linalg.det(view) == pytest.approx(1.0)
    assert view[2] == pytest.approx(np.array(eye) / np.linalg.norm(eye))
    assert view[1, 2] >= 0.0  # up is up


def test_views_have_the_overall_sizes():
    model = lb.structures.facade(JOINT, length=3.2, courses=5, return_length=1.6, openings=())
    assert dimensions(model) == pytest.approx({"X": 3.2, "Y": 1.6, "Z": 5 * 0.4})
    sheet = elevations(model)
    texts = [label.text for label in sheet.labels]
    for text in ("X: 3.2 m", "Y: 1.6 m", "Z: 2 m"):
        assert texts.count(text) == 2  # each size is seen in two of the three views
    places = np.array(
        [xy for group in sheet.groups for shape in group.shapes for line, _ in polylines(shape.path)
         for xy in zip(line[::2], line[1::2], strict=True)]
    )  # fmt: skip
    assert places.min() >= 0.0
    assert places[:, 0].max() <= 1000.0
    assert places[:, 1].max() <= sheet.height
    shown = {group.style: next(iter(polylines(group.shapes[0].path))) for group in reversed(sheet.groups)}
    (line, closed), (front, _) = shown["dimension"], shown["support"]
    assert not closed
    assert line[2] - line[0] == pytest.approx(
        max(front[::2]) - min(front[::2])
    )  # as long as the base is drawn


def test_titles_of_views_of_a_slender_structure_do_not_meet():
    model = lb.structures.block(JOINT, width=0.5, height=5.0)
    front, side = (label.x for label in elevations(model).labels if "seen along" in label.text)
    assert side - front > 10 * len("Front, seen along +Y")  # a letter of 17 px is some 10 wide


@pytest.mark.parametrize("length", [2.4, 10.0])
def test_titles_of_views_of_a_thin_wall_are_on_the_page(length):
    model = lb.structures.wall(JOINT, length=length, courses=6)
    titles = [label for label in elevations(model).labels if "seen" in label.text]
    assert len(titles) == 3
    for title in titles:
        half = 10 * len(title.text) / 2
        assert half <= title.x <= 1000.0 - half


@pytest.mark.parametrize("block", [4e-4, 0.4])  # m
def test_courses_behind_one_another_are_drawn_once(block):
    """Front: every block; side: every course; plan: both kinds of courses; and the base in each."""
    sizes = {"block_length": block, "block_height": block / 2, "thickness": block / 2}
    model = lb.structures.wall(JOINT, length=20 * block, courses=6, **sizes)
    drawn = [group for group in elevations(model).groups if group.style != "dimension"]
    assert len(drawn) == 3 * (20 + 21) + 6 + (20 + 21) + 3


def test_a_result_of_another_model_is_not_drawn(wall):
    bounds = lb.bounds(wall)
    assert motion(wall, bounds).magnification > 0.0
    other = replace(bounds, digest="0" * 64)
    with pytest.raises(lb.ModelError, match="belongs to model 000000000000, not to this model"):
        motion(wall, other)


def test_travel_is_that_of_the_corner_that_moves_most():
    block = lb.Block.box("a", (2, 2, 2), (5, 0, 0))
    moved = np.array([[1.0, 0, 0, 0, 0, 0.1]])  # v + w x r at (x, y): (1 - 0.1 y, 0.1 x)
    assert travel([block], moved) == pytest.approx([np.hypot(1.1, 0.1)])


def test_stones_of_one_box_but_other_corners_are_all_drawn():
    """Two that lean to either side, one behind the other: one was left out."""
    right = [(0.0, 0.0), (1.0, 0.0), (1.2, 1.0), (0.2, 1.0)]
    left = [(0.2, 0.0), (1.2, 0.0), (1.0, 1.0), (0.0, 1.0)]
    stones = [
        lb.Block.box("ground", (4, 4, 0.2), (0, 0, -0.1)),
        lb.Block.prism("near", right, (0.0, 0.5), 20e3),
        lb.Block.prism("far", left, (0.5, 1.0), 20e3),
        lb.Block.prism("farther", left, (1.0, 1.5), 20e3),  # hidden by the one before
    ]
    found = lb.find_interfaces(stones, JOINT)
    model = lb.Model(stones, ["ground"], found, lb.self_weight(), lb.mass_proportional((1, 0, 0)))
    groups = [group.style for group in elevations(model).groups]
    assert groups[: groups.index("dimension")] == ["still", "still", "support"]
