"""Closed forms from the statics of a few blocks: slopes, walls, wedges, ties, strengths, supports, stacks."""

import math
from functools import partial
from itertools import product

import numpy as np

import limitblocks as lb
from cases.case import ANALYSES, FLOWS, JOINTS, Case
from limitblocks.practice import reinforced, settlement, tie
from limitblocks.structures.convex import hull

GROUND = lb.Block.box("ground", (20, 20, 1), (0, 0, -0.5))
ALONG = lb.mass_proportional((1, 0, 0))
SIDEWAYS = lb.mass_proportional((0, 1, 0))
SLOPE, HALF_WEDGE = 0.3, math.radians(20)


def model_of(blocks, joint, live=ALONG):
    free = {block.name for block in blocks if block.unit_weight}
    found = [i for i in lb.find_interfaces(blocks, joint) if {i.block_i, i.block_j} & free]
    held = [block.name for block in blocks if block.name not in free]
    return lb.Model(blocks, held, found, lb.self_weight(), live)


def on_a_slope(joint):
    c, s = math.cos(SLOPE), math.sin(SLOPE)
    turn = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    blocks = GROUND, lb.Block.box("block", (1.5, 1.1, 0.4), (0, 0, 0.2), 20e3)
    return model_of([block.moved(turn, np.zeros(3)) for block in blocks], joint, SIDEWAYS)


def beside_a_wall(joint):
    wall = lb.Block.box("wall", (6, 1, 3), (0, 1.5, 1.5))
    return model_of([GROUND, wall, lb.Block.box("block", (2, 2, 0.5), (0, 0, 0.25), 20e3)], joint)


def hexagon(joint):
    angles = np.pi * (2 * np.arange(6) + 1) / 6
    corners = [(math.cos(a), math.sin(a), z) for a in angles for z in (0.0, 4.0)]
    push = (math.cos(0.2), math.sin(0.2), 0)
    return model_of([GROUND, hull("prism", corners, 20e3)], joint, lb.mass_proportional(push))


def wedge_between_two(joint):
    """A wedge pressed down between two blocks of 1 m that stand on the ground."""
    t = math.tan(HALF_WEDGE)
    left = [(-2, 0), (-0.2, 0), (-0.2 - t, 1), (-2, 1)]
    middle = [(-0.2 - 0.3 * t, 0.3), (0.2 + 0.3 * t, 0.3), (0.2 + t, 1), (-0.2 - t, 1)]
    shapes = {"left": left, "right": [(-x, z) for x, z in left], "wedge": middle}
    blocks = [hull(n, [(x, y, z) for x, z in p for y in (-0.5, 0.5)], 20.0) for n, p in shapes.items()]
    return model_of([GROUND, *blocks], joint, lb.loads.force("wedge", (0, 0, -1), at=(0, 0, 1)))


def wedge_force(mu):
    """N presses each side of the wedge: its horizontal part, less its friction, moves a block of weight W."""
    c, s, t = math.cos(HALF_WEDGE), math.sin(HALF_WEDGE), math.tan(HALF_WEDGE)
    block, wedge = 20.0 * (1.8 - t / 2), 20.0 * 0.7 * (0.4 + 1.3 * t)
    N = mu * block / ((c - mu * s) - mu * (s + mu * c))
    return 2 * N * (s + mu * c) - wedge


def tied(joint):
    """A block of 2 m x 2 m x 0.3 m that slides against a rod of 1 kN askew in plan."""
    block = lb.Block.box("block", (2, 2, 0.3), (0, 0, 0.15), 18e3)
    rod = tie("block", (0, 0, 0.15), "ground", (-4, 3, 0.15), area=1e-5, strength=100e6)
    return reinforced(model_of([GROUND, block], joint), rod)


def pier(joint, live_height):
    """A pier of 0.6 m x 0.8 m x 2 m that weighs 192 kN, its weight as a horizontal force at a height."""
    block = lb.Block.box("pier", (0.6, 0.8, 2.0), (0, 0, 1), 200e3)
    return model_of([GROUND, block], joint, lb.loads.force("pier", (192e3, 0, 0), at=(0, 0, live_height)))


def twisted(lever, joint):
    """A flat block of 1.4 m x 0.9 m, its weight as a force in its base, off its middle."""
    block = lb.Block.box("block", (1.4, 0.9, 0.1), (0, 0, 0.05), 20e3)
    return model_of([GROUND, block], joint, lb.loads.force("block", (block.weight, 0, 0), at=(0, lever, 0)))


def mean_radius(a, b):
    """Mean distance of the points of a rectangle a x b from its middle."""
    d = math.hypot(a, b)
    return d / 6 + a**2 / (12 * b) * math.asinh(b / a) + b**2 / (12 * a) * math.asinh(a / b)


def least_reaction(joint):
    """A beam of 6 m and 60 kN on three supports, that at its end settles."""
    spans = (("a", 0.2), ("b", 1.7), ("c", 5.8))
    held = [lb.Block.box(name, (0.4, 1, 1), (x, 0, -0.5)) for name, x in spans]
    beam = lb.Block.box("beam", (6, 1, 0.5), (3, 0, 0.25), 20e3)
    return settlement(model_of([*held, beam], joint), "c", (0, 0, -1)).nonassociated


