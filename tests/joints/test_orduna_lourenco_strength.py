"""Crushing, cohesion and tension on the paper's yield surface, Eqs (39)-(42), Table 6."""

import re
from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from prisms import DOCS, prism, pushed
from rectangles import (
    AREA,
    C_T,
    COMPRESSION,
    L1,
    L2,
    MU,
    PAPER,
    RECTANGLE,
    SLIPS,
    N,
    finite_differences,
    states,
)
from scipy.optimize import brentq
from stones import SQUARE, shaft

import limitblocks as lb
from limitblocks.geometry import pieces
from limitblocks.geometry.rectangles import rectangles
from limitblocks.joints.interaction import effective_strength
from limitblocks.joints.torsion import plastic_centre, torsion_constant


def test_crushing_flow_is_table_6_by_finite_differences_and_by_duality():
    f = 2e4
    joint, interface = replace(PAPER, compressive_strength=f), lb.joints.interface(RECTANGLE, None)
    rows = joint.yield_rows(RECTANGLE[None])
    c = PAPER.yield_rows(RECTANGLE[None]).F[0, -4:] * -1

    def eq_39(Q):
        return c @ Q + Q[2] ** 2 / (AREA * f)

    for Q in states(10):
        flow = joint.flow_directions(interface, Q)[-4:]
        gradient = finite_differences(eq_39, Q)
        np.testing.assert_allclose(flow, gradient, atol=1e-6)
        np.testing.assert_allclose(flow[:, 2], 1 + 2 * Q[2] / (AREA * f), rtol=1e-12)
        np.testing.assert_allclose(joint.flow_directions(interface, Q, MU)[-4:], flow, rtol=1e-12)
    rng = np.random.default_rng(1)
    for _ in range(50):  # any y in K* dissipates g.y at least: no state of the set does more work
        z = rng.normal(size=2)
        y = np.array([np.linalg.norm(z), *z])
        dq = -rows.F[0, 34:37].T @ y
        Q = states(1, rng.integers(1 << 30))[0]
        if joint.utilisation(interface, Q) <= 1:
            assert dq @ Q <= rows.g[0, 34:37] @ y + 1e-9


def test_eq_39_becomes_eq_36_as_the_strength_grows():
    interface = lb.joints.interface(RECTANGLE, None)
    Q = states(1)[0] * [1, 1, 1, 0.1, 0.1, 0.1]
    infinite = PAPER.strength(interface, (0, 0, 0, 1, 0.4, 0), Q)
    gaps = np.array(
        [
            1 - lb.OrdunaLourenco(MU, f).strength(interface, (0, 0, 0, 1, 0.4, 0), Q) / infinite
            for f in (1e6, 1e7, 1e8, 1e12)
        ]
    )
    assert (gaps > -1e-12).all()
    np.testing.assert_allclose(gaps[:-2] / gaps[1:-1], 10, rtol=1e-3)
    assert abs(gaps[-1]) < 1e-8


@pytest.mark.parametrize(("b", "h", "share"), [(0.5, 1.0, 0.1), (0.3, 2.0, 0.4), (1.0, 1.5, 0.01)])
@pytest.mark.parametrize("friction", [2.0, 0.0])
def test_block_rocking_with_crushing(b, h, share, friction):
    """Alpha = (b/h) (1 - W / (A fcef)), through both bounds; without friction by a moment alone."""
    weight = 20e3 * h  # per area
    joint = lb.OrdunaLourenco(friction, compressive_strength=weight / share, slip="exact")
    model = lb.structures.block(joint, width=b, height=h, depth=0.7, unit_weight=20e3)
    factor = 1.0
    if friction == 0.0:
        stone = next(block for block in model.blocks if block.unit_weight)
        factor = stone.weight * h / 2
        model = lb.Model(
            model.blocks, model.supports, model.interfaces, model.dead, lb.loads.moment(stone.name, (0, 1, 0))
        )
    bounds = lb.bounds(model)
    expected = b / h * (1 - share) * factor
    assert bounds.lower == pytest.approx(expected, rel=1e-6)
    assert bounds.upper == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("share", [0.02, 0.1])
def test_crushing_towards_a_corner_of_a_triangle(share):
    """Eq. (39): e = (2/3) h (1 - n); the stress block, a triangle at the corner: (2/3) h (1 - sqrt(n))."""
    h, half = 0.9, 0.4
    joint = lb.OrdunaLourenco(MU, compressive_strength=1.0 / (share * half * h))
    interface = lb.joints.interface([(2 * h / 3, 0.0), (-h / 3, half), (-h / 3, -half)], joint)
    found = joint.strength(interface, (0, 0, 0, 0, 1, 0), (0, 0, -1.0, 0, 0, 0))
    block = 2 / 3 * h * (1 - np.sqrt(share))
    assert found / block == pytest.approx(1 + np.sqrt(share), rel=1e-6)
    assert f"{np.sqrt(share):.0%} at {share:.0%}".replace("%", " %") in DOCS


