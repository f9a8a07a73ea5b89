"""True solutions of small models, by hand or by the library: what the attacks falsify."""

from dataclasses import replace
from functools import cache

import numpy as np
from scipy.optimize import nnls

import limitblocks as lb
from limitblocks.evidence.backward_error import backward_error
from limitblocks.evidence.claim import claim_of
from limitblocks.problem import Flow, State, Turning, turning_of

MU, B, H, DEPTH = 0.3, 2.0, 1.0, 1.5  # the sliding block
UNIT_WEIGHT = 20e3
FLOOR = lb.Block.box("floor", (100.0, 20.0, 1.0), (0.0, 0.0, -0.5))
X = (1.0, 0.0, 0.0)


def claimed(model, state, **others):
    """The claim of a dimensionless state."""
    problem, si = model.problem, model.problem.in_si(state)
    rates = dict(zip(problem.blocks, si.u.reshape(-1, 6), strict=True))
    return lb.results.Claim(
        si.load_factor,
        (problem.resultants @ state.x * problem.units.resultants).reshape(-1, 6),
        np.array([rates.get(block.name, np.zeros(6)) for block in model.blocks]),
        si.y,
        si.x,
        digest=model.digest,
        **others,
    )


def state_of(model, claim):
    """The dimensionless state of a claim that has everything."""
    u = claim.displacement_rates[model.free].ravel()
    si = State(claim.load_factor, claim.generalised_stresses, u, claim.flow_multipliers)
    return model.problem.dimensionless(si)


def flow_of(model, claim):
    return Flow(model.problem, claim.dilatancy, turning_of(claim.turning))


def error_of(model, claim):
    return backward_error(flow_of(model, claim), state_of(model, claim))


def changed(model, claim, **parts):
    """The claim with parts of its dimensionless state (load_factor, x, u, y) put in place."""
    others = {"dilatancy": claim.dilatancy, "turning": claim.turning}
    others["dead_load_stresses"] = claim.dead_load_stresses
    return claimed(model, replace(state_of(model, claim), **parts), **others)


def moving(model, **rates):
    """Displacement rates of the free blocks by name (m, rad), the others at rest; dimensionless, Eq. (55)."""
    p = model.problem
    u = np.concatenate([rates.get(name.replace(" ", "_"), np.zeros(6)) for name in p.blocks])
    u = u / p.rate_units
    return u / (p.live @ u)


def multipliers(flow, x, u):
    """Multipliers of rows at yield that give the rates: nonnegative least squares, a ray for each cone."""
    p = flow.problem
    s, unit = p.F @ x + p.g, np.eye(len(p.g))
    columns = [unit[k] for k in np.flatnonzero(s[: p.cones.linear] < 1e-9)]
    for places in p.cones.groups:
        for row in places:
            size = np.linalg.norm(s[row[1:]])
            if s[row[0]] - size < 1e-9 < size:
                columns.append(unit[row[0]] - s[row[1:]] / size @ unit[row[1:]])
    columns = np.transpose(columns)
    y, off = nnls(flow.matrix(x).T @ columns, -(p.C @ u))
    assert off <= 1e-11 * np.linalg.norm(p.C @ u)
    return columns @ y


def determinate(model, load_factor, u, **flow):
    """The claim of a statically determinate model: its stresses by equilibrium, its mechanism given."""
    p = model.problem
    a = load_factor * p.units.live
    x = np.linalg.solve(p.C.T.toarray(), p.dead + a * p.live)
    return claimed(model, State(a, x, u, multipliers(Flow(p, **flow), x, u)), **flow)


def on_floor(blocks, joints, live, extra=()):
    """A model of blocks on the floor, each with its joint, and further interfaces."""
    found = [*extra]
    for block, joint in zip(blocks, joints, strict=True):
        found += lb.find_interfaces([FLOOR, block], joint)
    return lb.Model([FLOOR, *blocks], ["floor"], found, lb.self_weight(), live)


def sliding(joint):
    """Load factor mu < b/h, sliding along X."""
    model = lb.structures.block(joint, width=B, height=H, depth=DEPTH)
    return model, determinate(model, MU, moving(model, block_1=np.array([1.0, 0, 0, 0, 0, 0])))


def about(block, point, axis):
    """Rates at the centroid of a block that turns about an axis through a point."""
    return np.concatenate([np.cross(axis, block.centroid - point), axis])


def rocking():
    """Load factor b/h < mu, turning about the edge at x = b."""
    model = lb.structures.block(lb.OrdunaLourenco(0.7), width=0.5, height=1.0)
    turn = about(model.free_blocks[0], (0.5, 0.0, 0.0), (0.0, 1.0, 0.0))
    return model, determinate(model, 0.5, moving(model, block_1=turn))


