"""Parametric structures, each a model ready to analyse. Lengths in m, unit weights in N/m3."""

from limitblocks.structures.arches import arch
from limitblocks.structures.bond import Opening
from limitblocks.structures.ferris_tin_loi import ferris_tin_loi_wall
from limitblocks.structures.stacks import block, column, overhang
from limitblocks.structures.walls import facade, wall

__all__ = ["Opening", "arch", "block", "column", "facade", "ferris_tin_loi_wall", "overhang", "wall"]
