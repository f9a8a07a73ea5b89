"""Planar limit problems: their mirror plane, their reduction to it, and states lifted back."""

from limitblocks.problem.plane.mirror import Mirror, mirror_of
from limitblocks.problem.plane.reduction import Planar, reduced

__all__ = ["Mirror", "Planar", "mirror_of", "reduced"]
