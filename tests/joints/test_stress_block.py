"""Crushing beside the rectangular stress block, and areas in pieces."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from prisms import DOCS, prism, pushed
from rectangles import AREA, L1, L2, MU, PAPER, RECTANGLE
from scipy.optimize import brentq

import limitblocks as lb
from limitblocks.evidence import crushing
from limitblocks.joints.stress_block import over_stress_block
from limitblocks.reports.sections import section


@given(share=st.floats(0.0, 1.0), f=st.floats(1e3, 1e9), along=st.sampled_from([(1, 0), (0, 1), (0, -1)]))
def test_moment_strength_is_the_stress_block(share, f, along):
    """M = |N| l (1 - |N| / (A fcef)): zero at N = 0 and at N = -A fcef."""
    joint, interface = lb.OrdunaLourenco(MU, compressive_strength=f), lb.joints.interface(RECTANGLE, None)
    force = share * f * AREA
    moment = joint.strength(interface, (0, 0, 0, *along, 0), (0, 0, -force, 0, 0, 0))
    half = L2 if along[0] else L1
    assert moment == pytest.approx(force * half * (1 - share), abs=1e-9 * f * AREA * half)


@pytest.mark.parametrize(("share", "ratio"), [(0.02, 1.131), (0.1, 1.282), (0.5, 1.5)])
def test_along_a_diagonal_the_stress_block_is_a_triangle(share, ratio):
    """A corner of legs sqrt(2 share) of the sides carries N, its centroid a third of them inside."""
    joint, interface = lb.OrdunaLourenco(MU, compressive_strength=1e4), lb.joints.interface(RECTANGLE, None)
    force = share * 1e4 * AREA
    off = joint.strength(interface, (0, 0, 0, -force * L2, force * L1, 0), (0, 0, -force, 0, 0, 0))
    assert off / (1 - 2 * np.sqrt(2 * share) / 3) == pytest.approx(ratio, abs=1e-3)
    assert f"{ratio - 1:.0%}".removesuffix("%") + " %" in DOCS


@pytest.mark.parametrize(("share", "said"), [(0.1, "11 % at 10 %"), (0.5, "18 %, at half")])
def test_on_a_circle_the_stress_block_is_a_segment(share, said):
    """A segment of half angle t: area t - sin t cos t of the radius squared, first moment 2/3 sin^3 t."""
    t = brentq(lambda t: t - np.sin(t) * np.cos(t) - share * np.pi, 0, np.pi)
    exact = 2 / 3 * np.sin(t) ** 3 / (share * np.pi)  # eccentricity over the radius
    sides = 2 * np.pi * (np.arange(180) + 0.5) / 180
    polygon = np.column_stack([np.cos(sides), np.sin(sides)])
    joint = lb.OrdunaLourenco(MU, compressive_strength=1 / (share * np.pi))
    interface = lb.joints.interface(polygon, joint)
    found = joint.strength(interface, (0, 0, 0, 0, 1, 0), (0, 0, -1.0, 0, 0, 0))
    assert found / exact == pytest.approx((1 - share) / exact, rel=1e-3)  # the polygon is smaller
    assert f"{(1 - share) / exact - 1:.0%}".replace("%", " %") in said
    assert said in DOCS


def _over(polygon, strength, Q, tension=0.0, least=0.0):
    """Return how many times the moment of the stress block the moments of one joint are."""
    one = [np.array([each], dtype=float) for each in (polygon, strength, Q, tension)]
    return float(over_stress_block(*one, least)[0])


@pytest.mark.parametrize("share", [0.02, 0.1, 0.5, 0.9])
@pytest.mark.parametrize("shape", [[(0, 0), (1, 0), (3, 0.4)], [(0, 0), (2, 0), (1.3, 1), (0.7, 1)]])
def test_moments_of_crushing_beside_the_stress_block(shape, share):
    """Cut by bisection: the block's own moment is 1; at the corners Eq. (39) is at most 1 + sqrt(n)."""
    polygon = lb.joints.interface(shape, PAPER).polygon
    whole = shapely.Polygon(polygon)

    def over(e):
        return _over(polygon, 1.0 / (share * whole.area), [0, 0, -1, -e[1], e[0], 0])

    for angle in np.linspace(0.1, 6.3, 7):
        out = np.array([np.cos(angle), np.sin(angle)])
        across = 10.0 * np.array([-out[1], out[0]])

        def cut(depth, out=out, across=across):
            near, far = depth * out, (depth + 20.0) * out
            return whole & shapely.Polygon([near - across, near + across, far + across, far - across])

        depth = brentq(lambda depth, cut=cut: cut(depth).area / whole.area - share, -5.0, 5.0, xtol=1e-13)
        assert over(np.array(cut(depth).centroid.coords[0])) == pytest.approx(1.0, abs=1e-3)
        e = 1.02 * np.array(cut(depth).centroid.coords[0])  # what is certainly less is left out, no more
        assert _over(polygon, 1.0 / (share * whole.area), [0, 0, -1, -e[1], e[0], 0], least=1.01) > 1.0
        near = 0.9 * (1.0 - np.sqrt(share)) * e
        assert _over(polygon, 1.0 / (share * whole.area), [0, 0, -1, -near[1], near[0], 0], least=1.01) < 1.0
    most = max(over((1.0 - share) * corner) for corner in polygon)
    assert most <= (1.0 + np.sqrt(share)) * 1.001
    assert len(polygon) > 3 or most == pytest.approx(1.0 + np.sqrt(share), rel=1e-3)


