"""Symmetric limit problems: their mirror plane, their reduction by it, and states lifted back."""

from limitblocks.problem.plane.mirror import mirror_of
from limitblocks.problem.plane.planar import Planar
from limitblocks.problem.plane.reduction import reduced
from limitblocks.problem.plane.rows import Choice

__all__ = ["Choice", "Planar", "mirror_of", "reduced"]
