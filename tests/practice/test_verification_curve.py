"""What a verification takes from the capacity curve."""

from dataclasses import replace

import facades
import numpy as np
import pytest
from facades import FC, SITE, G, H
from few_blocks import sliding_block

import limitblocks as lb
from limitblocks.practice import Spectrum, capacity_curve, verification
from limitblocks.practice.capacity_result import zero_of
from limitblocks.practice.displacement_check import _least_at


def test_acceleration_on_the_capacity_curve(facade, answer, curve):
    """[C8.7.1.3]: that of the displaced wall, beside the straight line."""
    found = verification(facade, answer, SITE, q=2.0, confidence=FC, curve=curve, damping=(0.05, 0.07))
    scale = G / (found["e*"] * FC)
    assert found["T_SLV,c"] == pytest.approx(1.68 * np.pi * np.sqrt(0.4 * found["d0*"] / found["a*_SLV,c"]))
    exact = np.tan(np.arctan(found["alpha0"]) - np.arcsin(0.4 * curve.zero / H)) * scale
    assert found["a*_SLV,c"] == pytest.approx(exact, rel=1e-4)
    assert found["a*_SLV"] == pytest.approx(0.6 * found["a0*"])
    assert found["xi_SLV"] == 0.05


@pytest.mark.parametrize("steps", [3, 8])
def test_between_the_points_of_a_curve_the_load_factor_is_on_the_safe_side(curve, steps):
    """On (1 - d)^1.2, which bends upwards, chords are above; on 1 - d^2 they are below."""
    d = np.linspace(0.0, 1.0, steps + 1)

    def of(factors):
        points = tuple(
            replace(curve.points[0], displacement=at, load_factor=a) for at, a in zip(d, factors, strict=True)
        )
        return replace(curve, points=points)

    for at in np.linspace(0.01, 0.99, 50):
        assert _least_at(of((1.0 - d) ** 1.2), at) <= (1.0 - at) ** 1.2 + 1e-12
        assert _least_at(of(1.0 - d**2), at) == pytest.approx(np.interp(at, d, 1.0 - d**2))


def test_between_the_points_of_a_curve_that_changes_its_bend_the_chord_counts(curve):
    """Slopes of -.4, -.2 and -.8: at .75 m the chord has .85, the one before drawn on .8, the one after 1."""
    way = ((0.0, 1.1), (0.5, 0.9), (1.0, 0.8), (1.5, 0.4))
    points = tuple(replace(curve.points[0], displacement=d, load_factor=a) for d, a in way)
    assert _least_at(replace(curve, points=points), 0.75) == pytest.approx(0.85)


def test_a_curve_that_snaps_back_counts_with_its_least_load_factor(curve):
    """Straight from 1 to .5 over .4 m, back to .8 at .2 m, to 0 at 1 m: at .3 m .625, .65 and .7."""
    way = ((0.0, 1.0), (0.4, 0.5), (0.2, 0.8), (1.0, 0.0))
    points = tuple(replace(curve.points[0], displacement=d, load_factor=a) for d, a in way)
    assert _least_at(replace(curve, points=points), 0.3) == pytest.approx(0.625)


def test_where_a_curve_snaps_through_zero_is_no_part_of_it(curve):
    """From 1 to .5 over 1 m, at .6 m .7; then it snaps to -.4 at .2 m, a line through .05 at .6 m."""
    way = ((0.0, 1.0), (1.0, 0.5), (0.2, -0.4))
    points = [replace(curve.points[0], displacement=d, load_factor=a) for d, a in way]
    snapped = (*points[:2], replace(points[2], snapped=True))
    assert _least_at(replace(curve, points=snapped), 0.6) == pytest.approx(0.7)
    assert zero_of(snapped) == 1.0
    assert _least_at(replace(curve, points=tuple(points)), 0.6) == pytest.approx(0.05)


