"""Where capacity curves end, and why; what is refused."""

import importlib
from dataclasses import replace

import numpy as np
import pytest
from few_blocks import sliding_block, toe_corner
from stones import model_of

import limitblocks as lb
from limitblocks.arrays import read_only
from limitblocks.evidence.ending import Status
from limitblocks.loads import pressure
from limitblocks.practice import (
    CapacityPoint,
    Control,
    capacity,
    capacity_curve,
    passive_fill,
    reinforced,
    settlement_to_collapse,
)
from limitblocks.practice.capacity_result import zero_of
from limitblocks.practice.displaced import assembly_of

JOINT = lb.PointContact(0.6)
B, H = 0.2, 1.0


def test_a_curve_that_never_falls_ends_where_it_is_told_to():
    """A block slides from one end of a long bar towards the other."""
    stones = [lb.Block.box("base", (10, 1, 0.2), (4.5, 0, -0.1)), sliding_block().blocks[1]]
    curve = capacity_curve(model_of(stones, ["base"], lb.PointContact(0.1)), steps=2, largest=8.0)
    assert curve.load_factors == pytest.approx(0.1, rel=1e-8)
    assert (curve.zero, curve.ended) == (None, "the displacement 8 m is reached")


def test_load_that_stays_behind():
    model = lb.structures.block(JOINT, width=B, height=H)
    loaded = lb.Model(
        model.blocks, model.supports, model.interfaces, model.dead,
        model.live + pressure("block 1", 100.0, facing=(1, 0, 0)),
    )  # fmt: skip
    with pytest.raises(lb.ModelError, match="does not move with the blocks"):
        capacity_curve(loaded)


def test_fill_that_stays_behind():
    """Its resistance is that of the depth at which a face is, along the deck whatever the way."""
    arch = lb.structures.arch(JOINT, radius=3.0, thickness=0.6, voussoirs=8)
    filled = reinforced(arch, *passive_fill(arch, 4.0, unit_weight=17e3, coefficient=3.0))
    for analysis in (capacity_curve, lambda one: settlement_to_collapse(one, "right support", (1, 0, 0))):
        with pytest.raises(lb.ModelError, match="passive fill does not move with the blocks"):
            analysis(filled)


def test_blocks_that_meet_stop_the_curve():
    """A block rocks towards a wall 5 cm away: its upper corner is there at asin(.05 / h)."""
    stones = [
        lb.Block.box("base", (3, 1, 0.2), (0, 0, -0.1)),
        lb.Block.box("block", (B, 1, H), (0, 0, H / 2), 20e3),
        lb.Block.box("wall", (0.3, 1, 2.0), (B / 2 + 0.05 + 0.15, 0, 1.0)),
    ]
    model = model_of(stones, ["base", "wall"], JOINT)
    curve = capacity_curve(model, control=("block", toe_corner(model)), steps=4)
    assert curve.zero is None
    assert curve.ended.startswith("contacts that close, or blocks that meet, stop the mechanism at 0.05")
    assert curve.displacements[-1] == pytest.approx(0.05, abs=1e-4)
    assert curve.load_factors[-1] == pytest.approx(np.tan(np.arctan(B / H) - np.arcsin(0.05 / H)), abs=2e-4)


def test_a_contact_that_closes_at_once_is_not_called_blocks_that_meet(monkeypatch):
    monkeypatch.setattr("limitblocks.practice.snapped.advanced", lambda *step: None)
    curve = capacity_curve(lb.structures.block(JOINT, width=B, height=H))
    assert len(curve.points) == 1
    assert curve.zero is None
    assert str(curve).startswith("capacity curve of 1 point from")
    assert curve.ended == "a contact closes at once, in the first step, and stops the mechanism"


def test_a_curve_that_rises_goes_on_by_longer_steps():
    model = lb.structures.block(JOINT, width=B, height=H)
    result = lb.nonassociated(model)
    before, point = (CapacityPoint(d, a, 0.0, model, result, ()) for d, a in ((0.0, 0.2), (0.001, 0.21)))
    assert capacity._next_step(assembly_of(model), before, point, 20) == pytest.approx(0.01)


def ahead_of(there, displacement, load_factor, step, secant):
    """A point of a block that slides, and the one that a step leads to."""
    point = CapacityPoint(displacement, load_factor, 0.0, there.model, lb.nonassociated(there.model), ())
    control = Control("block", there.model.blocks[1].centroid, read_only(np.array([1.0, 0, 0])))
    return point, capacity._ahead(there, control, point, step, 1.0, secant)[2]


def test_a_load_factor_that_jumps_below_zero_is_approached_by_halves(monkeypatch):
    """Just above zero before .3 m, -1 beyond: the secant alone would creep."""
    there = assembly_of(sliding_block())

    def advanced_to(assembly, control, point, step):
        at = point.displacement + step
        return assembly, control, replace(point, displacement=at, load_factor=1e-3 if at < 0.3 else -1.0)

    monkeypatch.setattr(capacity, "_advanced", advanced_to)
    _, found = ahead_of(there, 0.0, 1e-3, 0.4, np.inf)
    assert 0.15 <= found.displacement < 0.3


@pytest.mark.parametrize("lost", [1e-6, 1e-4, 2e-3])
def test_a_curve_whose_end_is_not_solved_ends_on_the_safe_side_of_its_zero(monkeypatch, lost):
    """Nothing is solved below 1e-6 or 1e-4 of the first load factor, as on a tower: zero a little before.

    Lost at 2e-3 it is too far from its zero, and has none.
    """
    model, whole = lb.structures.block(JOINT, width=B, height=H), capacity.answered

    def answered_above(assembly):
        if (found := whole(assembly))[3].load_factor - found[1] < lost * B / H:
            raise lb.SolveError("lost")
        return found

    monkeypatch.setattr(capacity, "answered", answered_above)
    curve = capacity_curve(model, control=("block 1", toe_corner(model)), steps=3)
    exact = H * np.sin(np.arctan(B / H))
    if lost > 1e-4:
        assert curve.zero is None
        assert "no checked answer beyond" in curve.ended
    else:
        assert exact - max(1e-6, lost) * assembly_of(model).size <= curve.zero < exact