def scales():
    """A 10 m cube (friction .6) and a 2 cm stone (.3) on one floor: the stone slides at .3."""
    cube = lb.Block.box("cube", (10.0, 10.0, 10.0), (0.0, 0.0, 5.0), UNIT_WEIGHT)
    stone = lb.Block.box("stone", (0.02, 0.02, 0.02), (20.0, 0.0, 0.01), UNIT_WEIGHT)
    joints = [lb.OrdunaLourenco(0.6), lb.OrdunaLourenco(0.3)]
    model = on_floor([cube, stone], joints, lb.mass_proportional(X))
    return model, determinate(model, 0.3, moving(model, stone=np.array([1.0, 0, 0, 0, 0, 0])))


def tower(joint=None):
    """A block that slides at MU under its own live load beside a tower of 80 cubes that only stands."""
    joint = joint or lb.OrdunaLourenco(MU, slip="paper")
    cubes = [lb.Block.box(f"t{k}", (1, 1, 1), (20.0, 0.0, k + 0.5), UNIT_WEIGHT) for k in range(80)]
    slider = lb.Block.box("slider", (B, DEPTH, H), (0.0, 0.0, H / 2), UNIT_WEIGHT)
    rest = lb.find_interfaces(cubes, joint)
    live = lb.loads.force("slider", (slider.weight, 0.0, 0.0), at=slider.centroid)
    found = [*rest]
    for foot in (slider, cubes[0]):
        found += lb.find_interfaces([FLOOR, foot], joint)
    model = lb.Model([FLOOR, slider, *cubes], ["floor"], found, lb.self_weight(), live)
    return model, determinate(model, MU, moving(model, slider=np.array([1.0, 0, 0, 0, 0, 0])))


def pushed():
    """Block a (friction .3), pushed against b (.6) of the same weight: .3 + .6 moves both."""
    a, b = (lb.Block.box(n, (1, 1, 0.5), (x, 0, 0.25), UNIT_WEIGHT) for n, x in (("a", 0.0), ("b", 1.0)))
    joints = [lb.OrdunaLourenco(0.3), lb.OrdunaLourenco(0.6)]
    between = lb.find_interfaces([a, b], lb.OrdunaLourenco(0.3))
    model = on_floor([a, b], joints, lb.loads.force("a", (a.weight, 0.0, 0.0), at=a.centroid), between)
    return model, claim_of(model, lb.nonassociated(model))


def wall(joint):
    model = lb.structures.wall(joint, length=0.8, courses=4, direction=(1, 0.5, 0))
    return model, claim_of(model, lb.nonassociated(model))


def associated_sliding():
    model, _ = sliding(lb.OrdunaLourenco(MU))
    return model, claim_of(model, lb.bounds(model, tolerance=1e-8))


def associated(joint):
    model = lb.structures.wall(joint, length=0.8, courses=4, direction=(1, 0.5, 0))
    return model, claim_of(model, lb.bounds(model, tolerance=1e-8))


def glued():
    """Without any dead load, cohesion c holds a block of height h up to c / (unit weight h)."""
    joint = lb.OrdunaLourenco(MU, cohesion=1e4, tensile_strength=1e4)
    model = lb.structures.block(joint, width=B, height=H, depth=DEPTH, unit_weight=UNIT_WEIGHT)
    model = replace(model, dead=lb.loads.Load())
    u = moving(model, block_1=np.array([1.0, 0, 0, 0, 0, 0]))
    return model, determinate(model, 1e4 / (UNIT_WEIGHT * H), u)


def keyed():
    """A block between two frictionless walls and on a floor of friction MU, pushed along the walls."""
    block = lb.Block.box("key", (1.0, 1.0, 1.0), (0.0, 0.0, 0.5), UNIT_WEIGHT)
    walls = [lb.Block.box(n, (1.0, 4.0, 1.0), (x, 0.0, 0.5)) for n, x in (("left", -1.0), ("right", 1.0))]
    found = [*lb.find_interfaces([FLOOR, block], lb.OrdunaLourenco(MU))]
    for each in walls:
        found += lb.find_interfaces([each, block], lb.PointContact(0.0))
    names = ["floor", "left", "right"]
    live = lb.mass_proportional((0.0, 1.0, 0.0))
    model = lb.Model([FLOOR, *walls, block], names, found, lb.self_weight(), live)
    p = model.problem
    own = p.stress_interface == 0
    x = np.zeros(len(own))
    a = MU * p.units.live
    x[own] = np.linalg.solve(p.C.T.toarray()[:, own], p.dead + a * p.live)
    u = moving(model, key=np.array([0.0, 1.0, 0, 0, 0, 0]))
    return model, claimed(model, State(a, x, u, multipliers(Flow(p), x, u)))


