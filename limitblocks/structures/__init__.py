"""Parametric structures, each a model ready to analyse. Lengths in m, unit weights in N/m3."""

from limitblocks.structures.arches import (
    Piers,
    arch,
    arch_on_piers,
    elliptical_arch,
    pointed_arch,
    segmental_arch,
)
from limitblocks.structures.bond import Opening
from limitblocks.structures.fills import Fill
from limitblocks.structures.ferris_tin_loi import ferris_tin_loi_wall
from limitblocks.structures.lintels import eccentric_lintel, portal
from limitblocks.structures.stacks import block, column, overhang
from limitblocks.structures.stairs import stair
from limitblocks.structures.vaults import barrel_vault
from limitblocks.structures.walls import corner, facade, wall

__all__ = [
    "Fill",
    "Opening",
    "Piers",
    "arch",
    "arch_on_piers",
    "barrel_vault",
    "block",
    "column",
    "corner",
    "eccentric_lintel",
    "facade",
    "elliptical_arch",
    "ferris_tin_loi_wall",
    "overhang",
    "pointed_arch",
    "portal",
    "segmental_arch",
    "stair",
    "wall",
]
