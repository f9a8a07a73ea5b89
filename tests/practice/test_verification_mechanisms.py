"""Verifications of what has several mechanisms, and of loads that are not those of [C8.7.1.1]."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from facades import ARM, FC, FLOOR, OWN, SITE, G, H, T

import limitblocks as lb
from limitblocks.evidence import mechanism
from limitblocks.evidence.mechanism import change_of_mechanism, find_mechanism
from limitblocks.practice import capacity_curve, uplift, verification
from limitblocks.problem import Flow, State

PUSH = lb.mass_proportional((1, 0, 0))


@pytest.mark.parametrize(
    ("dead", "words"),
    [
        (1.3 * lb.self_weight(), "the dead load has the weights times 1.3"),
        (0.5 * lb.self_weight(), "the dead load has the weights times 0.5"),
    ],
)
def test_weights_other_than_those_that_are_pushed_are_refused(facade, dead, words):
    """[C8.7.1.1] has the same P_k in both: with 1.3 of them a0* came out 1.3 times too high."""
    model = replace(facade, dead=dead)
    with pytest.raises(lb.ModelError, match=words):
        verification(model, lb.nonassociated(model), SITE, q=2.0)


def test_terms_that_take_weights_back_are_named(facade):
    push = lb.mass_proportional((1, 0, 0))
    model = replace(facade, live=2.0 * push - push)
    with pytest.raises(lb.ModelError, match="weights times -1 among its terms; expected their sum as one"):
        verification(model, lb.nonassociated(model), SITE, q=2.0)


def test_a_mass_below_the_toe_moves_against_the_push(facade):
    """[C8.7.1.1], [C8.7.1.5]: its weight is one of sum P, its delta negative."""
    weight, low = 4e3, 1.0
    hung = lb.loads.added_mass("wall", (0, 0, -low), weight=weight)
    floor = lb.loads.added_mass("wall", (T / 2 - ARM, 0, H), weight=FLOOR)
    push = lb.mass_proportional((1, 0, 0), [floor, hung])
    model = replace(facade, dead=lb.self_weight([floor, hung]), live=push)
    found = verification(model, lb.nonassociated(model), SITE, q=2.0, confidence=FC)
    P, x, y = np.array([OWN, FLOOR, weight]), np.array([H / 2, H, -low]), np.array([T / 2, ARM, T / 2])
    assert found["alpha0"] == pytest.approx(P @ y / (P @ x), rel=1e-7)
    assert found["e*"] == pytest.approx((P @ x) ** 2 / (P.sum() * (P @ x**2)), rel=1e-7)


def test_terms_that_make_up_the_weights_count_each_by_its_share(facade):
    model = replace(facade, live=0.3 * facade.live + 0.7 * facade.live)
    found = verification(model, lb.nonassociated(model), SITE, q=2.0)
    assert found["sum P"] == pytest.approx(OWN + FLOOR)


def test_water_in_joints_that_open_is_refused():
    wall = lb.structures.wall(lb.PointContact(0.6), length=1.2, courses=4)
    wet = replace(wall, dead=wall.dead + uplift(wall, 0.5))
    with pytest.raises(lb.ModelError, match="water in joints, which open"):
        verification(wet, lb.nonassociated(wet), SITE, q=2.0)


def test_each_damping_is_judged_whether_it_is_used_or_not(facade, answer):
    with pytest.raises(lb.ModelError, match=r"damping at SLC is -0\.1"):
        verification(facade, answer, SITE, q=2.0, damping=(0.08, -0.1))


@pytest.mark.parametrize("joint", [lb.PointContact, lb.OrdunaLourenco])
@pytest.mark.parametrize("rocks", [False, True])
def test_where_several_mechanisms_have_one_load_factor_the_least_acceleration_counts(joint, rocks):
    """Stones that slide on each other, or two walls that rock: each alone has e* = 1, together less."""
    ground = lb.Block.box("ground", (8, 4, 0.4), at=(0, 0, -0.2))
    if rocks:
        made, friction, alpha = [((0.4, 1, 2), (0, -1.2, 1)), ((0.4, 2, 2), (0, 1, 1))], 0.6, 0.2
    else:
        made, friction, alpha = [((1, 1, 0.5), (0, 0, z)) for z in (0.25, 0.75)], 0.3, 0.3
    stones = [lb.Block.box(f"stone {k}", *one, unit_weight=20e3) for k, one in enumerate(made)]
    said_once = False
    for count in (1, 2):
        blocks = [ground, *stones[:count]]
        model = lb.Model(
            blocks, ["ground"], lb.find_interfaces(blocks, joint(friction)), lb.self_weight(), PUSH
        )
        for result in (lb.nonassociated(model), lb.bounds(model)):
            found = verification(model, result, SITE, q=2.0)
            least = alpha * G / FC
            others = [said for said in found.remarks if "one of many with this alpha0" in said]
            assert found["alpha0"] == pytest.approx(alpha, rel=1e-6)
            if count == 1:
                assert found["a0*"] == pytest.approx(least, rel=1e-6)
                assert not others
            else:
                assert found["a0*"] == pytest.approx(least, rel=1e-3)
                assert all("is taken as 1, so that none" in said for said in others)
                said_once |= bool(others)
    assert said_once


def test_a_mechanism_that_is_the_only_one_has_no_such_remark():
    """An arch: e* is less than 1, and yet its hinges are the only ones."""
    arch = lb.structures.arch(lb.PointContact(0.6), radius=5.0, thickness=1.0, voussoirs=21)
    found = verification(arch, lb.nonassociated(arch), SITE, q=2.0)
    assert found["e*"] < 0.9
    assert not [said for said in found.remarks if "one of many" in said]


@pytest.mark.parametrize(("fail", "said"), [(0, False), (1, False), (2, True)])
def test_what_one_method_leaves_open_is_decided_by_the_other(monkeypatch, fail, said):
    """As it is, the first leaves vaults open, where rounding has it so; where both do, a remark says so."""
    solve = mechanism.linear_program
    failing = [method for method, _ in mechanism.WAYS[:fail]]

    def tried(*args, **settings):
        return SimpleNamespace(status=4) if settings["method"] in failing else solve(*args, **settings)

    monkeypatch.setattr(mechanism, "linear_program", tried)
    arch = lb.structures.arch(lb.PointContact(0.6), radius=5.0, thickness=1.0, voussoirs=21)
    remarks = verification(arch, lb.nonassociated(arch), SITE, q=2.0).remarks
    assert any("may be one of many (not found)" in one for one in remarks) is said


def test_what_yields_and_does_not_flow_in_this_mechanism_may_in_another():
    """Two stones slide on the ground as one; the joint between them yields at the same load factor."""
    blocks = [lb.Block.box("ground", (8, 4, 0.4), at=(0, 0, -0.2))]
    blocks += [
        lb.Block.box(f"stone {k}", (1, 1, 0.5), at=(0, 0, 0.25 + 0.5 * k), unit_weight=20e3) for k in range(2)
    ]
    joint = lb.OrdunaLourenco(0.3)
    model = lb.Model(blocks, ["ground"], lb.find_interfaces(blocks, joint), lb.self_weight(), PUSH)
    result, problem = lb.nonassociated(model), model.problem
    flow = Flow(problem)
    at = problem.dimensionless(
        State(result.load_factor, result.generalised_stresses, np.zeros(12), result.flow_multipliers)
    )
    u = np.tile([1.0, 0, 0, 0, 0, 0], 2)
    u, y = find_mechanism(flow, at.x, u / (problem.live @ u))
    state = State(at.load_factor, at.x, u, y)
    lower = np.repeat([1.0, 0.0], 6) * problem.live
    assert lower @ u == pytest.approx(0.5, rel=1e-6)
    assert change_of_mechanism(flow, state, lower) > 0.1
    assert change_of_mechanism(flow, state, problem.live) == pytest.approx(0.0, abs=1e-9)


def walls_side_by_side(*sizes):
    """Walls of .4 m x 2 m times their sizes, 1 m deep, each by itself on the same ground."""
    stones = [lb.Block.box("ground", (14, 3, 0.4), at=(0, 0, -0.2))]
    stones += [
        lb.Block.box(f"wall {k}", (0.4 * size, 1, 2 * size), at=(6 * k - 3, 0, size), unit_weight=18e3)
        for k, size in enumerate(sizes)
    ]
    joints = lb.find_interfaces(stones, lb.PointContact(0.6))
    return lb.Model(stones, ["ground"], joints, lb.self_weight(), PUSH)


def test_walls_that_rock_each_by_itself_are_not_verified_together():
    """A wall alone: d0* = h/2 sin(atan(b/h)), not satisfied; the mix of both had been."""
    alone, both = walls_side_by_side(1.0), walls_side_by_side(1.0, 3.0)
    small = verification(alone, lb.nonassociated(alone), SITE, q=2.0, curve=capacity_curve(alone, steps=3))
    assert small["d0*"] == pytest.approx(np.sin(np.arctan(0.2)), rel=1e-6)
    assert [one.satisfied for one in small.checks] == [False, False]
    assert not small.left_out
    solved, curve = lb.nonassociated(both), capacity_curve(both, steps=3)
    found = verification(both, solved, SITE, q=2.0, curve=curve, collapse_demand=SITE)
    assert [one.name for one in found.checks] == ["linear, SLV"]
    assert "one of many with this alpha0" in found.left_out
    assert any("one of many with this alpha0" in one for one in found.remarks)
    assert not verification(both, solved, SITE, q=2.0).left_out


def test_the_mix_of_walls_that_rock_satisfies_no_linear_check_that_one_alone_does_not():
    """A wall alone has e* = 1: a0* = g (b/h) / FC, less than a_g S / q; the mix of both had more."""
    model = walls_side_by_side(1.0, 3.0)
    demand, least = SITE.a_g * SITE.S / 2.0, 0.2 * G / FC
    assert least < demand < 1.1 * least
    for result in (lb.nonassociated(model), lb.bounds(model)):
        found = verification(model, result, SITE, q=2.0, damage_demand=SITE)
        assert found["a0*"] == pytest.approx(least, rel=1e-6)
        assert found["a_g,SLD"] == pytest.approx(least / SITE.S, rel=1e-6)
        assert found["M*"] == pytest.approx(found["sum P"] / G, rel=1e-12)
        assert [one.satisfied for one in found.checks] == [False, False]


def test_many_mechanisms_are_seen_where_that_of_the_curve_moves_all_as_one():
    """Two equal walls of one rotation: e* = 1, so that no linear check is less; a wall alone might be."""
    model = walls_side_by_side(1.0, 1.0)
    solved, curve = lb.bounds(model), capacity_curve(model, steps=3)
    first, *rest = curve.points
    same = replace(curve, points=(replace(first, result=solved), *rest))
    found = verification(model, solved, SITE, q=2.0, curve=same)
    assert found["e*"] == pytest.approx(1.0)
    assert [one.name for one in found.checks] == ["linear, SLV"]
    assert "one of many with this alpha0" in found.left_out
