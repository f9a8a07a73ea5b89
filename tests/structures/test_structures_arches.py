"""Arches of every shape: counts, areas by formula, joints, fill."""

from functools import partial

import numpy as np
import pytest
from scipy.special import ellipe
from stones import volume

import limitblocks as lb
from limitblocks import structures
from limitblocks.structures import Fill, Piers

JOINT = lb.PointContact(0.8)


def along(model, axis, load="dead"):
    """Sum of a load along a coordinate axis."""
    return getattr(model, load).on(model.free_blocks)[:, axis].sum()


def circle(**change):
    return structures.arch(JOINT, **{"radius": 2.0, "thickness": 0.5, "voussoirs": 9} | change)


@pytest.mark.parametrize("n", [6, 9])
@pytest.mark.parametrize("facets", [1, 4])
def test_facets_follow_the_extrados(n, facets):
    model = circle(voussoirs=n, facets=facets)
    outer, inner = 2.25, 1.75

    def polygon(sides, r):
        return sides / 2 * r**2 * np.sin(np.pi / sides)  # half a regular polygon of twice as many sides

    assert volume(model) == pytest.approx(polygon(n * facets, outer) - polygon(n, inner))
    assert len(model.interfaces) == n + 1
    assert all(len(block.faces) == 5 + facets for block in model.free_blocks)


@pytest.mark.parametrize(("embrace", "n"), [(np.pi, 9), (np.pi, 12), (np.pi / 3, 9)])
def test_vertical_joints_are_vertical(embrace, n):
    model = circle(voussoirs=n, embrace=embrace, stereotomy="vertical", facets=3)
    inside = [i for i in model.interfaces if "support" not in i.name]
    assert len(inside) == n - 1
    assert all(abs(i.axes[2, 0]) == pytest.approx(1.0) for i in inside)
    for i in inside:
        x, z = i.centroid[0], i.centroid[2]
        low, high = np.sqrt(1.75**2 - x**2), np.sqrt(2.25**2 - x**2)
        assert z == pytest.approx((low + high) / 2)
        assert lb.joints.areas(i.polygon) == pytest.approx(high - low)
    springings = [i for i in model.interfaces if "support" in i.name]
    assert [lb.joints.areas(i.polygon) for i in springings] == pytest.approx([0.5, 0.5])


@pytest.mark.parametrize("n", [5, 9, 40])
def test_sides_of_an_extrados_are_no_wider_than_voussoirs(n):
    """Beyond the last vertical joint the semicircle of 0.5 m has 39 degrees of extrados."""
    model = circle(voussoirs=n, stereotomy="vertical")
    last = np.arccos(1.75 * np.cos(np.pi / n) / 2.25)
    assert len(model.free_blocks[0].faces) == 5 + np.ceil(last / (np.pi / n))
    assert len(circle(voussoirs=n).free_blocks[0].faces) == 6


def test_special_cases_are_the_semicircle():
    semicircle = circle()
    for model in (
        structures.segmental_arch(JOINT, span=4.0, rise=2.0, thickness=0.5, voussoirs=9),
        structures.elliptical_arch(JOINT, span=4.0, rise=2.0, thickness=0.5, voussoirs=9),
    ):
        for mine, theirs in zip(model.blocks, semicircle.blocks, strict=True):
            assert mine.vertices == pytest.approx(theirs.vertices, abs=1e-7)


def test_segmental_arch_has_its_span_and_rise():
    span, rise, t = 4.0, 0.7, 0.3
    model = structures.segmental_arch(JOINT, span=span, rise=rise, thickness=t, voussoirs=11)
    feet = [i.centroid for i in model.interfaces if "support" in i.name]
    assert abs(feet[0][0] - feet[1][0]) == pytest.approx(span)
    radius = (span**2 / 4 + rise**2) / (2 * rise)
    assert radius - feet[0][2] == pytest.approx(rise)
    embrace, sector = 4 * np.arctan(2 * rise / span), np.sin(2 / 11 * 2 * np.arctan(2 * rise / span)) / 2
    assert embrace < np.pi
    assert volume(model) == pytest.approx(11 * sector * 2 * radius * t)


@pytest.mark.parametrize("rise", [1.2, np.sqrt(3.0), 2.5])
def test_pointed_arch(rise):
    t, n = 0.3, 200
    model = structures.pointed_arch(JOINT, span=2.0, rise=rise, thickness=t, voussoirs=n, facets=5)
    assert len(model.interfaces) == n + 1
    shift = (rise**2 - 1.0) / 2.0
    half = 0.0  # sector about a centre less the triangle between it and the middle
    for r, sign in ((1.0 + shift + t / 2, 1), (1.0 + shift - t / 2, -1)):
        half += sign * (r**2 * np.arccos(shift / r) - shift * np.sqrt(r**2 - shift**2)) / 2
    assert volume(model) == pytest.approx(2 * half, rel=1e-4)
    (apex,) = [i for i in model.interfaces if abs(i.axes[2, 0]) > 1 - 1e-9]
    low, high = (np.sqrt((1.0 + shift + side * t / 2) ** 2 - shift**2) for side in (-1, 1))
    assert apex.centroid == pytest.approx([0.0, 0.0, (low + high) / 2])
    assert lb.joints.areas(apex.polygon) == pytest.approx(high - low)