def balanced_stack(overhang):
    """Four blocks of 1 m, one of them a counterbalance, that reach beyond a table."""
    f = math.sqrt(2) - 1  # force of the uppermost block on the one that reaches farthest
    reach, low = 1.875 - math.sqrt(0.5), (3.5 - math.sqrt(2)) / 4
    back = (2 - f) * (low - 1) + (1 - f) / 2
    places = {"low": (low - 0.5, 0), "far": (reach - 0.5, 1), "back": (back, 1),
              "top": (f * (reach - 1) - (1 - f) / 2, 2)}  # fmt: skip
    blocks = [lb.Block.box(n, (1, 1, 0.2), (x, 0, 0.1 + 0.2 * k), 20e3) for n, (x, k) in places.items()]
    table = lb.Block.box("table", (3, 1, 1), (reach - overhang - 1.5, 0, -0.5))
    return model_of([table, *blocks], lb.PointContact(0.5))


def step(joint):
    """Not convex: a riser of 3 m and a tread of 1 m; its weight pushes on top of the riser."""
    outline = [(0, 0), (3, 0), (3, 1), (1, 1), (1, 3), (0, 3)]
    blocks = [
        lb.Block.box("ground", (6, 2, 1), (1.5, 0, -0.5)),
        lb.Block.prism("step", outline, (-0.5, 0.5), 20e3),
    ]
    return model_of(blocks, joint, live=lb.loads.top_force((100e3, 0, 0), (0.5, 0)))


def statics():
    group, root = "Statics of a few blocks", math.sqrt
    mu, fc, cohesion, tension = 0.55, 1e6, 50e3, 20e3
    both = [  # structure, formula, value by flow, friction, model
        ("block pushed across a slope of 0.3 rad", "sqrt(mu^2 cos^2 - sin^2)",
         (root((mu * math.cos(SLOPE)) ** 2 - math.sin(SLOPE) ** 2),) * 2, mu, on_a_slope),
        ("block pushed along a wall beside it", "mu / sqrt(1 - mu^2); mu", (0.4 / root(1 - 0.16), 0.4), 0.4,
         beside_a_wall),
        ("hexagonal prism, pushed 0.2 rad off a side", "r / (z cos(0.2))",
         (root(0.75) / (2 * math.cos(0.2)),) * 2, 0.9, hexagon),
        ("wedge of 40 degrees between two blocks", "equilibrium of the three, all joints sliding",
         (wedge_force(0.25),) * 2, 0.25, wedge_between_two),
        ("step that is not convex, pushed on top of its riser", "W x / (W z)", (1.9 / 3,) * 2, 0.9, step),
        ("block that slides, rod askew in plan", "|alpha W + rod| = mu W",
         ((800 + root((0.6 * 21600) ** 2 - 600**2)) / 21600,) * 2, 0.6, tied),
    ]  # fmt: skip
    for (structure, formula, values, friction, build), (name, kind) in product(both, JOINTS.items()):
        for flow, value in zip(FLOWS, values, strict=True):
            yield Case(group, f"{structure}, {name}", flow, formula, value, 1e-5 * value,
                       partial(ANALYSES[flow], build, kind(friction)), quick=True)  # fmt: skip
    paper, ratio, strength = lb.OrdunaLourenco, 192e3 / (0.48 * fc), (192e3 + 0.48 * tension) / 192e3
    c = mean_radius(1.4, 0.9)
    one = [
        ("pier that crushes", "b/(2 z) (1 - N/(A fc))", 0.15 * (1 - ratio),
         paper(0.7, compressive_strength=fc), partial(pier, live_height=2.0)),
        ("pier that crushes, with tensile strength", "stress block from -fc to ft",
         0.15 * strength * (1 - strength * 192e3 / (0.48 * (fc + tension))),
         paper(0.7, compressive_strength=fc, tensile_strength=tension, cohesion=1e6),
         partial(pier, live_height=2.0)),
        ("pier that slides, with cohesion", "mu + c A / W", 0.3 + 0.48 * cohesion / 192e3,
         paper(0.3, cohesion=cohesion), partial(pier, live_height=0.05)),
        ("flat block pushed 0.3 m off its middle", "Eq. (27): 1.3 mu / (1 + e / c)",
         1.3 * 0.5 / (1 + 0.3 / c), paper(0.5), partial(twisted, 0.3)),
        ("flat block pushed 0.6 m off its middle", "Eq. (27): 1.3 mu / (1 + e / c)",
         1.3 * 0.5 / (1 + 0.6 / c), paper(0.5), partial(twisted, 0.6)),
    ]  # fmt: skip
    for (structure, formula, value, joint, build), flow in product(one, FLOWS):
        yield Case(group, f"{structure}, OrdunaLourenco", flow, formula, value, 1e-5 * value,
                   partial(ANALYSES[flow], build, joint), quick=True)  # fmt: skip
    for name, kind in JOINTS.items():
        yield Case(group, f"beam on three supports, that at an end settles, {name}", "least reaction, N",
                   "W (3 - 1.9) / (6 - 1.9)", 60e3 * 1.1 / 4.1, 0.02,
                   partial(least_reaction, kind(0.6)), quick=True)  # fmt: skip
    yield Case(group, "stack of 4 with a counterbalance", "largest overhang / L",
               "moments: (15 - 4 sqrt(2)) / 8 (Paterson & Zwick 2009)", (15 - 4 * root(2)) / 8, 1e-5,
               lambda: lb.studies.maximum(balanced_stack, 1.1, 1.2).value)  # fmt: skip
