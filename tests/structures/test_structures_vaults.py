"""Groin and pavilion vaults, domes and lunes: contacts and volumes by formula; hulls and cuts."""

from collections import Counter

import numpy as np
import pytest
from stones import volume

import limitblocks as lb
from limitblocks import structures
from limitblocks.geometry.polygon import centroids
from limitblocks.structures.convex import cut, hull
from limitblocks.structures.rings import circular

JOINT = lb.PointContact(0.7)
area_of = lb.joints.areas


def contact_areas(model):
    """Area of all interfaces by kind: vertical on a diagonal, across an axis, or anything else."""
    result = Counter()
    for interface in model.interfaces:
        normal = np.abs(interface.axes[2])
        kind = "bed"
        if normal[2] < 1e-9:
            kind = "diagonal" if abs(normal[0] - normal[1]) < 1e-9 else "head"
        result[kind] += float(area_of(interface.polygon))
    return result


def section(radius, thickness, courses, embrace):
    """Area of a ring of straight voussoirs and its first moment about x = 0, on one side, and its joints."""
    ring = circular(radius, thickness, courses, embrace)
    polygons = np.array([np.clip(outline, (0.0, -np.inf), np.inf) for outline in ring.voussoirs()])
    keep = [p for p in polygons if np.ptp(p[:, 0]) > 0.0]
    area = sum(float(area_of(p)) for p in keep)
    return area, sum(float(area_of(p)) * centroids(p[None])[0, 0] for p in keep), ring


SHAPES = [(2.0, 0.4, 7, np.pi), (2.0, 0.4, 6, np.pi), (3.0, 0.3, 9, 2.2)]


@pytest.mark.parametrize("shape", SHAPES)
def test_groin_vault(shape):
    length, stone = 7.0, 0.7
    radius, thickness, courses, embrace = shape
    model = structures.groin_vault(
        JOINT, radius=radius, thickness=thickness, courses=courses, embrace=embrace, length=length,
        stone_length=stone,
    )  # fmt: skip
    area, moment, ring = section(*shape)
    assert volume(model) == pytest.approx(8 * (length / 2 * area - moment))
    areas = contact_areas(model)
    assert areas["diagonal"] == pytest.approx(4 * np.sqrt(2) * area)
    joints = np.abs((ring.inner + ring.outer)[:, 0]) / 2
    crown = joints < 1e-9
    assert areas["bed"] + areas["head"] >= 4 * thickness * (length / 2 - joints[~crown]).sum() - 1e-6
    assert all(len(block.vertices) <= 10 for block in model.free_blocks)


