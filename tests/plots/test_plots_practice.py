"""Capacity curves and ties as drawn."""

from dataclasses import replace

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.drawing.ties import has_area, moved, tie_lines
from limitblocks.joints import Dowel, Guide, Tie
from limitblocks.practice import capacity_curve, reinforced, settlement_to_collapse, settling, tie
from limitblocks.reports.words import assumed, joint_words

pytest.importorskip("matplotlib", reason="the package matplotlib is not installed")


@pytest.fixture(scope="module")
def wall():
    return lb.structures.block(lb.PointContact(0.6), width=0.2, height=1.0)


@pytest.fixture(scope="module")
def tied(wall):
    """A tie that yields, one that goes slack; the wall hinges towards +X."""
    name, (support, *_) = wall.free_blocks[0].name, wall.supports
    middle = wall.free_blocks[0].centroid
    rods = [
        tie(
            name,
            middle + np.array((0, 0, 0.4)),
            support,
            middle + np.array((side, 0, 0.4)),
            area=1e-4,
            strength=1e6,
        )
        for side in (-2.0, 3.0)
    ]
    return reinforced(wall, *rods)


def test_a_capacity_curve_goes_to_its_zero(wall):
    """tan(atan .2 - asin(d / h)); from the first point that presses across a gap on the line is broken."""
    name = wall.free_blocks[0].name
    vertices = wall.free_blocks[0].vertices
    corner = vertices[(vertices[:, 0] > vertices[:, 0].mean()) & (vertices[:, 2] > 0.5)][0]
    curve = capacity_curve(wall, control=(name, corner), steps=2)
    ax = lb.plots.capacity(curve)
    line = next(one for one in ax.lines if one.get_linestyle() == "-" and len(one.get_xdata()) > 2)
    x, y = line.get_xdata(), line.get_ydata()
    assert y == pytest.approx(np.tan(np.arctan(0.2) - np.arcsin(x)), abs=1e-7)
    assert name in ax.get_xlabel()
    assert "--" not in [one.get_linestyle() for one in ax.lines]
    points = (*curve.points[:1], replace(curve.points[1], across=("a|b",)), *curve.points[2:])
    drawn = lb.plots.capacity(replace(curve, points=points))
    (hollow,) = (one for one in drawn.lines if one.get_label() == "presses across a gap")
    assert hollow.get_xdata().tolist() == [curve.points[1].displacement]
    (broken,) = (one for one in drawn.lines if one.get_linestyle() == "--")
    assert broken.get_xdata()[0] == curve.points[0].displacement


def test_anchors_of_a_tie_move_with_their_blocks(tied):
    first, second = tie_lines(tied)
    middle = tied.free_blocks[0].centroid + np.array((0, 0, 0.4))
    assert first.anchors == pytest.approx(np.array([middle, middle + np.array((-2.0, 0, 0))]))
    assert second.anchors == pytest.approx(np.array([middle, middle + np.array((3.0, 0, 0))]))
    k = first.blocks[0]
    rates = np.zeros((len(tied.blocks), 6))
    rates[k] = (0.1, 0, 0, 0, 0.5, 0)  # translation, and a turn about Y: + w z along X
    assert moved(tied, first, rates) == pytest.approx(
        np.array([middle + np.array((0.3, 0, 0)), first.anchors[1]])
    )
    assert has_area(tied)[-2:] == [False, False]
    assert all(has_area(tied)[:-2])


def test_a_guide_is_not_drawn():
    arch = lb.structures.arch(lb.PointContact(0.8), radius=5.0, thickness=0.8, voussoirs=5)
    own = settling(arch, "right support", (1, 0, 0)).model
    assert has_area(own).count(False) == 1
    assert tie_lines(own) == []


def test_ties_are_lines_in_the_colour_of_their_state(tied):
    solved = lb.nonassociated(tied)
    states = lb.interface_states(tied, solved)
    assert set(states.state) >= {"yield", "slack"}
    ax = lb.plots.interface_states(tied, solved, plane="xz")
    lines = {one.get_label(): one for one in ax.collections if one.get_label() in ("yield (1)", "slack (1)")}
    for line, own in zip(tie_lines(tied), states.state[-2:], strict=True):
        (path,) = lines[f"{own} (1)"].get_segments()
        assert path == pytest.approx(line.anchors[:, [0, 2]])
    assert len({tuple(one.get_colors()[0]) for one in lines.values()}) == 2
    for picture in (lb.plots.structure(tied, plane="xz"), lb.plots.mechanism(tied, solved, plane="xz")):
        low, high = picture.get_xlim()
        assert low < tie_lines(tied)[0].anchors[:, 0].min()
        assert high > tie_lines(tied)[1].anchors[:, 0].max()


def test_joints_of_ties_in_words():
    assert joint_words(Tie(8e6, 2.5)) == (
        "tie, tension up to 8 MPa on its section, no compression, 2.5 m from anchor to anchor"
    )
    assert joint_words(Dowel(5e4)) == "dowel, shear up to 50 kPa on its section"
    for joint in (Tie(1e6), Dowel(1e6), Guide(1e6)):
        assert joint.word in joint_words(joint)
        assert all(one.startswith(f"{joint.word.capitalize()}s ") for one in assumed(joint))


def test_a_settling_support_goes_to_where_the_structure_falls():
    ring = lb.structures.arch(lb.PointContact(0.5), radius=1.0, thickness=0.3, voussoirs=2)
    curve = settlement_to_collapse(ring, "right support", (1, 0, 0), step=0.4, accuracy=0.1)
    ax = lb.plots.settlement(curve)
    lower, upper, dots = (ax.lines[k].get_ydata() for k in range(3))
    assert dots == pytest.approx(curve.reactions / 1e3)
    assert lower == pytest.approx(upper, rel=1e-5)
    assert curve.falls == ax.lines[-1].get_xdata()[0]
    assert ax.get_ylabel() == "reaction (kN)"
    points = (curve.points[0], replace(curve.points[1], across=("a|b presses",)))
    hollow = lb.plots.settlement(replace(curve, points=points, falls=None)).lines[-1]
    assert hollow.get_markerfacecolor() == "white"
    assert len(hollow.get_xdata()) == 1


def test_a_figure_has_the_shape_of_the_structure_and_its_ties(wall, tied):
    """A block of 0.2 m x 1 m is upright, with ties of 5 m across it is not."""
    upright, flat = (lb.plots.structure(model).figure.get_size_inches() for model in (wall, tied))
    assert upright[1] > upright[0]
    assert flat[0] > flat[1]
