"""Capacity curves of ties that go slack, are taut again, yield, or keep their length: closed forms."""

from dataclasses import replace

import numpy as np
import pytest
from few_blocks import moved
from scipy.optimize import brentq

import limitblocks as lb
from limitblocks.practice import capacity_curve, reinforced, strip, tie
from limitblocks.practice.displaced import assembly_of
from limitblocks.practice.rejoined import rows_of

UNIT_WEIGHT = 20e3
FRICTION = lb.PointContact(0.9)


def model_of(*blocks, supports=("ground",)):
    push = lb.mass_proportional((1, 0, 0))
    return lb.Model(blocks, supports, lb.find_interfaces(blocks, FRICTION), lb.self_weight(), push)


def box(name, size, at):
    return lb.Block.box(name, size, at=at, unit_weight=UNIT_WEIGHT)


@pytest.mark.parametrize("reach", [0.30, 0.45])
def test_a_tie_that_is_slack_carries_nothing_until_it_is_taut_again(reach):
    """A wall hinges under a tie up and forward: its anchors approach, then part. Moments about the toe."""
    b, h, roof, area, strength = 0.6, 3.0, 4.5, 1e-5, 5e7
    wall = model_of(
        lb.Block.box("ground", (4, 1, 0.4), at=(0, 0, -0.2)),
        box("wall", (b, 1, h), (0, 0, h / 2)),
        box("roof", (0.5, 1, 0.3), (b / 2 + reach, 0, roof + 0.15)),
        supports=("ground", "roof"),
    )
    head = (b / 2, 0, h)
    tied = reinforced(wall, tie("wall", head, "roof", (b / 2 + reach, 0, roof), area=area, strength=strength))
    curve = capacity_curve(tied, control=("wall", head), steps=10)
    first, weight = np.hypot(reach, roof - h), b * h * UNIT_WEIGHT

    def by_hand(turn, pulls):
        at = h * np.array([np.sin(turn), np.cos(turn)])  # of the head from the toe
        way = np.array([reach, roof]) - at
        height = h / 2 * np.cos(turn) + b / 2 * np.sin(turn)
        about_toe = (at[0] * way[1] - at[1] * way[0]) / np.linalg.norm(way) * area * strength
        bare = np.tan(np.arctan(b / h) - turn)
        return np.linalg.norm(way) - first, bare + pulls * about_toe / (weight * height)

    taut = brentq(lambda turn: by_hand(turn, 0)[0], 0.05, 0.3)
    for point in curve.points[1:]:
        turn = np.arcsin(point.displacement / h)
        if abs(turn - taut) > 1e-4:
            assert point.load_factor == pytest.approx(by_hand(turn, turn > taut)[1], abs=1e-7)
    later = taut < np.arctan(b / h)
    zero = brentq(lambda turn: by_hand(turn, later)[1], 0.1, 0.3)
    assert curve.zero == pytest.approx(h * np.sin(zero), rel=1e-6)
    said = [one for point in curve.points for one in point.changes]
    assert "tie wall|roof goes slack" in said
    assert ("tie wall|roof is taut again" in said) == later == (reach == 0.30)


@pytest.mark.parametrize("steps", [3, 10])
def test_a_tie_that_does_not_yield_keeps_its_length(steps):
    """Two walls with a rod between turn about their toes: virtual power at turns that keep its length."""
    thin, thick, apart = np.array([0.5, 4.0]), np.array([1.2, 2.5]), 2.5
    model = model_of(
        lb.Block.box("ground", (12, 1, 0.4), at=(1.5, 0, -0.2)),
        box("thin", (thin[0], 1, thin[1]), (apart, 0, thin[1] / 2)),
        box("thick", (thick[0], 1, thick[1]), (0, 0, thick[1] / 2)),
    )
    ends = np.array([[apart - thin[0] / 2, 3.5], [thick[0] / 2, 2.4]])
    tied = reinforced(
        model,
        tie(
            "thick", (ends[1, 0], 0, ends[1, 1]), "thin", (ends[0, 0], 0, ends[0, 1]), area=1e-3, strength=1e9
        ),
    )
    toes = np.array([[apart + thin[0] / 2, 0.0], [thick[0] / 2, 0.0]])
    middles = np.array([[apart, thin[1] / 2], [0.0, thick[1] / 2]])

    def turned(points, turn, k):
        c, s = np.cos(turn), np.sin(turn)
        return toes[k] + (points[k] - toes[k]) @ np.array([[c, -s], [s, c]])

    def way(turns):
        return turned(ends, turns[0], 0) - turned(ends, turns[1], 1)

    def load_factor(turn):
        length = np.linalg.norm(ends[0] - ends[1])
        other = brentq(lambda t: np.linalg.norm(way((turn, t))) - length, 0.0, 2.0 * turn)
        turns, along = (turn, other), way((turn, other))

        def speed(points, k):
            x, z = turned(points, turns[k], k) - toes[k]
            return np.array([z, -x])

        pace = (along @ speed(ends, 0)) / (along @ speed(ends, 1))
        power = thin.prod() * speed(middles, 0) + pace * thick.prod() * speed(middles, 1)
        return -power[1] / power[0]

    zero = thin[1] * np.sin(brentq(load_factor, 0.1, 0.24))
    curve = capacity_curve(tied, control=("thin", (toes[0, 0], 0.5, thin[1])), steps=steps)
    assert curve.zero == pytest.approx(zero, rel=1e-6)


@pytest.mark.parametrize("way", [-0.1, 0.2])
def test_what_a_tie_has_yielded_stays(way):
    """It is taut at the greatest distance that its anchors have had, however it ends a step."""
    wall = model_of(
        lb.Block.box("ground", (4, 1, 0.4), at=(0, 0, -0.2)), box("wall", (0.5, 1, 3), (0, 0, 1.5))
    )
    tied = reinforced(wall, tie("wall", (0, 0, 2), "ground", (-2, 0, 2), area=1e-4, strength=1e7))
    own = assembly_of(tied).contacts[-1]
    longer = replace(own, on_j=own.on_j + way * own.line)
    assert own.taut == pytest.approx(2.0)
    assert longer.ways[0, 2] == pytest.approx(-way)
    assert longer.yielded(longer.tied).taut == pytest.approx(max(2.0, 2.0 + way))


@pytest.mark.parametrize("length", [True, False])
def test_rates_of_what_a_tie_is_slack_are_those_of_its_anchors(length):
    """Central differences of the gap in screws of both blocks; a strip is across its joint."""
    wall = model_of(
        lb.Block.box("ground", (4, 1, 0.4), at=(0, 0, -0.2)), box("wall", (0.5, 1, 3), (0, 0, 1.5))
    )
    joint = wall.interfaces[0]
    element = (
        tie("wall", (0, 0.2, 2), "ground", (-2, -0.1, 0), area=1e-4, strength=1e7)
        if length
        else strip(joint, joint.centroid + np.array([0.1, 0, 0]), width=0.1, capacity=1e3)
    )
    assembly = assembly_of(reinforced(wall, element))
    way = np.random.default_rng(0).normal(size=(2, 6))
    gap = [moved(assembly, t * way).contacts[-1].ways[0, 2] for t in (1e-6, -1e-6)]
    rate = (rows_of(assembly.contacts, assembly.at_rest.at) @ way.ravel())[-1]
    assert rate == pytest.approx((gap[0] - gap[1]) / 2e-6, rel=1e-6)
