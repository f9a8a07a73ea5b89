"""What practice asks: ties and reinforcement, settlement."""

from limitblocks.practice.elements import Element, dowel, reinforced, strip, tie
from limitblocks.practice.settlement import Settlement, Settling, settlement, settling

__all__ = [
    "Element",
    "Settlement",
    "Settling",
    "dowel",
    "reinforced",
    "settlement",
    "settling",
    "strip",
    "tie",
]
