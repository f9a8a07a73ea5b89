"""Planar limit problems: their mirror plane, their reduction to it, and states lifted back."""

from limitblocks.problem.plane.reduction import Planar, planar

__all__ = ["Planar", "planar"]
