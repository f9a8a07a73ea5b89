"""Masonry walls: Ferris & Tin-Loi, and running bond pushed in plane."""

from functools import partial
from itertools import product

import limitblocks as lb
from cases.case import ANALYSES, FLOWS, JOINTS, Case, associated, nonassociated, of_print
from limitblocks import structures
from limitblocks.structures.cases import ARGIENTO, FERRIS_TIN_LOI, FERRIS_TIN_LOI_NONASSOCIATED


def wall_of(number, joint, **options):
    return structures.ferris_tin_loi_wall(number, joint, **options)


def ferris_tin_loi():
    group = "Walls of Ferris & Tin-Loi"
    for number, (name, kind) in product(FERRIS_TIN_LOI, JOINTS.items()):
        for flow, analyse in ANALYSES.items():
            exact = flow == "associated"
            values = FERRIS_TIN_LOI if exact else FERRIS_TIN_LOI_NONASSOCIATED
            run = partial(analyse, partial(wall_of, number), kind(0.65))
            yield of_print(group, f"wall {number}, {name}", flow, values[number], run, quick=exact)
    for number, (name, kind), flow in product((1, 2), JOINTS.items(), FLOWS):
        height = {1: 6, 2: 10}[number] * 0.175
        build = partial(wall_of, number, thickness=0.2, direction=(0, 1, 0))
        yield Case(group, f"wall {number} pushed out of plane, {name}", flow, "thickness / height",
                   0.2 / height, 1e-5, partial(ANALYSES[flow], build, kind(0.65)))  # fmt: skip
    for thickness in (0.1, 1.0):
        build = partial(wall_of, 3, thickness=thickness)
        run = partial(associated, build, lb.OrdunaLourenco(0.65))
        name = f"wall 3, {thickness:g} m thick, OrdunaLourenco"
        yield of_print(group, name, "associated", FERRIS_TIN_LOI[3], run)


def running_bond(ratio, joint):
    """12 courses, as long as high; blocks of height / length `ratio`."""
    return structures.wall(joint, length=2.4, courses=12, block_length=0.2 / ratio, block_height=0.2)


def running_bond_walls():
    for (text, ratio), (name, kind) in product((("1/3", 1 / 3), ("1", 1.0)), JOINTS.items()):
        structure = f"12 courses, H/L = 1, block h/b = {text}, friction 0.7 (inferred), {name}"
        run = partial(nonassociated, partial(running_bond, ratio), kind(0.7))
        yield of_print("Running-bond walls", structure, "non-associated", ARGIENTO[text], run)