@pytest.mark.parametrize("share", [0.02, 0.1, 1 / 3])
def test_crushing_of_an_L_along_its_diagonal_is_that_of_two_rectangles(share):
    """Two triangles of stress at the far corners have 4/3 - (2/3) sqrt(3 n) along x + y.

    Rectangles 2 x 1 and 1 x 1, of which a and b are crushed, 2 a + b = 3 n, have N at x = 2 - a, 1 - b / 2,
    y = 1 - a / 2 and 2 - b / 2; on the diagonal 2 a (1 - a / 2) = b, so that a = 2 - sqrt(4 - 3 n).
    """
    height = 6.0
    joint = lb.OrdunaLourenco(2.0, compressive_strength=20e3 * height / share)
    blocks = prism([(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)], height)
    found = lb.bounds(pushed(blocks, joint, (np.sqrt(0.5), np.sqrt(0.5)))).lower
    lever = np.sqrt(2.0) * height / 2
    a = 2 - np.sqrt(4 - 3 * share)
    b = 3 * share - 2 * a
    along = 2 * (2 * a * (2 - a) + b * (1 - b / 2)) / (3 * share) - 5 / 3
    assert found == pytest.approx(along / lever, rel=1e-6)
    over = found * lever / (4 / 3 - 2 / 3 * np.sqrt(3 * share)) - 1
    assert f"{over:.0%} at {share if share < 0.3 else 0.33:.0%}".replace("%", " %") in DOCS


@pytest.mark.parametrize("share", [0.02, 0.1, 0.3])
def test_crushing_of_an_L_towards_a_leg_is_the_stress_block(share):
    """A strip d = 3 n / 2 of the leg x < 1, 2 m long, whose middle is at (d / 2, 1): pushed towards that."""
    height = 6.0
    joint = lb.OrdunaLourenco(2.0, compressive_strength=20e3 * height / share)
    blocks = prism([(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)], height)
    arm = np.array([0.75 * share, 1.0]) - 5 / 6
    found = lb.bounds(pushed(blocks, joint, arm / np.hypot(*arm)))
    assert [found.lower, found.upper] == pytest.approx([np.hypot(*arm) / (height / 2)] * 2, rel=1e-6)


@pytest.mark.parametrize(
    ("sides", "said"),
    [
        (4, "along a diagonal by 6 % at 2 % and 9 % at 10 %"),
        (8, "6 % at 2 % and 8 % at 10 %, a hollow octagon"),
    ],
)
def test_crushing_of_hollow_areas_beside_their_stress_block(sides, said):
    """Of regular outlines with a hole of .6 times their size, pushed to a corner: a square, an octagon."""
    angle = 2 * np.pi * (np.arange(sides) / sides)
    outline = np.column_stack([np.cos(angle), np.sin(angle)])
    blocks, whole = shaft(outline, 0.6, 6.0), shapely.Polygon(outline, [0.6 * outline])
    for share, over in zip((0.02, 0.1), re.findall(r"(\d+) % at", said), strict=True):

        def beyond(x):
            return whole & shapely.box(x, -2.0, 2.0, 2.0)

        x = brentq(lambda x, beyond=beyond, share=share: beyond(x).area / whole.area - share, -1.0, 1.0)
        joint = lb.OrdunaLourenco(2.0, compressive_strength=20e3 * 6.0 / share)
        found = lb.bounds(pushed(blocks, joint, (1.0, 0.0))).lower
        assert f"{found * 3.0 / beyond(x).centroid.x - 1:.0%}" == f"{over}%"
    assert said in DOCS


@pytest.mark.parametrize("turn", [0.0, 0.7])
@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("share", [0.02, 0.1, 0.6])
def test_crushing_of_a_hollow_shaft_along_a_side_is_the_stress_block(share, axis, turn):
    """Walls t of a square B: the block has a wall of B t, and beyond it 2 t (d - t)."""
    B, t, height = 2.0, 0.4, 6.0
    area = B**2 - (B - 2 * t) ** 2
    wall = min(share * area, B * t)
    deeper = (share * area - wall) / (2 * t)  # than the wall
    moment = wall * (B - wall / B) / 2 + 2 * t * deeper * (B / 2 - t - deeper / 2)
    joint = lb.OrdunaLourenco(2.0, compressive_strength=20e3 * height / share)
    rotation = np.array([(np.cos(turn), -np.sin(turn), 0), (np.sin(turn), np.cos(turn), 0), (0, 0, 1)])
    square = B / 2 * SQUARE
    model = pushed(
        [block.moved(rotation, (0, 0, 0)) for block in shaft(square, 1 - 2 * t / B, height)],
        joint,
        rotation[:2, axis],
    )
    expected = moment / (share * area) / (height / 2)
    found = lb.bounds(model)
    assert [found.lower, found.upper] == pytest.approx([expected] * 2, rel=1e-6)
    assert lb.nonassociated(model).load_factor == pytest.approx(expected, rel=1e-6)
    assert not any("stress block" in one for one in found.remarks)


