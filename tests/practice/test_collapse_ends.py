"""A support that settles: how the way ends where the structure does not fall, and misuse."""

import importlib
from dataclasses import replace

import numpy as np
import pytest
from settling_blocks import SPREAD, arch, beam_on
from stones import model_of

import limitblocks as lb
from limitblocks.evidence.ending import Status
from limitblocks.loads import pressure
from limitblocks.practice import settlement_to_collapse
from limitblocks.practice.collapse_result import SettlementCurve, SettlementPoint


def test_nothing_rests_on_a_support_that_the_others_spare():
    model = beam_on({"a": (-2.0, -1.6), "b": (-0.2, 0.2), "c": (1.6, 2.0)}, (-2.0, 2.0), lb.PointContact(0.5))
    curve = settlement_to_collapse(model, "b", (0, 0, -1))
    assert curve.ended == "nothing rests on what settles any more at 0 m"
    assert curve.reactions == pytest.approx([0.0], abs=1e-3)


def test_a_beam_that_meets_another_stone_is_stopped():
    """One under it that it does not rest on yet: the support leaves it, and it cannot follow."""
    model = beam_on({"left": (-2.0, -1.6), "right": (1.6, 2.0)}, (-2.0, 2.0), lb.PointContact(0.5))
    stop = lb.Block.box("stop", (0.4, 1, 1), (0, 0, -0.5))
    model = replace(model, blocks=(*model.blocks, stop), supports=(*model.supports, "stop"))
    curve = settlement_to_collapse(model, "right", (0, 0, -1), without_dilatancy=False)
    assert curve.falls is None
    assert curve.ended.startswith("contacts that close, or blocks that meet, stop the mechanism at")
    assert curve.stands_to == pytest.approx(0.0, abs=1e-5)


def test_it_ends_where_it_is_told_to():
    ring, _ = arch(2, 0.3)
    told = []
    curve = settlement_to_collapse(
        ring, "right support", SPREAD, step=0.02, largest=0.03, progress=told.append
    )
    assert curve.displacements[-1] == pytest.approx(0.03, rel=1e-9)
    assert curve.falls is None
    assert curve.ended == "the settlement 0.03 m is reached"
    assert tuple(told) == curve.points
    assert curve.digest == ring.digest
    assert [one["displacement"] for one in curve.to_dict()["points"]] == curve.displacements.tolist()
    assert str(curve).endswith("the settlement 0.03 m is reached")


def test_a_beam_that_climbs_by_associated_flow_ends_at_the_size_of_the_structure():
    """What slides lifts, so that it never comes to rest, nor falls: its size is from corner to corner."""
    stones = [
        lb.Block.box("left", (1, 1, 1), (0, 0, -0.5)),
        lb.Block.box("right", (1, 1, 1), (4, 0, -0.5)),
        lb.Block.box("beam", (5, 1, 0.5), (2, 0, 0.25), 20e3),
    ]
    model = model_of(stones, ["left", "right"], lb.PointContact(0.5))
    curve = settlement_to_collapse(
        model, "right", (1, 0, -1), step=5.0, accuracy=0.5, without_dilatancy=False
    )
    size = float(np.linalg.norm((5.0, 1.0, 1.5)))
    assert curve.ended == f"the settlement {size:g} m, the size of the structure, is reached"
    assert curve.points[-1].displacement == pytest.approx(size)
    assert curve.falls is None


def test_support_that_is_a_free_block_and_load_that_stays_behind():
    ring, _ = arch(2, 0.3)
    with pytest.raises(lb.ModelError, match="'voussoir 1' is a free block"):
        settlement_to_collapse(ring, "voussoir 1", SPREAD)
    wind = ring.dead + pressure("voussoir 1", 100.0, facing=(-1, 0, 0))
    loaded = lb.Model(ring.blocks, ring.supports, ring.interfaces, wind, ring.live)
    with pytest.raises(lb.ModelError, match="does not move with the blocks; a settlement until collapse"):
        settlement_to_collapse(loaded, "right support", SPREAD)


@pytest.mark.parametrize("falls", [True, False])
def test_the_end_says_what_is_known_where_no_answer_is_found(monkeypatch, falls):
    """A beam with a bearing of .2 m, no answer from .08 m on; the step to .2 m falls."""
    model = beam_on({"left": (-2.0, -1.9), "right": (1.4, 1.6)}, (-2.4, 1.6), lb.PointContact(0.5))
    found = importlib.import_module("limitblocks.practice.collapse")
    solve = found.settlement

    def lost(there, *given, **options):
        way = there.blocks[1].centroid[0] - model.blocks[1].centroid[0]
        if way > 0.18 and falls:
            raise lb.errors.NoEquilibrium(("beam",))
        if way > 0.08:
            raise lb.SolveError("lost")
        return solve(there, *given, **options)

    monkeypatch.setattr(found, "settlement", lost)
    curve = settlement_to_collapse(model, "right", SPREAD, step=0.15, accuracy=1e-3)
    assert 0.08 - 2e-3 < curve.stands_to <= 0.08
    assert (curve.falls is not None) == falls
    until = f" until it falls at {curve.falls:.9g} m" if falls else ""
    assert curve.ended == f"no checked answer beyond {curve.stands_to:.6g} m{until}: lost"


@pytest.mark.parametrize("within", [False, True])
def test_an_interrupted_settlement_keeps_its_points(monkeypatch, within):
    """Ctrl-C between two answers, or within one, which did not converge: no reason for a shorter step."""
    ring, _ = arch(8, 0.2)
    found = importlib.import_module("limitblocks.practice.collapse")
    solve, state, calls = found.settlement, lb.nonassociated(ring), []

    def stopped(*given, **options):
        calls.append(given)
        if len(calls) < 3:
            return solve(*given, **options)
        if not within:
            raise KeyboardInterrupt
        raise lb.errors.NotConverged("interrupted", replace(state, status=Status.INTERRUPTED))

    monkeypatch.setattr(found, "settlement", stopped)
    curve = settlement_to_collapse(ring, "right support", SPREAD, step=0.1)
    assert len(calls) == 3
    assert len(curve.points) == 2
    assert curve.falls is None
    assert curve.ended == f"interrupted beyond {curve.points[1].displacement:.6g} m"


def test_it_stands_to_where_joints_first_press_across_their_gaps():
    """Though at a later point none does: that is a point of a structure whose gaps were filled before."""
    gap = ("a|b presses across a gap of 1 mm",)
    across = (), (), gap, ()
    points = tuple(SettlementPoint(0.1 * k, None, (), one) for k, one in enumerate(across))
    assert SettlementCurve(points, None, "").stands_to == 0.1
