"""Verification of a facade of one block by closed forms; spectra; misuse."""

import facades
import numpy as np
import pytest
from facades import ARM, FC, FLOOR, WEIGHT, G, H, T

import limitblocks as lb
from limitblocks.practice import Floor, FloorMode, Spectrum, capacity_curve, verification

SITE = Spectrum(a_g=0.25 * G, S=1.2, F0=2.5, T_C=0.5)


@pytest.fixture(scope="module")
def facade():
    return facades.facade()


@pytest.fixture(scope="module")
def answer(facade):
    return lb.nonassociated(facade)


@pytest.fixture(scope="module")
def curve(facade):
    wall = facade.free_blocks[0].vertices
    corner = wall[(wall[:, 0] > 0) & (wall[:, 2] > 1)][0]  # above the toe
    return capacity_curve(facade, control=("wall", corner), steps=3)


def test_facade_of_one_block(facade, answer, curve):
    """e*, a0*, d0*, T_SLV and the ratio at .25 g, S 1.2, q 2, each from its formula."""
    found = verification(facade, answer, SITE, q=2.0, curve=curve, confidence=FC, collapse_demand=SITE)
    own = WEIGHT * T * H
    P, delta = np.array([own, FLOOR]), np.array([H / 2, H])  # per unit rotation
    alpha = (own * T / 2 + FLOOR * ARM) / (P @ delta)
    e = (P @ delta) ** 2 / (P @ delta**2) / P.sum()
    a0 = alpha * G / (e * FC)
    d0 = H * np.sin(np.arctan(alpha)) * (P @ delta**2) / (H * P @ delta)
    period = 1.68 * np.pi * np.sqrt(0.4 * d0 / (0.6 * a0))
    expected = {"alpha0": 0.0907692, "e*": 0.9037433, "a0*": 0.7298419, "d0*": 0.2955306, "T_SLV": 2.742208}
    formulas = {"alpha0": alpha, "e*": e, "a0*": a0, "d0*": d0, "T_SLV": period}
    for symbol, value in expected.items():
        assert formulas[symbol] == pytest.approx(value, abs=6e-7)
        assert found[symbol] == pytest.approx(formulas[symbol], rel=1e-7)
    assert found["M*"] == pytest.approx(e * P.sum() / G, rel=1e-7)
    assert found.checks[0].ratio == pytest.approx(0.495985, abs=6e-7)
    assert not found.checks[0].satisfied
    assert found.moving == ("wall",)
    given = {
        "a_g": 0.25 * G,
        "S": 1.2,
        "F0": 2.5,
        "T_C": 0.5,
        "T_D": 2.6,
        "q": 2.0,
        "FC": FC,
        "a_g_SLC": 0.25 * G,
    }
    assert {symbol: found[symbol] for symbol in given} == pytest.approx(given)
    assert len({one.symbol for one in found.quantities}) == len(found.quantities)
    wanted = SITE.a_g * SITE.S * SITE.F0 * SITE.T_C * SITE.T_D / (2 * np.pi) ** 2  # beyond T_D
    assert found["S_De_SLV"] == pytest.approx(wanted, rel=1e-9)
    assert found.checks[1].ratio == pytest.approx(0.4 * d0 / wanted, rel=1e-7)
    assert found["T_SLC"] == pytest.approx(1.56 * np.pi * np.sqrt(0.6 * d0 / (0.4 * a0)), rel=1e-7)
    assert [one.name for one in found.checks] == ["linear, SLV", "non-linear, SLV", "non-linear, SLC"]


def test_scale_of_the_mechanism_does_not_matter(facade, answer):
    """Bounds and the answer without dilatancy have one mechanism here, in one scale or another."""
    found = verification(facade, answer, SITE, q=2.0, confidence=1.0)
    assert found["a0*"] == pytest.approx(answer.load_factor * G / found["e*"], rel=1e-12)
    assert 0.0 < found["e*"] <= 1.0


def test_spectrum_is_continuous_and_has_its_branches():
    for period in (SITE.T_B, SITE.T_C, SITE.T_D):
        assert SITE.acceleration(period - 1e-9) == pytest.approx(SITE.acceleration(period + 1e-9), rel=1e-6)
    assert SITE.acceleration(0.0) == pytest.approx(SITE.a_g * SITE.S)
    assert SITE.acceleration(0.3) == pytest.approx(SITE.a_g * SITE.S * SITE.F0)
    assert SITE.acceleration(1.0) == pytest.approx(SITE.a_g * SITE.S * SITE.F0 * SITE.T_C)
    assert SITE.displacement(6.0) == pytest.approx(SITE.displacement(8.0))
    assert pytest.approx(2.6) == SITE.T_D


def test_floor_spectrum():
    """At T = 0 the largest acceleration of the floor, flat about the period, continuous, not below ground."""
    mode = FloorMode(period=0.4, participation=1.3, shape=0.8)
    floor = Floor((mode,))
    largest = SITE.acceleration(0.4) * 1.3 * 0.8 * np.sqrt(1.01)
    assert floor.largest(SITE) == pytest.approx(largest)
    assert floor.acceleration(SITE, 0.0) == pytest.approx(largest)
    assert floor.acceleration(SITE, 0.35) == pytest.approx(1.1 * 0.05**-0.5 * largest)
    for period in (0.8 * 0.4, 1.1 * 0.4):
        assert floor.acceleration(SITE, period - 1e-9) == pytest.approx(
            floor.acceleration(SITE, period + 1e-9), rel=1e-5
        )
    for period in np.linspace(0.0, 4.0, 50):
        assert floor.acceleration(SITE, period) >= SITE.acceleration(period)
    still = Floor((FloorMode(period=0.4, participation=1.3, shape=0.0),))
    assert still.acceleration(SITE, 0.7) == pytest.approx(SITE.acceleration(0.7))


def test_mechanism_on_a_floor(facade, answer):
    floor = Floor((FloorMode(0.4, 1.3, 0.8),))
    found = verification(facade, answer, SITE, q=2.0, floor=floor)
    assert found.checks[0].demand == pytest.approx(floor.largest(SITE) / 2.0)
    given = {"T_1": 0.4, "gamma_1": 1.3, "psi_1(Z)": 0.8, "xi_1": 0.05, "a_Z": floor.largest(SITE)}
    assert {symbol: found[symbol] for symbol in given} == pytest.approx(given)


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"q": 0.5}, "q is 0.5, expected a finite number >= 1"),
        ({"q": 2.0, "confidence": 0.9}, "FC is 0.9, expected a finite number >= 1"),
    ],
)
def test_misuse(facade, answer, settings, words):
    with pytest.raises(lb.ModelError, match=words):
        verification(facade, answer, SITE, **settings)


def test_spectrum_without_q(facade, answer):
    with pytest.raises(TypeError, match="q"):
        verification(facade, answer, SITE)


def test_loads_that_are_no_weights(facade, answer):
    tilted = lb.Model(
        facade.blocks, facade.supports, facade.interfaces, facade.dead, lb.mass_proportional((1, 0, 1))
    )
    with pytest.raises(lb.ModelError, match="expected one horizontal direction"):
        verification(tilted, lb.nonassociated(tilted), SITE, q=2.0)


@pytest.mark.parametrize(
    ("values", "words"),
    [((-1.0, 1.2, 2.5, 0.5), "a_g is -1.0"), ((2.0, 1.2, 1.0, 0.5), "F0 is 1.0, expected a .* >= 2.2")],
)  # fmt: skip
def test_wrong_spectrum(values, words):
    with pytest.raises(lb.ModelError, match=words):
        Spectrum(*values)