@settings(max_examples=12, deadline=None)
@given(
    outline=st.sampled_from([
        [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)],
        [(0, 0), (3, 0), (3, 3), (2, 3), (2, 1), (1, 1), (1, 2), (0, 2)],
        None,
    ]),
    angle=st.floats(0.0, 6.3),
    friction=st.floats(0.1, 2.0),
)  # fmt: skip
def test_how_an_area_is_divided_does_not_matter_without_crushing(outline, angle, friction):
    """Points are in the hull of the corners, and with them what acts there; hinges are at its edges."""
    out = np.cos(angle), np.sin(angle)
    blocks = shaft(SQUARE, 0.6, 3.0) if outline is None else prism(outline, 3.0)
    found = []
    for divide in (rectangles, lambda *_: []):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(pieces, "rectangles", divide)
            points = pushed(blocks, lb.PointContact(friction), out)
            hinges = lb.Model(
                blocks,
                ["ground"],
                lb.find_interfaces(blocks, lb.OrdunaLourenco(0.0)),
                lb.self_weight(),
                lb.loads.moment(blocks[1].name, (-out[1] * 1e6, out[0] * 1e6, 0.0)),
            )
        found.append([number for model in (points, hinges) for number in _both(lb.bounds(model))])
    assert found[0] == pytest.approx(found[1], rel=2e-6)


def _both(bounds):
    return bounds.lower, bounds.upper


def test_torsion_of_a_T_beside_the_piece_that_carries_it_is_safe():
    """It tips over the edge from (3, 1) to (2, 3) at y = 1.1, where its centroid is: x = 2.95."""
    joint = lb.OrdunaLourenco(0.8)
    blocks = prism([(0, 0), (3, 0), (3, 1), (2, 1), (2, 3), (1, 3), (1, 1), (0, 1)], 6.0)
    tips = 1.45 / 3.0
    assert lb.bounds(pushed(blocks, lb.PointContact(0.8), (1.0, 0.0))).upper == pytest.approx(tips, rel=1e-6)
    assert round(1 - lb.bounds(pushed(blocks, joint, (1.0, 0.0))).upper / tips, 2) == 0.07
    assert "bar, by 7 %" in DOCS


@pytest.mark.parametrize("joint", [lb.OrdunaLourenco(MU), lb.joints.ExactTorsion(MU)])
def test_a_piece_pressed_at_its_corner_has_no_torsion(joint):
    """N = -W at (l1, l2): M1 = -W l2, M2 = W l1."""
    interface = lb.joints.interface(RECTANGLE, joint)
    assert joint.strength(interface, (0, 0, 0, 0, 0, 1), (0, 0, -1, -L2, L1, 0)) == pytest.approx(0, abs=1e-9)


def twisted(blocks, supports, joint, name):
    """The moment about the vertical through the centroid that it carries, over friction times its weight."""
    weight = MU * next(block.weight for block in blocks if block.name == name)
    live = lb.loads.moment(name, (0.0, 0.0, weight))
    return lb.Model(blocks, supports, lb.find_interfaces(blocks, joint), lb.self_weight(), live)


@pytest.mark.parametrize(("joint", "least"), [(lb.OrdunaLourenco, 0.3), (lb.joints.ExactTorsion, 0.0)])
def test_torsion_of_a_beam_on_three_pads_gathers_on_the_outer_two(joint, least):
    """Outer pads slide at a: a + 0.3 c_T by Eqs (27)-(29), a exactly; evenly shared it is (2 a + c_T) / 3."""
    side, a = 0.4, 2.0
    pads = [lb.Block.box(f"pad {x}", (side, side, 0.2), (x, 0.0, -0.1)) for x in (-a, 0.0, a)]
    beam = lb.Block.box("beam", (2 * a + side, side, 0.5), (0.0, 0.0, 0.25), 20e3)
    model = twisted([*pads, beam], [pad.name for pad in pads], joint(MU), "beam")
    c_T = side / 6 * (np.sqrt(2.0) + np.arcsinh(1.0))
    even = (2 * a + c_T) / 3
    associated = lb.bounds(model).lower
    assert associated == pytest.approx(a + least * c_T, rel=1e-6)
    if least:
        assert round(associated / even - 1, 2) == 0.48
        assert round(lb.nonassociated(model).load_factor / even - 1, 2) == 0.02
        assert "48 % stronger than under even pressure" in DOCS