@pytest.mark.parametrize("rise", [1.2, 2.8])
def test_elliptical_arch(rise):
    a, t, n = 2.0, 0.3, 300
    model = structures.elliptical_arch(JOINT, span=2 * a, rise=rise, thickness=t, voussoirs=n)
    big, small = max(a, rise), min(a, rise)
    length = 2 * big * ellipe(1 - (small / big) ** 2)
    assert volume(model) == pytest.approx(length * t, rel=1e-4)  # between parallels of the centreline
    middles = np.array([i.centroid for i in model.interfaces])
    assert (middles[:, 0] / a) ** 2 + (middles[:, 2] / rise) ** 2 == pytest.approx(np.ones(n + 1))
    areas = [lb.joints.areas(i.polygon) for i in model.interfaces]
    assert areas == pytest.approx(np.full(n + 1, t))
    middles = middles[np.argsort(middles[:, 0])]
    steps = np.linalg.norm(np.diff(middles, axis=0), axis=1)
    assert steps == pytest.approx(np.full(n, length / n), rel=1e-3)


BUILDERS = {
    "arch": circle,
    "segmental": partial(structures.segmental_arch, JOINT, span=4.0, rise=1.0, thickness=0.4, voussoirs=9),
    "pointed": partial(structures.pointed_arch, JOINT, span=4.0, rise=2.8, thickness=0.5, voussoirs=8),
    "elliptical": partial(structures.elliptical_arch, JOINT, span=4.0, rise=1.6, thickness=0.5, voussoirs=9),
}


@pytest.mark.parametrize("name", BUILDERS)
def test_piers_carry_the_arch(name):
    bare, width, count, height = BUILDERS[name](), 1.1, 2, 0.3
    model = BUILDERS[name](piers=Piers(width, count, height))
    stones = 2 if name == "segmental" else 0  # skewbacks
    assert len(model.free_blocks) == len(bare.free_blocks) + 2 * count + stones
    assert len(model.interfaces) == len(bare.interfaces) + 2 * count + stones
    shift = (width - 0.0) * count * height * 2
    skewbacks = sum(block.volume for block in model.free_blocks if "skewback" in block.name)
    assert volume(model) == pytest.approx(volume(bare) + shift + skewbacks)
    assert (skewbacks > 0.0) == (stones > 0)


@pytest.mark.parametrize("name", BUILDERS)
def test_thicker_arches_are_stronger(name):
    load_factors = [lb.bounds(BUILDERS[name](thickness=t)).lower for t in (0.4, 0.5, 0.6)]
    assert np.all(np.diff(load_factors) > 0.0)


@pytest.mark.parametrize("facets", [1, 3])
def test_fill_of_a_semicircle(facets):
    """The fill is what is left of a rectangle above the extrados, a polygon of n facets."""
    n, outer, height, gamma, depth, k = 8, 2.25, 0.4, 18e3, 1.5, 0.3
    plain = circle(voussoirs=n, facets=facets, depth=depth)
    model = circle(voussoirs=n, facets=facets, depth=depth, fill=Fill(height, gamma, pressure=k, inertia=0.5))
    sides = n * facets
    area = 2 * outer * (outer + height) - sides / 2 * outer**2 * np.sin(np.pi / sides)
    assert -along(model, 2) == pytest.approx(-along(plain, 2) + gamma * area * depth)
    assert along(model, 0) == pytest.approx(0.0, abs=1e-6 * gamma)
    left = model.dead.on(model.free_blocks)[: n // 2, 0].sum()
    level = outer + height
    assert left == pytest.approx(k * gamma * depth * (level * outer - outer**2 / 2))
    assert along(model, 0, "live") == pytest.approx(along(plain, 0, "live") + 0.5 * gamma * area * depth)


def test_fill_up_to_a_flat_crown():
    """Five facets, the middle one level: what is left of the rectangle up to it."""
    outer, gamma, depth = 2.25, 18e3, 1.5
    plain = circle(voussoirs=5, depth=depth)
    model = circle(voussoirs=5, depth=depth, fill=Fill(0.0, gamma))
    area = 2 * outer * outer * np.cos(np.pi / 10) - 5 / 2 * outer**2 * np.sin(np.pi / 5)
    assert -along(model, 2) == pytest.approx(-along(plain, 2) + gamma * area * depth)
    assert along(model, 0, "live") == pytest.approx(along(plain, 0, "live") + gamma * area * depth)


def test_fill_loads_the_shoulders_of_the_piers():
    """Its weight is that of the rectangle above the piers less the extrados."""
    n, width, height, gamma = 8, 1.2, 0.4, 18e3
    change = {"voussoirs": n, "piers": Piers(width, 2, 0.4)}
    plain, model = circle(**change), circle(**change, fill=Fill(height, gamma))
    area = 2 * (1.75 + width) * (2.25 + height) - n / 2 * 2.25**2 * np.sin(np.pi / n)
    assert along(plain, 2) - along(model, 2) == pytest.approx(gamma * area)


def test_fill_moment_is_that_of_its_column():
    """A fill as high as nothing over a flat top acts in the middle of each facet: one voussoir by hand."""
    model = circle(voussoirs=2, fill=Fill(0.0, 10e3))
    # the extrados of the left one runs from (-2.25, 0) to (0, 2.25): a triangle of fill above it
    weight, place = 10e3 * 2.25**2 / 2, (-2.25 * 2 / 3, 2.25 / 3)
    _, (_, term), (_, other) = model.live.terms
    assert term.force == pytest.approx((weight, 0.0, 0.0))
    assert term.at == pytest.approx((place[0], 0.0, place[1]))
    assert other.at == pytest.approx((-place[0], 0.0, place[1]))
    fill = model.dead.on(model.free_blocks)[0] - lb.self_weight().on(model.free_blocks)[0]
    lever = place[0] - model.free_blocks[0].centroid[0]
    assert fill == pytest.approx([0.0, 0.0, -weight, 0.0, weight * lever, 0.0])
