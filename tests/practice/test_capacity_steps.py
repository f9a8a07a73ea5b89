"""How far a step of a capacity curve goes: contacts that close, answers not found, falls, the end."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from few_blocks import moved
from images import image
from scipy import sparse
from scipy.spatial.transform import Rotation
from stones import model_of

import limitblocks as lb
from limitblocks.arrays import read_only
from limitblocks.practice import CapacityPoint, Control, capacity, capacity_curve
from limitblocks.practice.advance import moved_until_contact
from limitblocks.practice.capacity_result import to_zero
from limitblocks.practice.contact import CLOSED
from limitblocks.practice.displaced import assembly_of
from limitblocks.practice.rejoined import DAMP, _least_squares
from limitblocks.practice.snapped import TIGHT, NoRest, falls, snapped, steepest
from limitblocks.practice.touching import pressed_in

JOINT = lb.PointContact(0.6)


@pytest.fixture(scope="module")
def leaning():
    """A block of .2 m x 1 m turned about its toe by .01, and the way there."""
    model = lb.structures.block(JOINT, width=0.2, height=1.0)
    rates = lb.nonassociated(model).displacement_rates
    forth = rates * 0.01 / np.abs(rates[:, 4]).max()
    return moved(assembly_of(model), forth), forth


@pytest.mark.parametrize("share", [1.0 - 1e-4, 1.0 + 1e-4, 1.5])
def test_a_step_ends_where_a_contact_closes(leaning, share):
    """Moved back by more than the gap, and by so little less that its corner is a micrometre away."""
    there, forth = leaning
    goal, changes = moved_until_contact(there, -share * forth)
    assert changes == ("base|block 1 closes",)
    assert np.abs(goal.contacts[0].ways[:, 2]).max() <= CLOSED * goal.size


def test_a_step_that_closes_nothing_is_whole(leaning):
    there, forth = leaning
    goal, changes = moved_until_contact(there, -0.5 * forth)
    assert changes == ()
    assert goal.contacts[0].ways[:, 2].max() == pytest.approx(0.2 * np.sin(0.005), rel=1e-3)


def test_a_contact_without_force_is_not_pressed():
    arch = lb.structures.arch(JOINT, radius=5.0, thickness=1.0, voussoirs=3)
    forces = np.zeros((4, 6))
    forces[:, 2] = -1.0, -1e-3, -1e-9, 0.0
    assert [own.pressed for own in pressed_in(assembly_of(arch), [0, 1, 2, 3], forces).contacts] == [
        True,
        True,
        False,
        False,
    ]


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (lb.SolveError("none"), "none"),
        # of a structure that has moved there are no dimensions and supports to check
        (lb.errors.NoEquilibrium(("stone",)), "the dead loads alone cannot stand: stone would fall"),
    ],
)
def test_no_answer_is_said_after_steps_of_a_ten_thousandth_of_the_size(error, said, monkeypatch):
    tried = []

    def fails(assembly, control, point, step):
        tried.append(step)
        raise error

    monkeypatch.setattr(capacity, "_advanced", fails)
    there = assembly_of(lb.structures.block(JOINT, width=0.2, height=1.0))
    control = Control("block 1", there.model.blocks[1].centroid, read_only(np.array([1.0, 0, 0])))
    point = CapacityPoint(0.1, 0.2, 0.0, there.model, lb.nonassociated(there.model), ())
    end = capacity._ahead(there, control, point, 0.05, 0.2, np.inf)
    assert end == f"no checked answer beyond 0.1 m: {said}"
    assert 1e-4 * there.size <= min(tried) < 2e-4 * there.size


def overhanging(beyond, *stops):
    """A block on a base, its centre so far from the base's, and stones that no joint joins to it."""
    stones = [
        lb.Block.box("base", (1, 1, 0.2), (0, 0, -0.1)),
        lb.Block.box("block", (1, 1, 0.3), (beyond, 0, 0.15), 20e3),
    ]
    model = model_of(stones, ["base"], JOINT, (0, 1, 0))
    names = [stop.name for stop in stops]
    model = replace(model, blocks=[*stones, *stops], supports=["base", *names])
    return pressed_in(assembly_of(model), [0], -np.ones((1, 6)))