def drifting():
    """A block pushed on a floor of friction MU, and one that nothing pushes on a floor without friction."""
    slider, free = (lb.Block.box(n, (1, 1, 0.5), (x, 0, 0.25), UNIT_WEIGHT) for n, x in (("a", 0), ("b", 5)))
    joints = [lb.OrdunaLourenco(MU), lb.PointContact(0.0)]
    model = on_floor([slider, free], joints, lb.loads.force("a", (slider.weight, 0, 0), at=slider.centroid))
    p = model.problem
    x = np.linalg.lstsq(p.C.T.toarray(), p.dead + MU * p.units.live * p.live, rcond=None)[0]
    u = moving(model, a=np.array([1.0, 0, 0, 0, 0, 0]))
    return model, claimed(model, State(MU * p.units.live, x, u, multipliers(Flow(p), x, u)))


def slippery(mu=1e-6):
    """A load factor of one millionth."""
    model = lb.structures.block(lb.OrdunaLourenco(mu), width=B, height=H, depth=DEPTH)
    return model, determinate(model, mu, moving(model, block_1=np.array([1.0, 0, 0, 0, 0, 0])))


def twisted(turning, sides=(1.0, 1.0), against=False):
    """A stone under N, bending and torsion on the surface of Eq. (30), loaded so that it twists.

    `against`: the shear turns the stone about the point where N acts against the torsion about the centroid,
    more than the torsion does; with Table 5 the interface then gives work.
    """
    joint = lb.OrdunaLourenco(0.6, slip="paper")
    model = lb.structures.block(joint, width=sides[0], depth=sides[1], height=0.5)
    p = model.problem
    l1, l2 = p.half_sides[0]
    e1, e2 = 0.8 * l1, 0.8 * l2
    # the torsion about (e1, e2) is T - (e1 V2 - e2 V1); the shear is half of N, across the lever
    V1, V2 = (-0.5 if against else 0.5) * np.array([e2, -e1]) / np.hypot(e1, e2)
    Q = np.array([V1, V2, -1.0, -e2, e1, 0.0])  # N acts at (-M2/N, M1/N)
    torsion = p.F[:, [5]].toarray().ravel()
    s = p.F @ Q + p.g
    bent = np.array([mode == "moment-twist" for mode in p.row_mode]) & (torsion < 0.0)
    Q[5] = (s[bent] / -torsion[bent]).min()
    x = Q * (-p.dead[2])
    load_factor = -1.0 if against and turning is Turning.PRESSURE else 1.0  # the load works in any case
    wrench = (p.C.T @ x - p.dead) / load_factor * p.units.loads
    block = model.free_blocks[0]
    live = lb.loads.force(block.name, wrench[:3], at=block.centroid) + lb.loads.moment(block.name, wrench[3:])
    model = replace(model, live=live)
    point = np.array([e1, e2]) * p.units.interface_length if turning is Turning.PRESSURE else np.zeros(2)
    face = model.interfaces[0]
    axis = face.axes[2] if face.block_j == block.name else -face.axes[2]
    u = moving(model, block_1=about(block, face.centroid + point @ face.axes[:2], axis))
    return model, determinate(model, load_factor, u, turning=turning)


TRUE = {
    "sliding, octagon": lambda: sliding(lb.OrdunaLourenco(MU, slip="paper")),
    "sliding, circle": lambda: sliding(lb.OrdunaLourenco(MU)),
    "rocking": rocking,
    "scales": scales,
    "tower": tower,
    "round tower": lambda: tower(lb.OrdunaLourenco(MU)),
    "pushed": pushed,
    "slippery": slippery,
    "glued": glued,
    "keyed": keyed,
    "drifting": drifting,
    "wall": lambda: wall(lb.OrdunaLourenco(0.6)),
    "octagonal wall": lambda: wall(lb.OrdunaLourenco(0.6, slip="paper")),
    "points": lambda: wall(lb.PointContact(0.6)),
    "twisted": lambda: twisted(Turning.CENTROID),
    "twisted against its shear": lambda: twisted(Turning.CENTROID, against=True),
    "twisted, Table 5": lambda: twisted(Turning.PRESSURE),
    "associated": lambda: associated(lb.OrdunaLourenco(0.6)),
    "associated, sliding": associated_sliding,
    "associated points": lambda: associated(lb.PointContact(0.6)),
}


@cache
def true(name):
    """Model and true claim."""
    return TRUE[name]()


def shaken(problem, state, size):
    """The state with other stresses in equilibrium, and a mechanism that is as far off."""
    random = np.random.default_rng(2)
    shake = random.standard_normal(len(state.x)) * np.abs(state.x)
    C = problem.C.T.toarray()
    shake -= np.linalg.lstsq(C, C @ shake, rcond=None)[0]
    u = state.u * (1.0 + size * random.standard_normal(len(state.u)))
    return replace(state, x=state.x + size * shake, u=u)
