"""Structures of the convergence matrix: contacts counted by formula, dead loads that stand, refusals."""

import numpy as np
import pytest
from stones import volume

import limitblocks as lb
from limitblocks import structures

JOINT = lb.PointContact(0.8)


def counts(model):
    return len(model.free_blocks), len(model.interfaces)


def across(model, axis):
    """Number of interfaces whose normal is a coordinate axis."""
    return sum(abs(interface.axes[2, axis]) > 1 - 1e-9 for interface in model.interfaces)


def test_portal():
    n, span, width, height, lintel, depth = 4, 1.6, 0.6, 0.4, 0.3, 0.5
    model = structures.portal(
        JOINT,
        span=span,
        pier_width=width,
        pier_blocks=n,
        block_height=height,
        lintel_height=lintel,
        depth=depth,
    )
    assert counts(model) == (2 * n + 1, 2 * (n + 1))
    assert volume(model) == pytest.approx(depth * (2 * n * width * height + (span + 2 * width) * lintel))
    assert lb.bounds(model).lower > 0.0


def test_arch_on_piers():
    radius, thickness, n, courses, width, height, depth = 1.5, 0.5, 9, 2, 1.2, 0.4, 0.6
    piers = structures.Piers(width, courses, height)
    model = structures.arch(JOINT, radius=radius, thickness=thickness, voussoirs=n, piers=piers, depth=depth)
    assert counts(model) == (n + 2 * courses, n + 1 + 2 * courses)
    outer, inner = radius + thickness / 2, radius - thickness / 2
    ring = n * np.sin(np.pi / n) / 2 * (outer**2 - inner**2)
    assert volume(model) == pytest.approx(depth * (ring + 2 * courses * width * height))
    springings = [i for i in model.interfaces if {i.block_i[0], i.block_j[0]} & {"v"} and "pier" in i.name]
    assert [i.centroid[2] for i in springings] == pytest.approx([courses * height] * 2)
    assert [lb.joints.areas(i.polygon) for i in springings] == pytest.approx([thickness * depth] * 2)
    assert lb.bounds(model).lower > 0.0


@pytest.mark.parametrize(("n_front", "n_side", "courses"), [(2, 2, 1), (3, 4, 2), (4, 3, 5)])
def test_corner_is_interlocked(n_front, n_side, courses):
    stone, height = 0.8, 0.4
    model = structures.corner(
        JOINT, length=n_front * stone, return_length=n_side * stone, courses=courses, block_height=height
    )
    stones = n_front + n_side  # in every course
    # head joints: all but one stone have one, at the corner across either wall; bed joints: every half stone
    bed = (courses - 1) * (2 * stones - 1) + stones
    assert counts(model) == (courses * stones, courses * (stones - 1) + bed)
    assert across(model, 2) == bed
    half = stone / 2
    assert volume(model) == pytest.approx(courses * height * half * (n_front + n_side - 0.5) * stone)
    crossing = [
        i for i in model.interfaces
        if abs(i.axes[2, 2]) > 0.9 and {i.block_i.split()[0], i.block_j.split()[0]} == {"front", "side"}
    ]  # fmt: skip
    assert len(crossing) == courses - 1
    assert [lb.joints.areas(i.polygon) for i in crossing] == pytest.approx([half**2] * len(crossing))
    assert lb.bounds(model).lower > 0.0


@pytest.mark.parametrize(("courses", "stones"), [(5, 1), (6, 2), (7, 3)])
def test_barrel_vault_is_a_running_bond_of_exact_contacts(courses, stones):
    radius, thickness, length, embrace = 1.5, 0.4, 1.8, 2 * np.pi / 3
    model = structures.barrel_vault(
        JOINT, radius=radius, thickness=thickness, length=length, courses=courses, stones=stones
    )
    odd = courses // 2
    blocks = courses * stones + odd  # every second course has one stone more
    heads = blocks - courses
    springings = stones + (stones if courses % 2 else stones + 1)
    beds = 2 * stones * (courses - 1) + springings
    assert counts(model) == (blocks, heads + beds)
    assert across(model, 1) == heads
    outer, inner = radius + thickness / 2, radius - thickness / 2
    sector = np.sin(embrace / courses) / 2
    assert volume(model) == pytest.approx(courses * sector * (outer**2 - inner**2) * length)
    area = 0.0
    for interface in model.interfaces:
        normal = interface.axes[2]
        if abs(normal[1]) < 1e-9:  # a bed joint: a rectangle in a radial plane
            assert len(interface.polygon) == 4
            assert normal @ interface.centroid == pytest.approx(0.0, abs=1e-9)
            assert np.hypot(interface.centroid[0], interface.centroid[2]) == pytest.approx(radius)
            area += lb.joints.areas(interface.polygon)
    assert area == pytest.approx((courses + 1) * thickness * length)
    assert lb.bounds(model).lower > 0.0


def test_stair_turns_about_its_newel():
    n, length, width, rise, turn = 5, 1.2, 0.6, 0.18, 0.4
    model = structures.stair(JOINT, treads=n, length=length, width=width, rise=rise, turn=turn)
    assert counts(model) == (n, n)
    assert volume(model) == pytest.approx(n * length * width * rise)
    for k, tread in enumerate(model.free_blocks):
        out = (length / 2 - 0.3) * np.array([np.cos(k * turn), np.sin(k * turn)])
        assert tread.centroid == pytest.approx([*out, (k + 0.5) * rise])
    assert lb.bounds(model).lower > 0.0


def test_treads_in_line_are_a_column():
    model = structures.stair(JOINT, treads=3, turn=0.0, direction=(0.0, 1.0, 0.0))
    assert lb.bounds(model).lower == pytest.approx(min(JOINT.friction, 0.6 / (3 * 0.18)))


def test_eccentric_lintel_is_governed_by_twist():
    model = structures.eccentric_lintel(lb.OrdunaLourenco(0.3))
    stones, bearing, height, thickness = 3, 1, 0.3, 0.8  # in a course, and below the lintel
    rest = stones - bearing
    # full courses of stones + 1 and stones, the rest of the lintel's course, lintel, course on top, load
    assert len(model.free_blocks) == (stones + 1) + stones + (rest + 1) + 1 + stones + 1
    heads = stones + (stones - 1) + (rest + 1) + (stones - 1)
    beds = (stones + 1) + 2 * stones + 2 * (2 * rest + bearing) + 1
    assert len(model.interfaces) == heads + beds
    assert volume(model) == pytest.approx(thickness * height * (3 * 2.4 + 1.6 + 1.6 + 0.4))
    assert {"lintel", "load"} < {block.name for block in model.free_blocks}
    result = lb.bounds(model)
    assert 0.0 < result.lower < 0.3  # less than sliding
    names = [block.name for block in model.blocks]
    rates = result.displacement_rates[names.index("lintel"), 3:]
    assert abs(rates[2]) > 5.0 * np.abs(rates[:2]).max()  # about Z
