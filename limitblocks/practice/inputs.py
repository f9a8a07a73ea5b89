"""What a verification is given, as quantities: the spectrum of the ground and the modes of the building."""

from __future__ import annotations

from limitblocks.practice.spectra import Floor, Spectrum
from limitblocks.practice.verification_result import Quantity

GIVEN = "given"
CODE, FLOORS = "NTC 2018, 3.2.3.2.1", "Circolare 7/2019, C7.2.3"


def given(spectrum: Spectrum, state: str = "SLV") -> list[Quantity]:
    """Return the parameters of a spectrum; symbols of another limit state than SLV end in its name."""
    end = "" if state == "SLV" else f"_{state}"
    return [
        Quantity(f"a_g{end}", f"ground acceleration on rock, {state}", GIVEN, spectrum.a_g, "m/s2", CODE),
        Quantity(f"S{end}", f"soil and topography, {state}", GIVEN, spectrum.S, "", CODE),
        Quantity(f"F0{end}", f"largest amplification, {state}", GIVEN, spectrum.F0, "", CODE),
        Quantity(f"T_C{end}", f"start of constant velocity, {state}", GIVEN, spectrum.T_C, "s", CODE),
        Quantity(
            f"T_D{end}",
            f"start of constant displacement, {state}",
            "4 a_g / g + 1.6",
            spectrum.T_D,
            "s",
            CODE,
        ),
    ]


def carried(floor: Floor, largest: float) -> list[Quantity]:
    """Return the modes that carry the mechanism, and the largest acceleration of its floor, m/s2."""
    found: list[Quantity] = []
    for k, mode in enumerate(floor.modes, start=1):
        found += [
            Quantity(f"T_{k}", f"period of mode {k}", GIVEN, mode.period, "s", FLOORS),
            Quantity(f"gamma_{k}", f"participation of mode {k}", GIVEN, mode.participation, "", FLOORS),
            Quantity(f"psi_{k}(Z)", f"shape of mode {k} at the height Z", GIVEN, mode.shape, "", FLOORS),
            Quantity(f"xi_{k}", f"damping of mode {k}", GIVEN, mode.damping, "", FLOORS),
        ]
    words = "root of the sum of a_Zk^2, at least a_g S"
    return [*found, Quantity("a_Z", "largest acceleration at the height Z", words, largest, "m/s2", FLOORS)]
