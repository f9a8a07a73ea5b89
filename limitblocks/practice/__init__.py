"""What practice asks: ties, settlement, the capacity curve, verification against earthquakes."""

from limitblocks.practice.capacity import capacity_curve
from limitblocks.practice.capacity_result import CapacityCurve, CapacityPoint, Control
from limitblocks.practice.elements import Element, dowel, reinforced, strip, tie
from limitblocks.practice.settlement import Settlement, Settling, settlement, settling
from limitblocks.practice.spectra import Floor, FloorMode, Spectrum
from limitblocks.practice.verification import Inequality, Quantity, Verification, verification

__all__ = [
    "CapacityCurve",
    "CapacityPoint",
    "Control",
    "Element",
    "Floor",
    "FloorMode",
    "Inequality",
    "Quantity",
    "Settlement",
    "Settling",
    "Spectrum",
    "Verification",
    "capacity_curve",
    "dowel",
    "reinforced",
    "settlement",
    "settling",
    "strip",
    "tie",
    "verification",
]