def test_moments_beside_the_stress_block_of_both_strengths():
    """A rectangle about one axis: M = l (A ft - N) (1 - (A ft - N) / (A (fcef + ft)))."""
    for strength, tension in ((1000.0, 2.0), (200.0, 100.0)):
        force = 5.0 + tension * AREA
        moment = L2 * force * (1 - force / (AREA * (strength + tension)))
        found = _over(RECTANGLE, strength, [0, 0, -5.0, moment / 2, 0, 0], tension)
        assert found == pytest.approx(0.5, abs=5e-4)
    assert _over(RECTANGLE, 1000.0, [1.0, 0, -5.0, 0, 0, 1.0]) == 0.0
    assert _over(RECTANGLE, 5.0 / AREA, [0, 0, -5.0, 1.0, 0, 0]) == np.inf
    assert _over(RECTANGLE, 5.0 / AREA, [0, 0, -5.0, 1e-12, 0, 0]) == 0.0  # crushed all over: rounding


def test_tension_counts_in_what_is_said_of_crushing():
    """1 m2 about one axis, N' = A ft - N = 150 kN of A (fcef + ft) = 300: M = N' / 2 (1 - 1 / 2)."""
    joint = lb.OrdunaLourenco(0.6, compressive_strength=2e5, cohesion=1e5, tensile_strength=1e5)
    model = lb.structures.block(joint, width=1.0, height=1.0)
    moment = 150e3 / 2 / 2
    assert crushing.beyond_stress_block(model, np.array([[0, 0, -50e3, 0.0, moment, 0]])) == ()
    (said,) = crushing.beyond_stress_block(model, np.array([[0, 0, -50e3, 0.0, 1.5 * moment, 0]]))
    assert "carries 1.50 times the moment" in said


@pytest.mark.parametrize("joint", [lb.OrdunaLourenco, lb.joints.ExactTorsion])
def test_results_say_how_far_crushing_is_beyond_the_stress_block(joint, tmp_path):
    """Towards a corner of a triangle 1 + sqrt(n); about an axis of a rectangle nothing."""
    share, height, said = 0.25, 6.0, "times the moment of the exact stress block"
    own = joint(2.0, compressive_strength=20e3 * height / share)
    assert "sqrt(-N / (A fcef))" in " ".join(own.assumed())
    assert "sqrt(" not in " ".join(joint(2.0).assumed())
    corner = pushed(prism([(0, 0.4), (0, -0.4), (0.9, 0)], height), own, (1.0, 0.0))
    for analysis in (lb.bounds, lb.nonassociated):
        result = analysis(corner)
        assert " ".join(section(corner, result).warnings).count(f"ground|foot carries 1.50 {said}") == 1
        assert f"; crushing by Eq. (39): ground|foot carries 1.50 {said}; " in str(result)
        kept = lb.read_result(result.save(tmp_path / "result.json", overwrite=True))
        assert kept.remarks == lb.check_mcp(corner, kept).remarks == result.remarks
    flat = pushed(prism([(0, 0), (1, 0), (1, 0.7), (0, 0.7)], height), own, (1.0, 0.0))
    assert said not in " ".join([str(lb.bounds(flat)), *section(flat, lb.bounds(flat)).warnings])


@pytest.mark.parametrize("many", [1, 500])
def test_all_joints_beyond_the_stress_block_are_counted(many, monkeypatch):
    """N at (1 - n) times the corner of each triangle: 1 + sqrt(n); a square under its centre has nothing."""
    monkeypatch.setattr(crushing, "MANY", many)
    ground, _ = prism([(0, 0), (1, 0), (0, 1)], 1.0)
    outlines = [[(x, 0), (x + 1, 0), (x, 1)] for x in (0, 2, 4)] + [[(6, 0), (7, 0), (7, 1), (6, 1)]]
    feet = [replace(prism(outline, 1.0)[1], name=f"foot {k}") for k, outline in enumerate(outlines)]
    interfaces = lb.find_interfaces([ground, *feet], lb.OrdunaLourenco(0.6, compressive_strength=1e6))
    model = lb.Model(
        [ground, *feet], ["ground"], interfaces, lb.self_weight(), lb.mass_proportional((1, 0, 0))
    )
    Q = np.zeros((4, 6))
    for k, (own, share) in enumerate(zip(interfaces, (0.04, 0.09, 0.25, 0.25), strict=True)):
        force = share * shapely.Polygon(own.polygon).area * 1e6
        e = (1.0 - share) * own.polygon[0] * (len(own.polygon) == 3)
        Q[k] = force * np.array([0, 0, -1, -e[1], e[0], 0])
    (said,) = crushing.beyond_stress_block(model, Q)
    assert "ground|foot 2 carries 1.50 times" in said
    assert "the most of 3 joints with too large a moment" in said


def test_each_piece_of_an_area_is_asked_for_its_moment():
    """A dart is two triangles; with N at (1 - n) times a corner of either one it has 1 + sqrt(n) there."""
    share, strength = 0.09, 1e6
    stones = prism([(0, 0), (3, -2), (1, 0), (3, 2)], 1.0)
    found = lb.find_interfaces(stones, lb.OrdunaLourenco(0.6, compressive_strength=strength))
    assert [len(one.polygon) for one in found] == [3, 3]
    model = lb.Model(stones, ["ground"], found, lb.self_weight(), lb.mass_proportional((1, 0, 0)))
    for bent, own in enumerate(found):
        e = (1.0 - share) * own.polygon[0]
        Q = np.zeros((2, 6))
        Q[bent] = share * strength * 1.0 * np.array([0, 0, -1, -e[1], e[0], 0])  # a triangle of 1 m2
        (said,) = crushing.beyond_stress_block(model, Q)
        assert "(39): a piece of ground|foot carries 1.30 times" in said
