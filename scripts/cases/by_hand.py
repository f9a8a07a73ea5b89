"""What a hand calculation settles: a slope, a frame, walls with a prop, water or soil, two arches."""

import math
from dataclasses import replace
from functools import partial
from itertools import product

import numpy as np

import limitblocks as lb
from cases.case import ANALYSES, JOINTS, Case, of_print
from cases.statics import model_of
from limitblocks.loads import pressure
from limitblocks.practice import capacity_curve, settlement
from limitblocks.structures.cases import GOODMAN_BRAY
from limitblocks.structures.convex import hull

GROUND = lb.Block.box("ground", (20, 20, 1), (0, 0, -0.5))
OWN = 20e3  # unit weight, N/m3
LEAN = math.radians(4)


def column(count, width, height, unit_weight=OWN):
    sizes = (width, 1.0, height / count)
    return [
        lb.Block.box(f"course {k}", sizes, (0, 0, (k + 0.5) * sizes[2]), unit_weight) for k in range(count)
    ]


def prism(name, outline, unit_weight=OWN):
    return hull(name, [(x, y, z) for x, z in outline for y in (-0.5, 0.5)], unit_weight)


def toppling_slope(joint):
    """Goodman & Bray: 16 blocks 10 m wide on steps of 1 m, dip of the base 30 degrees, drawn level.

    Blocks touch where the source has their forces: at the upper edge of the face they share.
    """
    heights = [*range(4, 41, 4), *range(34, 3, -6)]
    blocks = [
        lb.Block.box(f"block {n}", (10, 1, y), (10 * n, 0, n + y / 2), 25e3) for n, y in enumerate(heights, 1)
    ]
    steps = [lb.Block.box(f"step {n}", (10, 1, 1), (10 * n, 0, n - 0.5)) for n in range(1, 17)]
    beds = [i for s, b in zip(steps, blocks, strict=True) for i in lb.find_interfaces([s, b], joint)]
    sides = [at_upper_edge(i) for i in lb.find_interfaces(blocks, joint)]
    weight = lb.mass_proportional((-math.sin(math.pi / 6), 0, -math.cos(math.pi / 6)))
    push = lb.loads.force("block 1", (-1e6, 0, 0), at=(10, 0, 1))
    return lb.Model([*steps, *blocks], [s.name for s in steps], [*beds, *sides], weight, push)


def least_friction(kind):
    return lb.studies.minimum(lambda friction: toppling_slope(kind(friction)), 0.7, 0.85).value


def at_upper_edge(interface, depth=1e-3):
    """The strip of that depth, m, along the upper edge of an upright contact."""
    corners = interface.corners
    top = corners[:, 2].max()
    corners[:, 2] = np.maximum(corners[:, 2], top - depth)
    centre = np.array([*interface.centroid[:2], top - depth / 2])
    return replace(interface, centroid=centre, polygon=(corners - centre) @ interface.axes[:2].T)


T, H, PROP, COURSES = 0.3, 3.0, 2.9, 12  # m: thickness and height of a wall, lower edge of its prop


def propped_wall(joint):
    """A wall that carries its own weight once more in its middle, held by a smooth prop at its top."""
    blocks = [
        GROUND,
        *column(COURSES, T, H),
        lb.Block.box("prop", (1, 1, H - PROP), (T / 2 + 0.5, 0, (H + PROP) / 2)),
    ]
    smooth = replace(joint, friction=0.0)
    found = lb.find_interfaces(blocks, lambda a, b: smooth if "prop" in (a.name, b.name) else joint)
    load = lb.loads.force(f"course {COURSES - 1}", (0, 0, -OWN * T * H), at=(0, 0, H))
    return lb.Model(
        blocks, ["ground", "prop"], found, lb.self_weight() + load, lb.mass_proportional((1, 0, 0))
    )


def bends_upwards():
    """Least value over the joints of the middle hinge: the lower part leans by 1, the upper one back by b."""

    def load_factor(hinge):
        low, up, b = hinge / H, 1 - hinge / H, hinge / (PROP - hinge)
        lifted = T / 2 * low + (T + b * T / 2) * (up + 1)
        return lifted / (low * hinge / 2 + up * (hinge - b * (H - hinge) / 2))

    return min(load_factor(H * k / COURSES) for k in range(1, COURSES - 1))


def dam(joint):
    """Five courses, 1 m x 2.5 m, under the pressure of a liquid of 5 kN/m3 up to their top."""
    wall = column(5, 1.0, 2.5)
    live = pressure([course.name for course in wall], facing=(-1, 0, 0), unit_weight=5e3, level=2.5)
    return model_of([GROUND, *wall], joint, live)


def leaning_tower(joint):
    c, s = math.cos(LEAN), math.sin(LEAN)
    turn = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    return model_of([block.moved(turn, np.zeros(3)) for block in (GROUND, *column(6, 2.4, 12.0))], joint)


WIDE, HIGH = 0.4, 2.0  # m: a column of a frame


def rocking_frame(joint):
    """Three columns under a loose beam that weighs five times as much as one of them."""
    columns = [
        lb.Block.box(f"column {k}", (WIDE, 1, HIGH), (2 * k, 0, HIGH / 2), OWN) for k in (-1.0, 0.0, 1.0)
    ]
    beam = lb.Block.box("beam", (5, 1, 0.5), (0, 0, HIGH + 0.25), 5 * WIDE * HIGH * OWN / 2.5)
    return model_of([GROUND, *columns, beam], joint)


BACK, SOIL, ROUGH = (
    math.radians(60),
    math.radians(30),
    math.radians(15),
)  # failure plane, friction, of the wall


def frame_falls(joint):
    """Displacement of the beam, m, at no resistance: b (1 - cos a) + h sin a = b, tan a = b / h."""
    return capacity_curve(rocking_frame(joint), steps=5).zero