@pytest.mark.parametrize("shape", SHAPES)
def test_pavilion_vault(shape):
    radius, thickness, courses, embrace = shape
    model = structures.pavilion_vault(
        JOINT, radius=radius, thickness=thickness, courses=courses, embrace=embrace, stone_length=0.7
    )
    area, moment, ring = section(*shape)
    assert volume(model) == pytest.approx(8 * moment)
    joints = np.abs((ring.inner + ring.outer)[:, 0]) / 2
    assert contact_areas(model)["bed"] == pytest.approx(4 * thickness * joints.sum())
    key = courses % 2
    keystone = sum(float(area_of(p)) for p in ring.voussoirs()[courses // 2 : courses // 2 + 1]) if key else 0
    assert contact_areas(model)["diagonal"] == pytest.approx(4 * np.sqrt(2) * (area - keystone / 2))
    assert len([block for block in model.blocks if block.name == "key"]) == key


@pytest.mark.parametrize("name", ["groin_vault", "pavilion_vault"])
def test_thicker_vaults_are_stronger(name):
    change = {"radius": 2.0, "courses": 7, "stone_length": 1.0} | (
        {"length": 5.2} if name == "groin_vault" else {}
    )
    load_factors = [
        lb.bounds(getattr(structures, name)(JOINT, thickness=t, **change)).lower for t in (0.3, 0.5)
    ]
    assert 0.0 < load_factors[0] < load_factors[1]


@pytest.mark.parametrize("running_bond", [True, False])
@pytest.mark.parametrize("oculus", [0.0, 0.5])
@pytest.mark.parametrize(("courses", "stones"), [(1, 4), (4, 8), (5, 13)])
@pytest.mark.parametrize(("radius", "embrace"), [(7.3, np.pi), (1.0, 2.0)])
def test_dome_contacts(running_bond, oculus, courses, stones, radius, embrace):
    """Meridian joints; a stone has two bed joints in running bond, else one; the key lies on all below it."""
    model = structures.dome(
        JOINT, radius=radius, thickness=radius / 10, courses=courses, stones=stones, embrace=embrace,
        oculus=oculus, running_bond=running_bond,
    )  # fmt: skip
    beds = 2 if running_bond else 1
    assert len(model.interfaces) == courses * stones * (1 + beds) + (0 if oculus else stones)
    assert len(model.free_blocks) == courses * stones + (0 if oculus else 1)
    for interface in model.interfaces:  # meridian planes and planes that touch a cone about the centre
        assert interface.axes[2] @ interface.centroid == pytest.approx(0.0, abs=1e-8 * radius)
    for course in range(1, courses + 1):  # turned by a stone, a course is the same
        mine = [b.volume for b in model.free_blocks if b.name.startswith(f"{course}.")]
        assert mine == pytest.approx([mine[0]] * stones)


@pytest.mark.parametrize("stones", [6, 10])
def test_dome_without_bond_is_a_pavilion_over_a_polygon(stones):
    """Its horizontal sections are regular polygons: n tan(pi / n) / pi times the body of revolution."""
    radius, thickness, courses = 2.0, 0.3, 4
    model = structures.dome(
        JOINT, radius=radius, thickness=thickness, courses=courses, stones=stones, running_bond=False
    )
    _, moment, _ = section(radius, thickness, 2 * courses + 1, np.pi)
    assert volume(model) == pytest.approx(2 * stones * np.tan(np.pi / stones) * moment)


def test_dome_of_many_stones_is_a_spherical_shell():
    radius, thickness = 2.0, 0.3
    shell = 2 / 3 * np.pi * ((radius + thickness / 2) ** 3 - (radius - thickness / 2) ** 3)
    errors = []
    for k in (1, 2):
        model = structures.dome(JOINT, radius=radius, thickness=thickness, courses=5 * k, stones=12 * k)
        errors.append(abs(volume(model) / shell - 1))
    assert errors[1] < 0.5 * errors[0] < 0.01


def test_bond_makes_a_dome_stronger_and_thickness_too():
    change = {"radius": 2.0, "courses": 3, "stones": 6}
    load_factors = [
        lb.bounds(structures.dome(JOINT, **change, thickness=t, running_bond=bond)).lower
        for t, bond in ((0.2, False), (0.2, True), (0.3, True))
    ]
    assert 0.0 < load_factors[0] < load_factors[1] < load_factors[2]


@pytest.mark.parametrize("angle", [0.1, 1.0])
def test_lunes(angle):
    """Pappus: the section's moment times the angle, here of planes: 2 tan(angle / 2)."""
    shape = (2.0, 0.3, 11, np.pi)
    model = structures.dome_lunes(JOINT, radius=2.0, thickness=0.3, voussoirs=11, angle=angle)
    _, moment, ring = section(*shape)
    spread = np.tan(angle / 2)
    key = ring.voussoirs()[5]
    # the key is as wide as its joints: what two triangles lack is as much again
    x_in, x_out, depth = key[1, 0], key[2, 0], key[2, 1] - key[1, 1]
    wedges = 2 * spread * depth * (x_in**2 + x_in * x_out + x_out**2) / 3
    assert volume(model) == pytest.approx(4 * spread * moment + wedges)
    assert len(model.interfaces) == 12
    load_factors = [
        lb.bounds(structures.dome_lunes(JOINT, radius=2.0, thickness=t, voussoirs=11, angle=angle)).lower
        for t in (0.2, 0.3)
    ]
    assert 0.0 < load_factors[0] < load_factors[1]


def test_hull_has_one_face_to_a_plane():
    corners = [(x, y, z) for x in (0, 1, 2) for y in (0, 1, 2) for z in (0, 0.5, 1)]
    cube = hull("box", corners + corners, 1e3)
    assert (len(cube.vertices), len(cube.faces)) == (8, 6)
    assert cube.volume == pytest.approx(4.0)


def test_cut_is_the_body_between_its_planes():
    normals = [*np.eye(3), *-np.eye(3), (1, 1, 1)]
    body = cut("cube without a corner", normals, [1, 1, 1, 0, 0, 0, 2], np.full(3, 0.4))
    assert body.volume == pytest.approx(1 - 1 / 6)
    assert len(body.faces) == 7