@pytest.mark.parametrize(
    ("outline", "least", "most"),
    [
        ([(0, 0), (2, 0), (2, 0.5), (0.5, 0.5), (0.5, 2), (0, 2)], -0.05, 0.05),
        (
            [
                (-1, -1.5),
                (1, -1.5),
                (1, -1.2),
                (0.15, -1.2),
                (0.15, 1.2),
                (1, 1.2),
                (1, 1.5),
                (-1, 1.5),
                (-1, 1.2),
                (-0.15, 1.2),
                (-0.15, -1.2),
                (-1, -1.2),
            ],
            0.25,
            0.35,
        ),
        (
            [
                (-2, -0.05),
                (-0.5, -0.05),
                (-0.5, -0.5),
                (0.5, -0.5),
                (0.5, -0.05),
                (2, -0.05),
                (2, 0.05),
                (0.5, 0.05),
                (0.5, 0.5),
                (-0.5, 0.5),
                (-0.5, 0.05),
                (-2, 0.05),
            ],
            0.65,
            0.75,
        ),
    ],
)
def test_torsion_of_areas_in_pieces_beside_even_pressure(outline, least, most):
    """Under even pressure the strength is the least mean distance of the area from a point."""
    even = torsion_constant(np.array(outline), plastic_centre(np.array(outline)))
    for joint in (lb.joints.ExactTorsion(MU), lb.OrdunaLourenco(MU)):
        found = lb.bounds(twisted(prism(outline, 0.2), ["ground"], joint, "foot"))
        assert least < found.lower / even - 1 < most


def test_column_too_heavy_for_its_joint_falls():
    joint = lb.OrdunaLourenco(0.6, compressive_strength=0.99 * 20e3)
    with pytest.raises(lb.errors.NoEquilibrium):
        lb.bounds(lb.structures.block(joint, width=0.5, height=1.0, unit_weight=20e3))


def test_effective_strength_is_what_the_joint_takes():
    f = effective_strength(20e6)
    joint = lb.OrdunaLourenco(0.6, compressive_strength=f)
    assert joint.strength(lb.joints.interface(RECTANGLE, joint), (0, 0, -1, 0, 0, 0)) == pytest.approx(
        12e6 * AREA
    )


def test_cohesion_and_tension():
    c, ft, f = 3e3, 1e3, 2e4
    joint, interface = SLIPS["bonded"], lb.joints.interface(RECTANGLE, None)
    shear = joint.strength(interface, (0.6, 0.8, 0, 0, 0, 0), COMPRESSION)
    assert shear == pytest.approx(c * AREA - MU * N, rel=1e-12)
    torsion = joint.strength(interface, (0, 0, 0, 0, 0, 1), COMPRESSION)
    assert torsion == pytest.approx(C_T * (c * AREA - MU * N), rel=1e-12)
    assert joint.strength(interface, (0, 0, 1, 0, 0, 0)) == pytest.approx(ft * AREA, rel=1e-9)
    assert joint.strength(interface, (0, 0, -1, 0, 0, 0)) == pytest.approx(f * AREA, rel=1e-9)
    # the stress block: compression on the depth that balances N, tension on the rest
    depth = (ft * AREA - N) / (f + ft) / (2 * L1)
    moment = (f + ft) * 2 * L1 * depth * (L2 - depth / 2)
    assert joint.strength(interface, (0, 0, 0, 1, 0, 0), COMPRESSION) == pytest.approx(moment, rel=1e-12)
    dry = lb.OrdunaLourenco(MU, tensile_strength=ft)  # friction alone allows no tension
    assert dry.strength(interface, (0, 0, 1, 0, 0, 0)) == 0
    sticky = lb.OrdunaLourenco(0.0, cohesion=c)
    assert sticky.strength(interface, (1, 0, 0, 0, 0, 0), COMPRESSION) == pytest.approx(c * AREA, rel=1e-12)


@pytest.mark.parametrize(("c", "tension"), [(0.0, 1e6), (3e3, 1e6), (3e3, 1.01 * 3e3 / MU)])
def test_tension_ends_at_cohesion_over_friction_in_bending_too(c, tension):
    """Coulomb's law allows no tension beyond c / mu: a hinge forms at M1 = L2 (A c / mu - N)."""
    joint = lb.OrdunaLourenco(MU, cohesion=c, tensile_strength=tension)
    interface = lb.joints.interface(RECTANGLE, None)
    moment = joint.strength(interface, (0, 0, 0, 1, 0, 0), COMPRESSION)
    assert moment == pytest.approx(L2 * (AREA * c / MU - N), rel=1e-9)
    assert any(f"tensile strength {c / MU / 1e3:.4g} kPa counts" in line for line in joint.assumed())
    assert not any("tensile" in line for line in SLIPS["bonded"].assumed())
