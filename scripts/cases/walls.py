"""Masonry walls: Ferris & Tin-Loi, and running bond pushed in plane."""

from functools import partial
from itertools import product

import limitblocks as lb
from cases.case import ANALYSES, FLOWS, JOINTS, Case, associated, nonassociated
from limitblocks import structures

FERRIS_TIN_LOI = "Ferris & Tin-Loi (2001)"
WALLS = {1: (0.64286, 0.640), 2: (0.58000, 0.563), 3: (0.40369, 0.356), 4: (0.33195, 0.264)}


def wall_of(number, joint, **options):
    return structures.ferris_tin_loi_wall(number, joint, **options)


def ferris_tin_loi():
    group = "Walls of Ferris & Tin-Loi"
    for (number, values), (name, kind) in product(WALLS.items(), JOINTS.items()):
        for flow, analyse in ANALYSES.items():
            exact = flow == "associated"
            yield Case(group, f"wall {number}, {name}", flow, FERRIS_TIN_LOI, values[not exact],
                       1e-5 if exact else 0.01 * values[1],
                       partial(analyse, partial(wall_of, number), kind(0.65)), quick=exact)  # fmt: skip
    for number, (name, kind), flow in product((1, 2), JOINTS.items(), FLOWS):
        height = {1: 6, 2: 10}[number] * 0.175
        build = partial(wall_of, number, thickness=0.2, direction=(0, 1, 0))
        yield Case(group, f"wall {number} pushed out of plane, {name}", flow, "thickness / height",
                   0.2 / height, 1e-5, partial(ANALYSES[flow], build, kind(0.65)))  # fmt: skip
    for thickness in (0.1, 1.0):
        build = partial(wall_of, 3, thickness=thickness)
        yield Case(group, f"wall 3, {thickness:g} m thick, OrdunaLourenco", "associated", FERRIS_TIN_LOI,
                   WALLS[3][0], 1e-5, partial(associated, build, lb.OrdunaLourenco(0.65)))  # fmt: skip


def running_bond(ratio, joint):
    """12 courses, as long as high; blocks of height / length `ratio`."""
    return structures.wall(joint, length=2.4, courses=12, block_length=0.2 / ratio, block_height=0.2)


def running_bond_walls():
    group, source = "Running-bond walls", "Argiento, Maione & Casapulla (2018)"
    for (text, ratio, value), (name, kind) in product(
        (("1/3", 1 / 3, 0.68), ("1", 1.0, 0.26)), JOINTS.items()
    ):
        yield Case(group, f"12 courses, H/L = 1, block h/b = {text}, friction 0.7 (inferred), {name}",
                   "non-associated", source, value, 0.03 * value,
                   partial(nonassociated, partial(running_bond, ratio), kind(0.7)))  # fmt: skip
