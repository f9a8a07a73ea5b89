"""Fill on top of blocks: its weight and moment are those of the body of fill."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

import limitblocks as lb

GAMMA, LEVEL, DEPTH = 18e3, 6.5, 1.7
ARCH = lb.structures.arch(lb.PointContact(0.6), radius=5.0, thickness=0.6, voussoirs=11, depth=DEPTH)


def extrados(radius=5.3, voussoirs=11):
    """Corners (x, z) of the extrados from left to right."""
    angles = np.linspace(-np.pi / 2, np.pi / 2, voussoirs + 1)
    return radius * np.column_stack([np.sin(angles), np.cos(angles)])


def test_fill_over_an_arch_weighs_what_is_between_level_and_extrados():
    load = lb.loads.fill(GAMMA, LEVEL).on(ARCH.free_blocks)
    (x, z) = extrados().T
    area = LEVEL * (x[-1] - x[0]) - np.trapezoid(z, x)
    assert -load[:, 2].sum() == pytest.approx(GAMMA * DEPTH * area, rel=1e-9)
    assert not load[:, :2].any()  # no earth pressure asked for
    each = GAMMA * DEPTH * np.diff(x) * (LEVEL - (z[1:] + z[:-1]) / 2)
    assert -load[:, 2] == pytest.approx(each, rel=1e-9)
    names = [ARCH.free_blocks[k].name for k in (5, 5, 7)]  # a block named twice has its fill once
    some = lb.loads.fill(GAMMA, LEVEL, blocks=names).on(ARCH.free_blocks)
    assert -some[:, 2] == pytest.approx(np.where(np.isin(np.arange(11), (5, 7)), each, 0.0), rel=1e-9)


def test_horizontal_earth_pressure_is_the_integral_over_height():
    coefficient = 0.4
    load = lb.loads.fill(GAMMA, LEVEL, earth_pressure=coefficient).on(ARCH.free_blocks)
    depth = LEVEL - extrados()[:6, 1]  # the left half up to the block at the crown
    each = coefficient * GAMMA * DEPTH * (depth[:-1] ** 2 - depth[1:] ** 2) / 2
    assert load[:5, 0] == pytest.approx(each, rel=1e-9)
    assert load[:, 0].sum() == pytest.approx(0.0, abs=1e-6)
    # moment about the axis of the circle: pressure K p on dz, lever z
    moment = 0.0
    for (_, a), (_, b) in zip(extrados()[:5], extrados()[1:6], strict=True):
        z, w = np.polynomial.legendre.leggauss(3)
        z = (a + b) / 2 + (b - a) / 2 * z
        moment += coefficient * GAMMA * DEPTH * (b - a) / 2 * float(w @ ((LEVEL - z) * z))
    left, plain = load[:5], lb.loads.fill(GAMMA, LEVEL).on(ARCH.free_blocks)[:5]
    arms = np.stack([block.centroid for block in ARCH.free_blocks[:5]])
    extra = left - plain
    assert (extra[:, 3:] + np.cross(arms, extra[:, :3]))[:, 1].sum() == pytest.approx(moment)


@given(st.floats(-1.5, 1.5), st.floats(-1.5, 1.5), st.floats(0.2, 3.0), st.integers(0, 100))
def test_fill_is_the_weight_of_its_body(dx, dy, cover, seed):
    """On a plane slope: force and moment are those of a block made of the fill."""
    plan = np.array([(0, 0), (2, 0), (2.5, 1.0), (0.5, 1.5)])
    top = np.column_stack([plan, 1.0 + plan @ (dx, dy) / 2])
    low = np.column_stack([plan, np.full(4, top[:, 2].min() - 1.0)])
    level = top[:, 2].max() + cover
    high = np.column_stack([plan, np.full(4, level)])
    faces = [(3, 2, 1, 0), (4, 5, 6, 7), *((k, (k + 1) % 4, (k + 1) % 4 + 4, k + 4) for k in range(4))]
    turn = Rotation.from_rotvec((0, 0, seed)).as_matrix()  # about Z
    stone, body = (
        lb.Block(name, np.concatenate(parts), faces, weight).moved(turn, (30.0, -7.0, 0.0))
        for name, parts, weight in (("stone", (low, top), 1.0), ("body", (top, high), GAMMA))
    )
    load = lb.loads.fill(GAMMA, level, blocks="stone").on([stone])[0]
    weight = np.array([0, 0, -body.weight])
    assert load[:3] == pytest.approx(weight, rel=1e-9, abs=1e-6)
    assert load[3:] == pytest.approx(
        np.cross(body.centroid - stone.centroid, weight), abs=1e-9 * body.weight * stone.size
    )


@pytest.mark.parametrize(
    ("tilt", "level"), [((0.9, 0.9), 0.35), ((1.1, 0.3), 0.15), ((0.3, 1.2), 0.15), ((0.5, 0.7), 0.05)]
)
def test_turning_a_leaning_channel_about_the_vertical_turns_what_rests_on_it(tilt, level):
    """It rises above the level; next to ends of edges rounding lets them cross in plan. 7 % too much fill."""
    channel = [(0.6, 0), (0.6, 1), (0.3, 1), (0.3, 0.3), (-0.3, 0.3), (-0.3, 1), (-0.6, 1), (-0.6, 0)]
    leaning = Rotation.from_euler("xy", tilt)
    made = lb.Block.prism("channel", np.subtract(channel, (0.0, 0.5)), (-0.25, 0.25), 1.0, along="z")
    found = []
    for angle in np.linspace(0.0, 6.28, 60):
        turn = Rotation.from_euler("z", angle).as_matrix()
        block = made.moved(turn @ leaning.as_matrix(), np.zeros(3))
        found.append(lb.loads.fill(GAMMA, level).on([block]).reshape(2, 3) @ turn)
    assert np.array(found) == pytest.approx(np.array([found[0]] * 60), abs=1e-8 * GAMMA)


@pytest.mark.parametrize("seed", [1294, 2061, 3284, 4672, 5540])
def test_what_rests_on_leaning_courses_is_that_on_their_mirror_image(seed):
    """Two stones below one: what rounding left of a face beside one came back as the face beside the next."""
    draw = np.random.default_rng(seed).uniform
    lean, heights, tilts, angle = (
        draw(-0.4, 0.4, 2),
        draw(0.5, 1.5, 2),
        draw(-0.3, 0.3, (2, 2)),
        draw(0, 2 * np.pi),
    )
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    cut = draw(0.3, 0.7)
    beds = [np.zeros(3), np.array([heights[0], *tilts[0]]), np.array([heights.sum(), *tilts[1]])]
    stones = []
    for low, high, bed in ((0, cut, 0), (cut, 1, 0), (0, 1, 1)):
        box = lb.Block.prism("box", [(low, 0), (high, 0), (high, 1), (low, 1)], (0, 1), along="z")
        x = box.vertices[:, :2] @ turn
        plane = np.where(box.vertices[:, 2:] > 0.5, beds[bed + 1], beds[bed])
        z = plane[:, 0] + (plane[:, 1:] * x).sum(axis=1)
        stones.append(lb.Block(f"{low}{bed}", np.column_stack([x + np.outer(z, lean), z]), box.faces, 1.0))
    images = [lb.Block(b.name, b.vertices * [-1, 1, 1], [f[::-1] for f in b.faces], 1.0) for b in stones]
    for level in (0.75, 5.0):
        own, other = (lb.loads.fill(GAMMA, level, earth_pressure=0.3).on(b) for b in (stones, images))
        assert own == pytest.approx(other * [-1, 1, 1, 1, -1, -1], abs=1e-8 * GAMMA)


def test_only_what_is_below_the_level_and_not_covered_gets_fill():
    low = lb.Block.box("low", (4, 2, 1), (0, 0, 0.5), 1.0)
    high = lb.Block.box("high", (1, 1, 3), (-0.5, 0.5, 2.5), 1.0)
    load = lb.loads.fill(GAMMA, 2.5).on([low, high])
    assert load[0, 2] == pytest.approx(-GAMMA * 1.5 * (4 * 2 - 1))
    assert load[0, 3:] == pytest.approx(  # the column missing at (-0.5, 0.5): r x F of a lifted weight
        np.cross((-0.5, 0.5, 0), (0, 0, GAMMA * 1.5)), abs=1e-6
    )
    assert not load[1].any()
    bridge = lb.Block.box("bridge", (1, 4, 1), (1, 0, 1.8), 1.0)  # hangs over, without touching
    load = lb.loads.fill(GAMMA, 2.5, blocks=["low"]).on([low, high, bridge])
    assert load[0, 2] == pytest.approx(-GAMMA * 1.5 * (4 * 2 - 1 - 2))


@pytest.mark.parametrize("courses", [1, 4])
@pytest.mark.parametrize("batter", [0.0, 1e-3, 0.3])
def test_fill_behind_a_battered_wall_presses_its_back_alone(courses, batter):
    """The back leans .5 m over 2 m, the front by the batter: a wedge of fill, its thrust K gamma h2 / 2."""
    length, height, k = 3.0, 2.0, 0.33
    ends = np.linspace(0.0, 1.0, courses + 1)
    stones = [
        lb.Block.prism(
            f"course {a}",
            [(a / 2 - 1, height * a), (1 - batter * a, height * a), (1 - batter * b, height * b),
             (b / 2 - 1, height * b)],
            (0.0, length),
        )
        for a, b in pairwise(ends)
    ]  # fmt: skip
    load = lb.loads.fill(GAMMA, height, earth_pressure=k, beyond=(0.0, 9.0), towards=(-2.0, 0, 0)).on(stones)
    thrust, weight = k * GAMMA * height**2 / 2 * length, GAMMA * 0.5 * height / 2 * length
    assert load[:, :3].sum(axis=0) == pytest.approx([thrust, 0.0, -weight], abs=1e-6)
    about = load[:, 3:] + np.cross([stone.centroid for stone in stones], load[:, :3])
    # at a third of the height; the weight at that of the wedge, from x = -1 to -.5
    expected = np.cross((0, length / 2, height / 3), (thrust, 0, 0))
    expected += np.cross((-1 + 0.5 / 3, length / 2, 0), (0, 0, -weight))
    assert about.sum(axis=0) == pytest.approx(expected, abs=1e-6)


def test_fill_behind_a_stepped_wall_rests_on_the_ledges_behind_it():
    """Ledges of 1 m on both sides; where the fill ends on one, that is cut."""
    base = lb.Block.box("base", (3, 2, 1), (0, 0, 0.5))
    wall = lb.Block.box("wall", (1, 2, 2), (0, 0, 2))
    for place, length in (((0, 0), 1.0), ((-1.2, 5), 0.3), ((-0.4, 1), 1.0)):
        load = lb.loads.fill(GAMMA, 3.0, beyond=place, towards=(-1, 0, 0)).on([base, wall])
        weight = GAMMA * 2.0 * 2.0 * length
        assert load[0, 2] == pytest.approx(-weight)
        assert load[0, 4] == pytest.approx(-(1.5 - length / 2) * weight)
        assert not load[1].any()
    with pytest.raises(lb.ModelError, match=r"or not beyond \(-1.5, 0\) m in plan along -X"):
        lb.loads.fill(GAMMA, 3.0, beyond=(-1.5, 0), towards=(-1, 0, 0)).on([base, wall])


def test_a_hole_in_the_fill():
    slab = lb.Block.box("slab", (4, 4, 1), (0, 0, 0.5), 1.0)
    post = lb.Block.box("post", (1, 1, 5), (0.3, 0.2, 3.5), 1.0)
    load = lb.loads.fill(GAMMA, 2.0, blocks="slab").on([slab, post])[0]
    assert load[2] == pytest.approx(-GAMMA * 15)
    assert load[3:] == pytest.approx(np.cross((0.3, 0.2, 0), (0, 0, GAMMA)), abs=1e-6)


def test_a_plate_and_a_stone_that_leans_over_cover_what_is_below_them():
    """The plate is .05 thick; the stone, beside the slab, leans over it from x = 1 at its top to x = 0."""
    slab = lb.Block.box("slab", (3, 4, 1), (-0.5, 0, 0.5), 1.0)
    plate = lb.Block.box("plate", (1, 1, 0.05), (-1, 0, 1.025), 1.0)
    assert lb.loads.fill(GAMMA, 2.0, blocks="slab").on([slab, plate])[0, 2] == pytest.approx(-GAMMA * 11)
    stone = lb.Block.prism("stone", [(2, 0), (3, 0), (0.2, 2), (0, 2)], (-1, 1), 1.0)
    assert lb.loads.fill(GAMMA, 3.0, blocks="slab").on([slab, stone])[0, 2] == pytest.approx(-2 * GAMMA * 10)


def test_a_stone_that_leans_away_covers_nothing():
    """Its side goes on from that of the slab, which leans out: above the slab it is beside it."""
    slab = lb.Block.prism("slab", [(-2, 0), (0.5, 0), (1, 1), (-2, 1)], (-1, 1), 1.0)
    stone = lb.Block.prism("stone", [(0.5, 0), (1.5, 0), (3, 3), (2, 3)], (-1, 1), 1.0)
    assert lb.loads.fill(GAMMA, 4.0, blocks="slab").on([slab, stone])[0, 2] == pytest.approx(-3 * GAMMA * 6)


def test_what_is_above_the_level_covers_nothing():
    """A storey above, the overhang of the block itself, and a leaning stone above where its underside,
    x + z = 2, meets the level."""
    slab = lb.Block.box("slab", (3, 4, 1), (-0.5, 0, 0.5), 1.0)
    storey = lb.Block.box("storey", (9, 9, 1), (0, 0, 5.5), 1.0)
    assert lb.loads.fill(GAMMA, 2.0).on([slab, storey])[:, 2] == pytest.approx([-GAMMA * 12, 0.0])
    stone = lb.Block.prism("stone", [(2, 0), (3, 0), (0.2, 2), (0, 2)], (-1, 1), 1.0)
    covered = (1.0 - 0.5) * 2  # from x = 2 - 1.5 to the end of the slab at 1, 2 deep
    load = lb.loads.fill(GAMMA, 1.5, blocks="slab").on([slab, stone])[0, 2]
    assert load == pytest.approx(-GAMMA * 0.5 * (12 - covered))
    # a C whose upper jaw, from x = 2 on, is thinner in its lower half: 1.5 <= z < 2 from x = 2, above from 1
    jaws = lb.Block.prism(
        "C", [(0, 0), (3, 0), (3, 1), (1, 1), (1, 2), (2, 2), (2, 1.5), (3, 1.5), (3, 3), (0, 3)], (0, 1), 1.0
    )
    for level, free in ((1.5, 2.0), (1.8, 1.0)):  # lengths of the lower jaw with nothing up to the level
        assert lb.loads.fill(1.0, level).on([jaws])[0, 2] == pytest.approx(-(level - 1.0) * free)


def test_level_through_a_slope_fills_the_lower_part():
    """Slope from z = 0 at x = 2 to z = 1 at x = 0, level 0.5: a prism 1 long, 0.5 high, 3 deep."""
    wedge = lb.Block.prism("wedge", [(0, 0), (2, 0), (0, 1)], (0, 3))
    load = lb.loads.fill(GAMMA, 0.5).on([wedge])[0]
    weight = GAMMA * 3 * 0.5 * 1 * 0.5
    assert load[2] == pytest.approx(-weight)
    assert load[3:] == pytest.approx(np.cross((1 + 2 / 3 - 2 / 3, 0, 0), (0, 0, -weight)), abs=1e-6)


def test_fill_strengthens_and_models_can_be_analysed():
    """A block of b x h under fill of height c over its top: the load factor of a push at mid-height grows by
    the weight of the fill: (W + F) b / 2 over H h / 2."""
    ground = lb.Block.box("ground", (4, 4, 0.2), (0, 0, -0.1))
    block = lb.Block.box("block", (1, 1, 2), (0, 0, 1), 20e3)
    dead = lb.self_weight() + lb.loads.fill(GAMMA, 3.0)
    live = lb.loads.force("block", (1e3, 0, 0), at=(0, 0, 1))
    model = lb.Model(
        [ground, block], ["ground"], lb.find_interfaces([ground, block], lb.PointContact(9.0)), dead, live
    )
    assert lb.bounds(model).lower == pytest.approx((40e3 + GAMMA) * 0.5 / 1e3, rel=1e-6)


@pytest.mark.parametrize(
    ("load", "said"),
    [
        (lambda: lb.loads.fill(-1.0, LEVEL), "unit weight is -1.0"),
        (lambda: lb.loads.fill(0.0, LEVEL), "unit weight is 0.0"),
        (lambda: lb.loads.fill(GAMMA, np.nan), "level is nan"),
        (lambda: lb.loads.fill(GAMMA, LEVEL, earth_pressure=-0.3), "-0.3"),
        (lambda: lb.loads.fill(GAMMA, LEVEL, towards=(1, 0, 0)), "are given together"),
        (lambda: lb.loads.fill(GAMMA, LEVEL, beyond=(0, 0), towards=(1, 0, 1)), "a horizontal direction"),
        (lambda: lb.loads.fill(GAMMA, LEVEL, beyond=(0, 0, 1), towards=(1, 0, 0)), "expected two finite"),
        (lambda: lb.loads.fill(GAMMA, LEVEL, blocks=["crown"]), "'crown'"),
        (lambda: lb.loads.fill(GAMMA, LEVEL, blocks=["Voussoir 6"]), "did you mean 'voussoir 6'?"),
        (lambda: lb.loads.fill(GAMMA, 5.0, blocks="voussoir 6"), "level 5 m"),
    ],
)
def test_wrong_fill_is_refused(load, said):
    with pytest.raises(lb.ModelError, match=said):
        load().on(ARCH.free_blocks)


def test_a_surcharge_is_a_layer_less_the_fill_below():
    """q on the surface: q on the plan of each face, K q on its vertical projection."""
    q, K, t = 5e3, 0.4, 0.5
    load = sum(
        sign * lb.loads.fill(q / t, LEVEL + top, earth_pressure=K) for sign, top in ((1, t), (-1, 0.0))
    ).on(ARCH.free_blocks)
    (x, z) = extrados().T
    assert -load[:, 2] == pytest.approx(q * DEPTH * np.diff(x), rel=1e-9)
    assert load[:, 0] == pytest.approx(K * q * DEPTH * np.diff(z), rel=1e-9, abs=1e-6)


def test_a_level_under_what_covers_all_leaves_no_fill():
    """The outer ring covers the inner one but for rounding errors: no fill of 8e-15 N at .1 m."""
    bridge = lb.structures.arch_bridge(
        lb.PointContact(0.6), span=3.0, rise=0.75, thickness=0.3, voussoirs=11, rings=2
    )
    with pytest.raises(lb.ModelError, match=r"level 0\.1 m leaves no fill"):
        lb.loads.fill(GAMMA, 0.1).on(bridge.free_blocks)


def test_a_block_that_is_not_convex_covers_itself_and_no_more():
    """Below its own overhang there is no fill; in a courtyard there is, whatever stands around."""
    hooked = lb.Block.prism(
        "C", [(0, 0), (3, 0), (3, 1), (1, 1), (1, 2), (3, 2), (3, 3), (0, 3)], (0, 1), 1.0
    )
    load = lb.loads.fill(1.0, 4.0).on([hooked])
    assert load[0, 2] == pytest.approx(-3.0 * 1.0)
    assert load[0, 4] == pytest.approx(3.0 * (1.5 - hooked.centroid[0]))
    around = [(0, 0), (3, 0), (3, 3), (2, 3), (2, 1), (1, 1), (1, 3), (0, 3)]
    walls = lb.Block.prism("walls", around, (0, 2), 1.0, along="z")
    court = lb.Block.box("court", (1, 2, 1), (1.5, 2.0, 0.5), 1.0)
    assert lb.loads.fill(1.0, 3.0).on([walls, court])[:, 2] == pytest.approx([-7.0 * 1.0, -2.0 * 2.0])
