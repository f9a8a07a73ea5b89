"""Units against the figures of NIST Special Publication 811 (2008), Appendix B.8."""

import math

import pytest

from limitblocks import units


@pytest.mark.parametrize(
    ("unit", "printed"),
    [
        ("inch", 2.54e-2),
        ("ft", 3.048e-1),
        ("lb", 4.535924e-1),
        ("kgf", 9.80665),
        ("lbf", 4.448222),
        ("kip", 4.448222e3),
        ("psi", 6.894757e3),
        ("ksi", 6.894757e6),
        ("psf", 4.788026e1),
        ("t", 1e3),
        ("deg", 1.745329e-2),
    ],
)
def test_unit_is_the_printed_figure(unit, printed):
    assert getattr(units, unit) == pytest.approx(printed, rel=1e-6)


def test_products():
    assert 22 * units.kN_per_m3 == 22e3
    assert 3 * units.MPa == units.N / units.mm**2 * 3
    assert units.pcf * units.ft**3 == pytest.approx(units.lbf, rel=1e-15)
    assert units.kgf_per_m3 * units.m**3 == units.kg * units.gravity
    assert units.kPa == pytest.approx(units.kN / units.m**2)
    assert units.MPa == units.MN
    assert 180 * units.deg == math.pi
    assert 10 * units.mm == units.cm
    assert units.Pa == units.N_per_m3 == units.N


def test_a_public_name_is_a_number():
    assert {name for name in dir(units) if not name.startswith("_")} >= {"m", "deg"}
    assert all(isinstance(getattr(units, name), float) for name in dir(units) if not name.startswith("_"))
    assert not hasattr(units, "pi")
