"""What practice asks: ties and reinforcement, settlement, verification."""

from limitblocks.practice.reinforcement import Element, dowel, reinforced, strip, tie

__all__ = ["Element", "dowel", "reinforced", "strip", "tie"]