def test_a_fall_that_another_stone_bars_has_no_end():
    there = overhanging(0.6, lb.Block.box("stop", (0.2, 1, 0.1), (1.0, 0, -0.05)))
    with pytest.raises(lb.SolveError, match="snaps, and where it comes to rest was not found"):
        snapped(there)


def test_a_fall_that_no_linear_program_answers_is_said(monkeypatch):
    monkeypatch.setattr("limitblocks.practice.snapped.TIGHT", TIGHT | {"maxiter": 0})
    with pytest.raises(lb.SolveError, match=r"whether the structure is held was not found$"):
        falls(overhanging(0.6))


def test_a_round_of_a_fall_is_a_twentieth_of_a_block(monkeypatch):
    """Its centre half a micrometre beyond the edge it stays; .1 m beyond it falls, by no more than .05 m."""
    for beyond in (0.1, 0.5 + 5e-7, 0.6):
        there = overhanging(beyond)
        assert falls(there) == (beyond == 0.6)
        way = steepest(there)[0] / [*[there.model.blocks[1].size] * 3, 1, 1, 1]
        if beyond == 0.6:
            assert np.abs(way).max() == pytest.approx(0.05, rel=1e-6)
            monkeypatch.setattr("limitblocks.practice.snapped.ROUNDS", 3)  # nothing is below it
            with pytest.raises(lb.SolveError, match="snaps, and where it comes to rest was not found"):
                snapped(there)
        else:
            assert snapped(there) == (there, ())


@pytest.mark.parametrize(("axis", "angle"), [("z", 45), ("x", 30)])
def test_a_round_of_a_fall_turns_with_the_structure(axis, angle):
    there, turn = overhanging(0.6), Rotation.from_euler(axis, angle, degrees=True).as_matrix()
    again = pressed_in(assembly_of(image(there.model, turn)), [0], -np.ones((1, 6)))
    ways = [steepest(one)[0].reshape(-1, 3) for one in (there, again)]
    assert ways[1] == pytest.approx(ways[0] @ turn.T, abs=1e-9)


def test_a_curve_without_an_end_is_ended(monkeypatch):
    """A block that slides on and on, of which only a few points a step are followed."""
    monkeypatch.setattr(capacity, "MOST", 2)
    stones = [
        lb.Block.box("base", (9, 1, 0.2), (4, 0, -0.1)),
        lb.Block.box("block", (1, 1, 0.3), (0, 0, 0.15), 20e3),
    ]
    model = model_of(stones, ["base"], lb.PointContact(0.1))
    curve = capacity_curve(model, steps=2)
    assert (curve.zero, curve.ended) == (None, "4 points do not lead to an end")


@pytest.mark.parametrize(("way", "fall", "points"), [(1e-6, 0.0, 51), (0.05, 0.0, 200), (1e-6, 1e-3, 200)])
def test_a_curve_that_creeps_is_ended(way, fall, points, monkeypatch):
    """Contacts of an arch with cohesion opened and closed again and again: 40 points within 7 micrometres."""

    def ahead(assembly, control, point, *_):
        there = replace(point, displacement=point.displacement + way, load_factor=point.load_factor - fall)
        return assembly, control, there

    monkeypatch.setattr(capacity, "_ahead", ahead)
    stones = [
        lb.Block.box("base", (90, 1, 0.2), (44, 0, -0.1)),
        lb.Block.box("block", (1, 1, 0.3), (0, 0, 0.15), 20e3),
    ]
    curve = capacity_curve(model_of(stones, ["base"], lb.PointContact(0.4)), steps=4)
    assert len(curve.points) == points
    creeps = curve.ended == "50 points lead from 0 to 5e-05 m only"
    assert creeps is (points == 51)