def test_ground_acceleration_of_the_displacement_check(facade, answer, curve):
    """At the ground acceleration that is told, the demand is the displacement at the limit state."""
    found = verification(facade, answer, SITE, q=2.0, confidence=FC, curve=curve)
    again = Spectrum(found["a_g,SLV,d"], SITE.S, SITE.F0, SITE.T_C)
    there = verification(facade, answer, again, q=2.0, confidence=FC, curve=curve)
    assert there["S_De_SLV"] == pytest.approx(found["d*_SLV"], rel=1e-9)
    assert there.checks[1].ratio == pytest.approx(1.0)
    assert found["a_g,SLV,d"] < SITE.a_g
    assert not found.checks[1].satisfied


def test_a_zero_that_the_points_of_a_curve_do_not_have_is_refused(facade, answer, curve):
    """Where they are not zero, as a file may say, d0* would be wrong."""
    for zero in (3.0 * curve.zero, 1.01 * curve.zero, 0.999 * curve.zero, float("inf"), float("nan")):
        with pytest.raises(lb.ModelError, match="m; by its last points, at "):
            verification(facade, answer, SITE, q=2.0, curve=replace(curve, zero=zero))


def test_a_curve_of_another_model_is_refused(answer, curve):
    """The same facade on a joint of more friction."""
    other = facades.facade(lb.PointContact(0.7))
    with pytest.raises(lb.ModelError, match="this CapacityCurve belongs to model "):
        verification(other, lb.nonassociated(other), SITE, q=2.0, curve=curve)


def test_a_curve_whose_joints_press_across_their_gaps_is_said_to(facade, answer, curve):
    gap = "ground|wall presses across a gap of 1 mm"
    first, second, *rest = curve.points
    filled = replace(curve, points=(first, second, *(replace(one, across=(gap,)) for one in rest)))
    found = verification(facade, answer, SITE, q=2.0, curve=filled)
    said = f"beyond {second.displacement:.4g} m of the capacity curve joints press across their gaps"
    assert [said in one for one in found.remarks].count(True) == 1
    without = verification(facade, answer, SITE, q=2.0, curve=curve)
    assert not any("gaps" in one for one in without.remarks)
    once = replace(curve, points=(first, replace(second, across=(gap,)), *rest))
    assert once.proven_to == first.displacement


def test_a_curve_of_another_mechanism_is_refused():
    """With dilatancy a block that slides rises by its friction coefficient, without by none."""
    model = sliding_block()
    curve = capacity_curve(model, steps=3)
    with pytest.raises(lb.ModelError, match="or of another mechanism"):
        verification(model, lb.bounds(model), SITE, q=2.0, curve=curve)
    found = verification(model, lb.nonassociated(model), SITE, q=2.0, curve=curve)
    assert found["d0*"] == pytest.approx(curve.zero, rel=1e-6)  # one block: e* = 1


@pytest.mark.parametrize("factor", [0.998, 1.002])
def test_a_curve_of_another_answer_is_refused(facade, answer, curve, factor):
    first, *rest = curve.points
    other = replace(curve, points=(replace(first, load_factor=factor * first.load_factor), *rest))
    with pytest.raises(lb.ModelError, match="that of another answer"):
        verification(facade, answer, SITE, q=2.0, curve=other)


def test_a_curve_of_too_few_points_is_refused(facade, answer, curve):
    """From 1 to .1 over .2 of its zero, straight to it: the first chord drawn on is below zero at .4."""
    way = ((0.0, 1.0), (0.2, 0.1), (1.0, 0.0))
    points = tuple(
        replace(curve.points[0], displacement=d * curve.zero, load_factor=a * answer.load_factor)
        for d, a in way
    )
    with pytest.raises(lb.ModelError, match=r"too few points near 0\.4 of its zero"):
        verification(facade, answer, SITE, q=2.0, curve=replace(curve, points=points))


def test_a_ground_that_hardly_moves_is_told(facade, answer, curve):
    still = Spectrum(1e-9, SITE.S, SITE.F0, SITE.T_C)
    with pytest.raises(lb.ModelError, match=r"a_g is 1e-09 m/s2: 1e\+06 times as much"):
        verification(facade, answer, still, q=2.0, curve=curve)
