"""Verification of a facade of two storeys by hand: a mechanism on a floor, one with a tie and a vault."""

import numpy as np
import pytest
from scipy.optimize import brentq

import limitblocks as lb
from limitblocks.loads import added_mass, force
from limitblocks.practice import (
    Floor,
    FloorMode,
    Spectrum,
    capacity_curve,
    elastic_period,
    reinforced,
    tie,
    verification,
)
from limitblocks.practice.inputs import remarks

G, FC, DAMPING = 9.81, 1.35, np.sqrt(10 / (5 + 8))
SITE = Spectrum(a_g=0.2 * G, S=1.3, F0=2.4, T_C=0.45)
LOWER, UPPER, FLOOR, ROOF = 18e3 * 0.6 * 3, 18e3 * 0.4 * 3, 12e3, 9e3  # N a metre
VAULT, EDGE = 2e3, 0.3  # N outwards at 2.7 m; X of the outer face, flush


def two_storeys(strength):
    """Storeys of 3 m, .6 m and .4 m thick; a vault pushes the lower one, a tie holds it at 2.9 m."""
    stones = [
        lb.Block.box("ground", (3, 1, 0.4), (0, 0, -0.2)),
        lb.Block.box("lower", (0.6, 1, 3), (0, 0, 1.5), 18e3),
        lb.Block.box("upper", (0.4, 1, 3), (0.1, 0, 4.5), 18e3),
    ]
    carried = [added_mass("lower", (-0.1, 0, 3), weight=FLOOR), added_mass("upper", (0.1, 0, 6), weight=ROOF)]
    model = lb.Model(
        stones,
        ["ground"],
        lb.find_interfaces(stones, lb.PointContact(0.7)),
        lb.self_weight(carried) + force("lower", (VAULT, 0, 0), at=(0, 0, 2.7)),
        lb.mass_proportional((1, 0, 0), carried),
    )
    return reinforced(
        model, tie("lower", (-0.3, 0, 2.9), "ground", (-8, 0, 2.9), area=1e-4, strength=strength / 1e-4)
    )


def curve_of(model):
    return capacity_curve(model, control=("upper", (EDGE, 0.5, 6.0)), steps=2)


def test_upper_storey_overturns_on_its_floor():
    """A tie of 12 kN holds the lower one; z = H / 2 of a building of two storeys, T_1 = .25 s, [C7.2.10]."""
    model = two_storeys(12e3)
    result = lb.nonassociated(model)
    alpha = (UPPER + ROOF) * 0.2 / (UPPER * 1.5 + ROOF * 3)
    P, x = np.array([UPPER, ROOF]), np.array([0.5, 1.0])
    e = (P @ x) ** 2 / (P.sum() * (P @ x**2))
    a0 = alpha * G / (e * FC)
    mode = FloorMode.first(0.25, 2, 0.5)
    assert (mode.participation, mode.shape) == (1.2, 0.5)
    peak = SITE.a_g * SITE.S * SITE.F0 * 1.2 * 0.5 * np.sqrt(1.01)
    found = verification(
        model, result, SITE, q=2.0, confidence=FC, floor=Floor((mode,)), curve=curve_of(model)
    )
    assert found.moving == ("upper",)
    hand = {
        "alpha0": alpha,
        "e*": e,
        "a0*": a0,
        "a_Z": peak,
        "a_d": peak / 2,
        "a_g,SLD": SITE.a_g * a0 / peak,
    }
    d0 = 3 * np.sin(np.arctan(alpha)) * (P @ x**2) / (P @ x)
    T = 1.68 * np.pi * np.sqrt(0.4 * d0 / (0.6 * a0))
    hand |= {"d0*": d0, "T_SLV": T, "zeta_E": 2 * a0 / peak}
    assert {symbol: found[symbol] for symbol in hand} == pytest.approx(hand, rel=1e-6)
    assert found.checks[0].ratio == pytest.approx(2 * a0 / peak, rel=1e-6)

    def displacement(T):  # [C8.7.1.12], beyond b T_1
        assert T > 1.1 * 0.25
        top = 1.1 * 0.05**-0.5 * DAMPING
        floor = top * peak / (1 + (top - 1) * (T / (1.1 * 0.25) - 1) ** 1.2)
        ground = SITE.a_g * SITE.S * SITE.F0 * DAMPING * SITE.T_C / T
        least = top * peak * (1.1 * 0.25 / (2 * np.pi)) ** 2
        return max(max(floor, ground) * (T / (2 * np.pi)) ** 2, least)

    wanted = max(displacement(T), displacement(found["T_SLV,c"]))
    assert found["S_De_SLV"] == pytest.approx(wanted, rel=1e-6)
    assert found["d*/S_De_SLV"] == pytest.approx(0.4 * d0 / wanted, rel=1e-6)
    (said,) = found.remarks
    assert said.startswith("there are ties")


