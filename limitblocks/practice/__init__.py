"""What practice asks: ties and reinforcement, settlement, the capacity curve."""

from limitblocks.practice.capacity import capacity_curve
from limitblocks.practice.capacity_result import CapacityCurve, CapacityPoint, Control
from limitblocks.practice.elements import Element, dowel, reinforced, strip, tie
from limitblocks.practice.settlement import Settlement, Settling, settlement, settling

__all__ = [
    "CapacityCurve",
    "CapacityPoint",
    "Control",
    "Element",
    "Settlement",
    "Settling",
    "capacity_curve",
    "dowel",
    "reinforced",
    "settlement",
    "settling",
    "strip",
    "tie",
]