@pytest.mark.parametrize(("left", "zero"), [(0.005, True), (0.06, False)])
def test_a_load_factor_that_drops_and_is_lost_is_not_zero(monkeypatch, left, zero):
    """It drops to 6 % in a millimetre, so that the secant is zero .06 mm on: nothing says that it goes on."""
    model = lb.structures.block(JOINT, width=B, height=H)

    def advanced_to(assembly, control, point, step):
        if point.displacement > 0.0:
            raise lb.SolveError("lost")
        return assembly, control, replace(point, displacement=step, load_factor=left * B / H)

    monkeypatch.setattr(capacity, "_advanced", advanced_to)
    curve = capacity_curve(model, control=("block 1", toe_corner(model)), steps=3)
    assert curve.zero == (pytest.approx(1e-3 * assembly_of(model).size) if zero else None)
    assert ("no checked answer beyond" in curve.ended) != zero


def test_a_zero_that_the_secant_finds_from_beyond_is_not_approached_by_halves(monkeypatch):
    """Load factor 1 - d, a step that ends 8e-7 m beyond its zero: within 1e-6 of the size that is enough."""
    there, tried = assembly_of(sliding_block()), []

    def advanced_to(assembly, control, point, step):
        tried.append(step)
        at = point.displacement + step * (1.0 + 1e-6 * (len(tried) == 1))
        return assembly, control, replace(point, displacement=at, load_factor=1.0 - at)

    monkeypatch.setattr(capacity, "_advanced", advanced_to)
    point, found = ahead_of(there, 0.2, 0.8, 0.8, 0.8)
    assert tried == [0.8]
    assert zero_of([point, found]) == pytest.approx(1.0, abs=1e-12)
    assert found.displacement > 1.0 + 5e-7


def test_a_zero_that_is_not_answered_is_not_approached_by_halves(monkeypatch):
    """Load factor 1 - d, not answered within 1e-3 of its zero: the next step ends a hundredth before it."""
    there = assembly_of(sliding_block())

    def advanced_to(assembly, control, point, step):
        if abs(at := 1.0 - point.displacement - step) < 1e-3:
            raise lb.SolveError("the dead loads alone are at their limit")
        return assembly, control, replace(point, displacement=1.0 - at, load_factor=at)

    monkeypatch.setattr(capacity, "_advanced", advanced_to)
    _, found = ahead_of(there, 0.2, 0.8, 0.8, 0.8)
    assert found.load_factor == pytest.approx(0.008, rel=1e-9)


@pytest.mark.parametrize("within", [False, True])
def test_an_interrupted_curve_keeps_its_points(monkeypatch, within):
    """Ctrl-C between two answers, or within one, which did not converge: no reason for a shorter step."""
    model, solve, calls = lb.structures.block(JOINT, width=B, height=H), lb.nonassociated, []

    def stopped(model):
        calls.append(model)
        if len(calls) < 2:
            return solve(model)
        if not within:
            raise KeyboardInterrupt
        state = replace(solve(model), status=Status.INTERRUPTED)
        raise lb.errors.NotConverged("interrupted", state)

    monkeypatch.setattr(importlib.import_module("limitblocks.practice.touching"), "nonassociated", stopped)
    curve = capacity_curve(model, control=("block 1", toe_corner(model)), steps=3)
    assert len(calls) == 2
    assert len(curve.points) == 2
    assert curve.zero is None
    assert curve.ended == f"interrupted beyond {curve.points[1].displacement:.6g} m"


def test_curve_ends_where_the_control_point_turns_back():
    """A stone rocks; a point .5 m beyond its edge and .05 m above goes on by hypot(.5, .05) - .5 at most."""
    stones = [
        lb.Block.box("ground", (2, 1, 1), (0, 0, -0.5)),
        lb.Block.box("stone", (3, 1, 2), (0, 0, 1), 20e3),
    ]
    model = model_of(stones, ["ground"], lb.PointContact(2.0))
    curve = capacity_curve(model, control=("stone", (1.5, 0, 0.05)), steps=20)
    most, leans = np.hypot(0.5, 0.05), np.arctan2(0.05, 0.5)
    assert curve.zero is None
    assert "control point of block 'stone' moves along the live load no more" in curve.ended
    assert curve.points[-1].displacement <= most - 0.5 + 1e-9
    for one in curve.points:
        x, z = next(b for b in one.model.blocks if b.name == "stone").centroid[[0, 2]] - [1, 0]
        turned = np.arctan2(z, x) - np.arctan2(1, -1)
        assert one.load_factor == pytest.approx(np.tan(np.pi / 4 + turned), abs=1e-9)
        assert one.displacement == pytest.approx(most * np.cos(leans + turned) - 0.5, abs=1e-9)
        assert turned < 1e-12  # never back
    turns = [one.model.blocks[1].centroid[0] for one in curve.points]
    assert np.all(np.diff(turns) > 0)


def test_a_load_factor_that_falls_below_zero_on_the_way_back_is_zero_there():
    """Its secant does not fall along the way; the lesser displacement is the safe one."""
    model = sliding_block()
    before = CapacityPoint(0.2, 0.1, 0.0, model, lb.nonassociated(model), ())
    last = replace(before, displacement=0.2 - 1e-7, load_factor=-0.1)
    assert zero_of([before, last]) == last.displacement