def test_a_pier_that_rocks_back_stays_on_its_corner():
    """It turned about the inner edge of the strip left of its joint, and the curve ended at .27 m as a snap.

    Its corner, said to open, went into the base by the second order of each step.
    """
    portal = lb.structures.portal(lb.OrdunaLourenco(0.6), span=1.6, pier_width=0.6, pier_blocks=2)
    assert capacity_curve(portal).ended.startswith("load factor zero")


@pytest.mark.parametrize(("fall", "known"), [(1e-12, False), (-1e-12, False), (1e-6, True), (-1e-6, False)])
def test_the_secant_of_a_fall_within_the_accuracy_of_load_factors_is_none(fall, known):
    """Rounding chose between steps of .03 and .16 m of a portal that slides at .6, and two ways to go on."""
    point = CapacityPoint(0.0, 0.6, 0.0, None, None, ())
    ahead = to_zero(point, replace(point, displacement=0.1, load_factor=0.6 * (1.0 - fall)))
    assert ahead == (pytest.approx(0.1 * (1.0 - fall) / fall, rel=1e-6) if known else np.inf)


def test_a_snap_without_rest_is_looked_for_once(monkeypatch):
    """It begins where the step does, within the accuracy: each shorter step took as long to the same end."""
    asked = []

    def lost(_assembly, _control, _rates, step, accuracy):
        asked.append(step > accuracy)
        raise NoRest("nowhere")

    monkeypatch.setattr(capacity, "held", lost)
    curve = capacity_curve(lb.structures.block(JOINT, width=0.2, height=1.0))
    assert (curve.ended, asked) == ("no checked answer beyond 0 m: nowhere", [True])


@pytest.mark.parametrize("longest", [0.05, 0.0])
def test_a_step_that_jumps_back_is_halved(monkeypatch, longest):
    """Contacts of longer steps come together at the start alone; H sin(atan(B / H)) is reached by halves."""
    model, whole = lb.structures.block(JOINT, width=0.2, height=1.0), capacity.held
    start: list[Any] = []

    def held(assembly, control, rates, step, accuracy):
        there = whole(assembly, control, rates, step, accuracy)
        start.append(replace(there, assembly=assembly, control=control))
        return start[0] if len(start) > 2 and step > longest else there

    monkeypatch.setattr(capacity, "held", held)
    top = next(corner for corner in model.free_blocks[0].vertices if corner[0] > 0 and corner[2] > 0.5)
    curve = capacity_curve(model, control=("block 1", top), steps=3)
    assert (np.diff(curve.displacements) > 0.0).all()
    if longest:
        assert curve.zero == pytest.approx(np.sin(np.arctan(0.2)), rel=1e-6)
    else:
        assert curve.zero is None
        assert len(curve.points) == 3
        assert "its contacts come together only where the mechanism came from" in curve.ended


def test_closing_motions_are_exact_where_rows_are_nearly_dependent():
    """Of the least squares of [A; DAMP I] x = [b; 0], by the singular values s of A: s / (s^2 + DAMP^2)."""
    draw = np.random.default_rng(1)
    u, v = (np.linalg.qr(draw.normal(size=size))[0] for size in ((60, 20), (20, 20)))
    s, c = np.geomspace(1e-6, 5.0, 20), draw.normal(size=20)
    x = _least_squares(sparse.csr_array(u * s @ v.T), u @ c)
    assert x == pytest.approx(v @ (s / (s**2 + DAMP**2) * c), abs=1e-10 * np.abs(x).max())


def test_what_counts_as_closed_is_no_way_to_fall():
    """A block of 1 m half of the gap above its base that counts as none: over TURN it would be 1e-7."""
    model = lb.structures.block(JOINT, width=0.2, height=1.0)
    up = np.outer(model.free, [0.0, 0.0, 5.0 * CLOSED, 0.0, 0.0, 0.0])
    there = moved(assembly_of(model), up)
    assert there.closed.all()
    assert steepest(there)[1] == pytest.approx(0.0, abs=1e-10)
