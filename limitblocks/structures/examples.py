"""One small example of every structure, shared by documentation, pictures and tests."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from types import MappingProxyType

import numpy as np

from limitblocks.joints import Joint
from limitblocks.model import Model
from limitblocks.structures.arches import arch, elliptical_arch, pointed_arch, segmental_arch
from limitblocks.structures.bridges import arch_bridge
from limitblocks.structures.corners import buttressed_wall, corner, facade, tower
from limitblocks.structures.cross_vaults import groin_vault, pavilion_vault
from limitblocks.structures.domes import dome, dome_lunes
from limitblocks.structures.ferris_tin_loi import ferris_tin_loi_wall
from limitblocks.structures.fills import Fill
from limitblocks.structures.lintels import eccentric_lintel, portal
from limitblocks.structures.piers import Piers
from limitblocks.structures.stacks import block, column, overhang
from limitblocks.structures.stairs import cantilever_stair, stair
from limitblocks.structures.vaults import barrel_vault
from limitblocks.structures.walls import two_leaf_wall, wall
from limitblocks.structures.wedges import wedge

#: Function name, or that and what is special about the call, to the call. All stand under their dead loads
#: with friction 0.7 or more.
EXAMPLES: Mapping[str, Callable[[Joint], Model]] = MappingProxyType(
    {
        "block": partial(block, width=0.5, height=1.0),
        "column": partial(column, count=4, width=0.5, height=0.4),
        "overhang": partial(overhang, count=5, length=1.0, height=0.2, fraction=0.9),
        "wall": partial(wall, length=3.2, courses=8, openings=[(0.4, 0.0, 0.8, 1.0), (1.8, 0.6, 0.6, 0.4)]),
        "two_leaf_wall": partial(two_leaf_wall, length=1.6, courses=6, header_spacing=0.8),
        "two_leaf_wall, no headers": partial(two_leaf_wall, length=1.6, courses=6),
        "ferris_tin_loi_wall": partial(ferris_tin_loi_wall, 3),
        "corner": partial(corner, length=2.4, return_length=2.4, courses=5),
        "facade": partial(facade, length=4.0, courses=7, return_length=1.6, openings=[(1.6, 0.0, 0.8, 1.6)]),
        "tower": partial(tower, length=2.4, width=2.4, courses=8, openings={"front": [(0.8, 0.0, 0.8, 1.6)]}),
        "buttressed_wall": partial(
            buttressed_wall, length=3.6, courses=6, buttress_length=0.8, buttress_courses=4
        ),
        "portal": partial(portal, span=1.6, pier_width=0.6, pier_blocks=4),
        "eccentric_lintel": partial(eccentric_lintel, eccentricity=0.1),
        "arch": partial(arch, radius=2.0, thickness=0.4, voussoirs=13),
        "arch, vertical joints": partial(
            arch,
            radius=2.0,
            thickness=0.3,
            voussoirs=9,
            embrace=np.pi / 3,
            stereotomy="vertical",
            piers=Piers(width=1.0, blocks=2),
        ),
        "arch, facets": partial(arch, radius=2.0, thickness=0.5, voussoirs=7, facets=4),
        "arch, fill": partial(
            arch,
            radius=2.0,
            thickness=0.4,
            voussoirs=13,
            piers=Piers(width=1.0, blocks=2),
            fill=Fill(height=0.3),
        ),
        "arch, piers": partial(
            arch, radius=2.0, thickness=0.4, voussoirs=13, piers=Piers(width=0.9, blocks=3)
        ),
        "arch_bridge": partial(
            arch_bridge, span=3.0, rise=0.8, thickness=0.4, voussoirs=9, spans=2, pier_width=0.9, rings=2
        ),
        "segmental_arch": partial(
            segmental_arch, span=4.0, rise=0.8, thickness=0.3, voussoirs=11, piers=Piers(width=1.2, blocks=2)
        ),
        "pointed_arch": partial(pointed_arch, span=3.0, rise=2.5, thickness=0.4, voussoirs=14),
        "elliptical_arch": partial(elliptical_arch, span=4.0, rise=1.5, thickness=0.4, voussoirs=13),
        "barrel_vault": partial(barrel_vault, radius=1.5, thickness=0.4, length=1.8, courses=9, stones=3),
        "groin_vault": partial(
            groin_vault, radius=2.0, thickness=0.4, length=5.2, courses=9, stone_length=0.8, embrace=2.4
        ),
        "pavilion_vault": partial(pavilion_vault, radius=2.0, thickness=0.4, courses=9, stone_length=0.8),
        "dome": partial(dome, radius=2.0, thickness=0.3, courses=5, stones=10),
        "dome, oculus": partial(
            dome, radius=2.0, thickness=0.3, courses=4, stones=10, embrace=2.4, oculus=0.6
        ),
        "dome_lunes": partial(dome_lunes, radius=2.0, thickness=0.2, voussoirs=15, angle=np.pi / 6),
        "stair": partial(stair, treads=7),
        "cantilever_stair": partial(cantilever_stair, treads=4),
        "wedge": partial(wedge, half_angle=np.pi / 4),
        "wedge, two unequal planes": partial(wedge, half_angle=np.pi / 4, plunge=np.pi / 9, tilt=np.pi / 12),
    }
)
