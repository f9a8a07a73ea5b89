"""Parametric structures, each a model ready to analyse. Lengths in m, unit weights in N/m3."""

from limitblocks.structures.arches import arch, elliptical_arch, pointed_arch, segmental_arch
from limitblocks.structures.bond import Opening
from limitblocks.structures.bridges import arch_bridge
from limitblocks.structures.corners import buttressed_wall, corner, facade, tower
from limitblocks.structures.cross_vaults import groin_vault, pavilion_vault
from limitblocks.structures.domes import dome, dome_lunes
from limitblocks.structures.examples import EXAMPLES
from limitblocks.structures.ferris_tin_loi import ferris_tin_loi_wall
from limitblocks.structures.fills import Fill
from limitblocks.structures.lintels import eccentric_lintel, portal
from limitblocks.structures.piers import Piers
from limitblocks.structures.stacks import block, column, overhang
from limitblocks.structures.stairs import cantilever_stair, stair
from limitblocks.structures.vaults import barrel_vault
from limitblocks.structures.walls import two_leaf_wall, wall
from limitblocks.structures.wedges import wedge

__all__ = [
    "EXAMPLES",
    "Fill",
    "Opening",
    "Piers",
    "arch",
    "arch_bridge",
    "barrel_vault",
    "block",
    "buttressed_wall",
    "cantilever_stair",
    "column",
    "corner",
    "dome",
    "dome_lunes",
    "eccentric_lintel",
    "elliptical_arch",
    "facade",
    "ferris_tin_loi_wall",
    "groin_vault",
    "overhang",
    "pavilion_vault",
    "pointed_arch",
    "portal",
    "segmental_arch",
    "stair",
    "tower",
    "two_leaf_wall",
    "wall",
    "wedge",
]


def __dir__() -> list[str]:
    return __all__
