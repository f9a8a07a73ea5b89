"""Goodman & Bray (1976), blocks in contact over whole faces: what other solutions there are."""

import math
from dataclasses import replace

import pytest

import limitblocks as lb
from limitblocks import structures

WIDTH, DIP, OWN = 10.0, math.pi / 6, 25e3
HEIGHTS = [*range(4, 41, 4), *range(34, 3, -6)]


def slope(joint):
    """16 blocks on steps of 1 m, drawn level; a force of 1 MN pushes the lowest one down the dip."""
    blocks = [
        lb.Block.box(f"block {n}", (WIDTH, 1, y), (WIDTH * n, 0, n + y / 2), OWN)
        for n, y in enumerate(HEIGHTS, 1)
    ]
    steps = [lb.Block.box(f"step {n}", (WIDTH, 1, 1), (WIDTH * n, 0, n - 0.5)) for n in range(1, 17)]
    beds = [i for s, b in zip(steps, blocks, strict=True) for i in lb.find_interfaces([s, b], joint)]
    weight = lb.mass_proportional((-math.sin(DIP), 0, -math.cos(DIP)))
    push = lb.loads.force("block 1", (-1e6, 0, 0), at=(WIDTH, 0, 1))
    sides = lb.find_interfaces(blocks, joint)
    return lb.Model([*steps, *blocks], [s.name for s in steps], [*beds, *sides], weight, push)


def by_hand(friction):
    """Force on the lowest block, MN, from block to block: each topples or slides, forces at upper edges."""
    P = 0.0
    for n in range(16, 0, -1):
        y, mine = HEIGHTS[n - 1], n + HEIGHTS[n - 1]
        W = OWN * WIDTH * y
        upper = min(mine, n + 1 + HEIGHTS[n]) - n if n < 16 else 0.0
        lower = min(mine, n - 1 + HEIGHTS[n - 2]) - n if n > 1 else 0.0
        slides = P - W * (friction * math.cos(DIP) - math.sin(DIP)) / (1 - friction**2)
        turns = P * (upper - friction * WIDTH) + W / 2 * (y * math.sin(DIP) - WIDTH * math.cos(DIP))
        P = max(slides, turns / lower if lower else -math.inf, 0.0 if n > 1 else -math.inf)
    return -P * (1 - friction**2) / 1e6


def test_forces_by_hand_are_those_in_print():
    """Wyllie & Mah (2004), Section 9.4.3: with friction .7855 nothing is left at the toe."""
    assert by_hand(0.7855) == pytest.approx(0.0, abs=1e-3)
    assert by_hand(0.78554) < 0.0 < by_hand(0.78555)


def test_what_topples_by_hand_stands_by_the_static_theorem():
    """Forces lower in the faces carry the slope with less friction: the hand fixes where they act."""
    model = slope(lb.OrdunaLourenco(0.7))
    assert by_hand(0.7) < -1.35
    assert lb.bounds(model).lower > 0.1
    result = lb.nonassociated(model)
    assert lb.check_mcp(model, result).passed
    below = any("below zero" in remark for remark in result.remarks)
    assert below == (result.load_factor < 0.0)
    if below:  # the solution by hand
        assert result.load_factor == pytest.approx(by_hand(0.7), rel=1e-6)
        assert "below zero" in lb.report(model, result).text.replace("\n", " ")


def test_a_push_on_one_stiff_block_is_followed_from_the_first_increment():
    """The lowest block slides alone, W = 1 MN: .9 cos 30 - sin 30, reached by increments below it."""
    path = lb.load_path(slope(lb.PointContact(0.9)))
    assert path.load_factor == pytest.approx(0.9 * math.cos(DIP) - math.sin(DIP), rel=1e-9)
    assert sum(0.0 < step.load_factor < 0.2 for step in path.steps if step.kind != "polish") >= 3


def test_a_stone_that_its_load_presses_down_has_no_load_factor():
    """Sliding: .25 W + .1 a W = .3 (W + a W), a = -.25; the stone stands, and the load may grow at will."""
    stone = structures.block(lb.PointContact(0.3), width=1.0, height=0.2)
    push = lb.mass_proportional((1.0, 0.0, 0.0))
    dead, live = lb.self_weight() + 0.25 * push, lb.self_weight() + 0.1 * push
    model = replace(stone, dead=dead, live=live)
    assert lb.stability(model).stands
    with pytest.raises(lb.errors.UnlimitedLoad):
        lb.bounds(model)
    for analysis in (lb.nonassociated, lb.load_path):
        with pytest.raises(lb.errors.UnlimitedLoad, match="along the load path"):
            analysis(model)