def soil_wedge(joint):
    """A wall, 1.2 m x 3 m, that a wedge of soil pushes off; the load is the weight of the wedge."""
    top = -3.0 / math.tan(BACK)
    wall = prism("wall", [(0, 0), (1.2, 0), (1.2, 3), (0, 3)], 24e3)
    soil = prism("soil", [(0, 0), (0, 3), (top, 3)])
    bank = prism("bank", [(0, 0), (top, 3), (top - 1, 3), (-1, 0)], None)
    floor = lb.Block.box("floor", (6, 1, 1), (3, 0, -0.5))
    angles = {"bank": SOIL, "wall": ROUGH}  # of the other side of the wedge

    def law(a, b):
        other = {a.name, b.name} - {"soil"}
        return replace(joint, friction=math.tan(angles[other.pop()])) if len(other) == 1 else joint

    own = [lb.loads.force(s.name, (0, 0, -s.weight), tuple(s.centroid)) for s in (wall, soil)]
    blocks = [floor, bank, wall, soil]
    return lb.Model(blocks, ["floor", "bank"], lb.find_interfaces(blocks, law), *own)


def wedge_slides(friction):
    """Coulomb's wedge: its triangle of forces has the thrust on the wall, which slides on its foot."""
    over_weight = math.sin(BACK - SOIL) / math.cos(BACK - SOIL - ROUGH)
    soil, wall = OWN * 4.5 / math.tan(BACK), 24e3 * 3.6
    return friction * wall / (soil * over_weight * (math.cos(ROUGH) - friction * math.sin(ROUGH)))


RIGHT = [(1.0, 0.0), (1.4, 0.0), (0.0, 2.6), (0.0, 2.0)]  # right stone of a triangular arch, m


def triangular_arch(joint):
    stones = prism("right", RIGHT), prism("left", [(-x, z) for x, z in RIGHT])
    live = sum((lb.loads.force(s.name, (0, 0, -s.weight), at=(0, 0, 2.6)) for s in stones), lb.loads.Load())
    return model_of([GROUND, *stones], joint, live)


def feet_slide(friction):
    """Moments about the upper edge of the apex, feet on their inner edges; the load over the weight."""
    x = float(prism("right", RIGHT).centroid[0])
    return x / (1 - 2.6 * friction) - 1


L, DEPTH, SKEW = 3.0, 0.6, math.tan(math.radians(25))  # m: span and depth of a flat arch, its springings


def flat_arch_spreads(joint):
    """Least thrust of six voussoirs whose joints meet in one point, N."""

    def outline(left, right, widens=2 * DEPTH * SKEW / L):
        return [(left, 0), (right, 0), (right * (1 + widens), DEPTH), (left * (1 + widens), DEPTH)]

    cuts = np.linspace(-L / 2, L / 2, 7)
    stones = [prism(f"voussoir {k}", outline(*cuts[k : k + 2])) for k in range(6)]
    abutment = [*outline(L / 2, L)[::3], (3.0, DEPTH), (3.0, 0)]
    held = [prism("right", abutment, None), prism("left", [(-x, z) for x, z in abutment], None)]
    return settlement(model_of([*held, *stones], joint), "right", (1, 0, 0)).nonassociated


def by_hand():
    group = "Slope, walls and arches by hand"
    wall = OWN * 2.5  # N/m
    rows = [
        ("wall on a prop at 2.9 m, load on its top", "least over its joints, virtual powers",
         bends_upwards(), 0.7, propped_wall),
        ("wall that water turns over", "W b/2 / (gamma h^3/6)", wall * 0.5 / (5e3 * 2.5**3 / 6), 0.8, dam),
        ("wall that water pushes off", "mu W / (gamma h^2/2)", 0.3 * wall / (5e3 * 2.5**2 / 2), 0.3, dam),
        ("tower that leans by 4 degrees", "tan(atan(b / h) - lean)",
         math.tan(math.atan(0.2) - LEAN), 0.7, leaning_tower),
        ("three columns under a heavy beam", "b / h: Makris & Vassiliou (2013)",
         WIDE / HIGH, 0.7, rocking_frame),
        ("wall that a wedge of soil pushes off", "mu W / (P (cos - mu sin)), P of Coulomb's wedge",
         wedge_slides(0.5), 0.5, soil_wedge),
        ("triangular arch, its feet slide", "x / (x_foot - mu z) - 1", feet_slide(0.3), 0.3, triangular_arch),
    ]  # fmt: skip
    for name, kind in JOINTS.items():
        yield of_print(group, f"toppling slope of 16 blocks, {name}", "least friction", GOODMAN_BRAY,
                       partial(least_friction, kind), quick=True)  # fmt: skip
    for (structure, formula, value, friction, build), (name, kind) in product(rows, JOINTS.items()):
        for flow, analyse in ANALYSES.items():
            yield Case(group, f"{structure}, {name}", flow, formula, value, 1e-5 * value,
                       partial(analyse, build, kind(friction)), quick=flow == "associated")  # fmt: skip
    thrust = OWN * (L**2 / 8 - (DEPTH * SKEW) ** 2 / 6)
    for name, kind in JOINTS.items():
        yield Case(group, f"flat arch on an abutment that yields, {name}", "least thrust, N",
                   "moments about the springing: gamma (L^2/8 - (d tan)^2/6)", thrust, 1e-6 * thrust,
                   partial(flat_arch_spreads, kind(0.6)), quick=True)  # fmt: skip
    for name, kind in JOINTS.items():
        yield Case(group, f"three columns under a heavy beam, {name}", "displacement of no resistance, m",
                   "b of a column", WIDE, 1e-6 * WIDE,
                   partial(frame_falls, kind(0.7)))  # fmt: skip
