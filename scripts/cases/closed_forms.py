"""Closed forms: equilibrium of one rigid body, and what follows from it for stacks and leaves."""

import math
from dataclasses import replace
from functools import partial
from itertools import product

import limitblocks as lb
from cases.case import ANALYSES, FLOWS, JOINTS, Case, associated, nonassociated
from cases.statics import SIDEWAYS, model_of
from limitblocks import structures


def jammed(joint):
    blocks = [
        lb.Block.box("floor", (3.0, 1.0, 0.2), (0, 0, -0.1)),
        lb.Block.box("ceiling", (3.0, 1.0, 0.2), (0, 0, 1.1)),
        lb.Block.box("block", (1.0, 1.0, 1.0), (0, 0, 0.5), 20e3),
    ]
    return model_of(blocks, joint)


def leaves(joint, between=None):
    """Two leaves of 0.12 m x 2.4 m side by side, their common joint `between` or none, pushed across."""
    blocks = [
        lb.Block.box("base", (1.0, 1.0, 0.2), (0, 0, -0.1)),
        lb.Block.box("inner", (1.0, 0.12, 2.4), (0, -0.06, 1.2), 20e3),
        lb.Block.box("outer", (1.0, 0.12, 2.4), (0, 0.06, 1.2), 20e3),
    ]
    model = model_of(blocks, joint, SIDEWAYS)
    beds = [i for i in model.interfaces if "base" in (i.block_i, i.block_j)]
    sides = [replace(i, joint=between) for i in model.interfaces if between and i not in beds]
    return replace(model, interfaces=[*beds, *sides])


def pushed_at(z, joint):
    model = structures.block(joint, width=0.5, height=1.0)
    weight = model.free_blocks[0].weight
    return replace(model, live=lb.loads.force("block 1", (weight, 0, 0), at=(0, 0, z)))


def block(width, height, joint, **options):
    return structures.block(joint, width=width, height=height, **options)


CLOSED_FORMS = [  # structure, formula, value, friction, model
    ("block 1 m x 0.4 m", "min(mu, b/h)", 0.6, 0.6, partial(block, 1.0, 0.4)),
    ("block 0.5 m x 1 m", "min(mu, b/h)", 0.5, 0.6, partial(block, 0.5, 1.0)),
    ("column of 5 blocks 0.6 m x 0.25 m", "min(mu, b/(k h))", 0.6 / 1.25, 0.6,
     lambda joint: structures.column(joint, count=5, width=0.6, height=0.25)),
    ("force at 0.9 m on a block 0.5 m x 1 m", "min(mu, b/(2 z))", 0.5 / 1.8, 0.4, partial(pushed_at, 0.9)),
    ("force at 0.1 m on a block 0.5 m x 1 m", "min(mu, b/(2 z))", 0.4, 0.4, partial(pushed_at, 0.1)),
    ("stack of 8 overhanging by 0.9 of the harmonic limit", "min(mu, (1 - 0.9) L/(n h))", 0.1 / 3.2, 0.7,
     lambda joint: structures.overhang(joint, count=8, length=1.0, height=0.4, fraction=0.9)),
    ("two leaves without connection", "b/H", 0.12 / 2.4, 0.6, leaves),
    ("the two leaves in one", "2 b/H", 0.24 / 2.4, 0.6,
     partial(block, 1.0, 2.4, depth=0.24, direction=(0, 1, 0))),
]  # fmt: skip


def closed_forms():
    group = "Closed forms"
    for (structure, formula, value, friction, build), (name, kind) in product(CLOSED_FORMS, JOINTS.items()):
        for flow in FLOWS:
            yield Case(group, f"{structure}, {name}", flow, formula, value,
                       value * (1e-6 if flow == "associated" else 1e-5),
                       partial(ANALYSES[flow], build, kind(friction)), quick=True)  # fmt: skip
    for name, kind in JOINTS.items():
        yield Case(group, f"block jammed under a ceiling, {name}", "associated", "unlimited", math.inf, 0.0,
                   partial(associated, jammed, kind(0.3)), quick=True)  # fmt: skip
        yield Case(group, f"block jammed under a ceiling, {name}", "non-associated",
                   "every value >= mu solves it", 0.3, 1e-6, partial(nonassociated, jammed, kind(0.3)),
                   at_least=True)  # fmt: skip
    yield from oblique()
    yield from wedges()
    yield from limits()


def oblique():
    """Coulomb's circle in every direction; the paper's octagon is around it, in one of its directions."""
    push = (math.cos(0.3), math.sin(0.3), 0.0)
    build = partial(block, 1.0, 0.5, direction=push)
    for (name, kind), flow in product(JOINTS.items(), FLOWS):
        yield Case("Closed forms", f"block pushed 0.3 rad off its side, {name}", flow, "mu", 0.3, 3e-6,
                   partial(ANALYSES[flow], build, kind(0.3)), quick=True)  # fmt: skip
    octagon = lb.OrdunaLourenco(0.3, slip="paper")
    for flow in FLOWS:
        yield Case("Closed forms", "block pushed 0.3 rad off its side, OrdunaLourenco(slip='paper')", flow,
                   "mu / cos(0.3): octagon", 0.3 / push[0], 3e-6,
                   partial(ANALYSES[flow], build, octagon), quick=True)  # fmt: skip


def wedges():
    """A wedge pushed along a V groove: derived in tests/validation/test_wedges.py."""
    for (name, kind), degrees in product(JOINTS.items(), (30, 45, 60)):
        w, mu = math.radians(degrees), 0.4
        build = partial(lambda joint, w: structures.wedge(joint, half_angle=w), w=w)
        structure = f"wedge in a V groove of half angle {degrees} degrees, friction {mu}, {name}"
        yield Case("Closed forms", structure, "associated", "mu / sqrt(sin(w)^2 - mu^2 cos(w)^2)",
                   mu / math.sqrt(math.sin(w) ** 2 - (mu * math.cos(w)) ** 2), 1e-6,
                   partial(associated, build, kind(mu)), quick=True)  # fmt: skip
        yield Case("Closed forms", structure, "non-associated", "mu / sin(w)", mu / math.sin(w),
                   1e-3 * mu / math.sin(w), partial(nonassociated, build, kind(mu)), quick=True)  # fmt: skip


def limits():
    group = "Closed forms"
    limit = lb.studies.minimum  # of the friction with which a block rests on a slope of 20 degrees
    slope = math.tan(math.radians(20.0))
    direction = (math.sin(math.radians(20.0)), 0.0, -math.cos(math.radians(20.0)))

    def tilted(kind, friction):
        model = structures.block(kind(friction), width=1.0, height=0.5)
        return replace(model, dead=lb.mass_proportional(direction))

    for name, kind in JOINTS.items():
        yield Case(group, f"block on a slope of 20 degrees, {name}", "least friction", "tan(angle)", slope,
                   1e-5, lambda kind=kind: limit(partial(tilted, kind), 0.2, 0.6).value)  # fmt: skip
        yield Case(group, f"harmonic stack of 8, {name}", "largest overhang / L", "(1/2) sum of 1/i",
                   sum(1 / i for i in range(1, 9)) / 2, 1e-5, partial(overhang, kind))  # fmt: skip


def overhang(kind):
    """Overhang of the stack that just stands, over the length of a block."""

    def stack(fraction):
        return structures.overhang(kind(0.7), count=8, length=1.0, height=0.4, fraction=fraction)

    top = stack(lb.studies.maximum(stack, 0.9, 1.1).value).free_blocks[-1]
    return top.vertices[:, 0].max() - 1.0