def test_whole_facade_overturns_with_its_tie():
    """A tie of 2 kN yields: L_i of it and F_k of the vault in [C8.7.1.1]; its line turns with the wall."""
    strength = 2e3
    model = two_storeys(strength)
    result = lb.nonassociated(model)
    P = np.array([LOWER, UPPER, FLOOR, ROOF])
    arms, z = EDGE - np.array([0.0, 0.1, -0.1, 0.1]), np.array([1.5, 4.5, 3.0, 6.0])
    alpha = (P @ arms + strength * 2.9 - VAULT * 2.7) / (P @ z)
    e = (P @ z) ** 2 / (P.sum() * (P @ z**2))
    found = verification(model, result, SITE, q=2.0, confidence=FC, curve=curve_of(model))
    assert found["alpha0"] == pytest.approx(alpha, rel=1e-7)
    assert found["e*"] == pytest.approx(e, rel=1e-7)
    assert found["a0*"] == pytest.approx(alpha * G / (e * FC), rel=1e-7)
    assert found["sum P dy"] == pytest.approx(P @ arms / 6.0, rel=1e-7)

    def moment(angle):  # about the toe, of all that holds it back
        def at(arm, height):
            return np.cos(angle) * arm - np.sin(angle) * height, np.cos(angle) * height + np.sin(angle) * arm

        back, up = at(EDGE + 0.3, 2.9)
        line = np.array([8 + EDGE - back, 2.9 - up])  # inwards, up
        pull = strength * line / np.linalg.norm(line)
        return P @ at(arms, z)[0] + pull[0] * up - pull[1] * back - VAULT * at(EDGE, 2.7)[1]

    zero = brentq(moment, 0.0, 0.3, xtol=1e-14)
    d0 = 6 * np.sin(zero) * (P @ z**2) / (6 * (P @ z))
    assert found["d0*"] == pytest.approx(d0, rel=1e-6)


def test_mechanism_that_is_not_set_off_passes_at_slv(facade):
    """C8.7.1.2.1.8: a_g,SLV is no less than what sets it off; of SLC the text does not say so."""
    model, result, curve = facade
    site = Spectrum(a_g=0.1 * G, S=1.0, F0=2.5, T_C=1.5)
    found = verification(model, result, site, q=1.0, curve=curve, collapse_demand=site)
    assert found["a_g,SLV,d"] < found["a_g,SLD"] == pytest.approx(found["a0*"])
    assert found.checks[1].capacity == found["a_g,SLD"]
    assert found.checks[1].ratio == pytest.approx(found.checks[0].ratio)
    assert found.checks[2].capacity == found["a_g,SLC,d"]


@pytest.fixture(scope="module")
def facade():
    model = lb.structures.block(lb.PointContact(0.6), width=0.5, height=1.5)
    corner = (0.5, 0.5, 1.5)
    return model, lb.nonassociated(model), capacity_curve(model, control=("block 1", corner), steps=2)


def test_element_free_to_vibrate(facade):
    """[C8.7.1.6], [C8.7.1.9]: the spectrum at T_0; an elastic branch that is softer than the curve counts."""
    model, result, curve = facade
    for T_0, branch in ((0.12, SITE.T_B), (0.3, SITE.T_C)):
        found = verification(model, result, SITE, q=2.0, curve=curve, elastic_period=T_0, damage_demand=SITE)
        share = 1.0 if branch == SITE.T_C else T_0 / SITE.T_B + (1 - T_0 / SITE.T_B) / SITE.F0
        wanted = SITE.a_g * SITE.S * SITE.F0 * share
        assert found["S_e(T_0)"] == pytest.approx(wanted)
        assert [one.demand for one in found.checks[:2]] == pytest.approx([wanted / 2, wanted])
        assert found["zeta_E"] == pytest.approx(2 * found["a0*"] / wanted)
        assert found["a*_SLV"] == pytest.approx(0.6 * found["a0*"])
    soft = verification(model, result, SITE, q=2.0, curve=curve, elastic_period=4.0)
    assert soft["a*_SLV"] == pytest.approx(4 * np.pi**2 * soft["d*_SLV"] / 16)
    assert soft["T_SLV"] == soft["T_SLV,c"] == pytest.approx(0.84 * 4.0)
    flat = SITE.a_g * SITE.S * SITE.F0 * SITE.T_C * SITE.T_D / (2 * np.pi) ** 2 * DAMPING
    assert soft["S_De_SLV"] == pytest.approx(flat)


@pytest.mark.parametrize(
    ("cantilever", "root", "rounded"), [(True, 1.8751040687, 0.05), (False, np.pi, 0.05)]
)  # fmt: skip
def test_period_is_that_of_a_beam(cantilever, root, rounded):
    """[C8.7.1.7] after the beam of even mass: T = 2 pi / root^2 L^2 sqrt(12 W / (E g t^2)), in digits."""
    L, t, W, E = 3.0, 0.4, 18e3, 1.5e9
    kappa = 2 * np.pi / root**2 * np.sqrt(12)
    unit = L / t * L * np.sqrt(W / (E * G))
    assert elastic_period(L, t, W, E, cantilever=cantilever) == pytest.approx(
        kappa * unit, abs=rounded * unit
    )
    with pytest.raises(lb.ModelError, match=r"thickness is 0\.0, expected a finite number > 0 in m"):
        elastic_period(L, 0.0, W, E)


def test_mechanism_in_space_is_told(facade):
    """A turn about an edge is parallel to a plane; one that slides along the edge as well is not."""
    model, result, _ = facade
    rates = result.displacement_rates.copy()
    assert remarks(model, rates, FC) == ()
    rates[-1, :3] += rates[-1, 3:] / np.linalg.norm(rates[-1, 3:]) * 0.1 * np.linalg.norm(rates[-1, :3])
    (said,) = remarks(model, rates, FC)
    assert said.startswith("the mechanism is not parallel to one plane")


@pytest.mark.parametrize(
    ("values", "words"),
    [((0.3, 0, 0.5), "storeys is 0"), ((0.3, 2, 1.5), "height z / H is 1.5, expected 0 to 1")],
)  # fmt: skip
def test_wrong_first_mode(values, words):
    with pytest.raises(lb.ModelError, match=words):
        FloorMode.first(*values)
