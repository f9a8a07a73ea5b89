"""Oracle: the associated load factor of PointContact models, from the equations in another form.

Only blocks, interfaces and loads of a model are read. Unknowns are the forces at the corners of the contact
polygons; equations are the equilibrium of each block in global axes, about its own centroid, measured in its own
weight and size. Blocks that meet only through supports are solved by themselves, each group in its own scale.
"""

from dataclasses import dataclass
from decimal import Decimal

import numpy as np
from cone_program import ONE, ZERO, exact, maximise
from scipy import sparse


@dataclass(frozen=True)
class Truth:
    """All load factors from `least` to `most` are admissible; none if `least` > `most`.

    `decided` is False where the oracle's own gap or residuals leave it open.
    """

    decided: bool
    least: float = np.nan
    most: float = np.nan

    @property
    def verdict(self) -> str:
        """What `lb.bounds` should say: "number", "unlimited", "falls" or "undecided"."""
        if not self.decided:
            return "undecided"
        if not self.least <= 0.0 <= self.most:
            return "falls"
        return "unlimited" if self.most == np.inf else "number"


def truth(model) -> Truth:
    """Return the interval of admissible load factors of a model whose joints are all PointContact."""
    least, most = -np.inf, np.inf
    for group in groups_of(model):
        for sign in (1, -1):
            answer = solved(model, group, sign)
            if answer.status == "undecided":
                return Truth(False)
            if answer.status == "infeasible":
                return Truth(True, np.inf, -np.inf)
            if answer.status == "optimal" and sign == 1:
                most = min(most, float(answer.value))
            elif answer.status == "optimal":
                least = max(least, -float(answer.value))
    return Truth(True, least, most)


def groups_of(model):
    """Names of free blocks that hang together without the supports."""
    names = [block.name for block in model.free_blocks]
    place = {name: k for k, name in enumerate(names)}
    pairs = [(place[i.block_i], place[i.block_j]) for i in model.interfaces if {i.block_i, i.block_j} <= set(names)]
    i, j = np.array(pairs, dtype=int).reshape(-1, 2).T
    graph = sparse.coo_array((np.ones(len(i)), (i, j)), shape=(len(names),) * 2)
    count, part = sparse.csgraph.connected_components(graph, directed=False)
    return [{names[k] for k in np.flatnonzero(part == c)} for c in range(count)]


def solved(model, group, sign=1):
    """Answer of the conic program of one group of blocks, the live load times `sign`."""
    free = [block for block in model.free_blocks if block.name in group]
    keep = [k for k, block in enumerate(model.free_blocks) if block.name in group]
    dead, live = (exact(load.on(model.free_blocks)[keep]) for load in (model.dead, model.live))
    units = np.array([row_units(block) for block in free], dtype=object)
    if not live.any():
        live = live + ZERO
    columns, place = [], {block.name: k for k, block in enumerate(free)}
    for interface in model.interfaces:
        if {interface.block_i, interface.block_j} & group:
            columns.append(wrenches(interface, free, place, units))
    scale = abs(live / units).max() or ONE  # the live load brought to unit size
    answer = maximise(columns, 6 * len(free), (dead / units).ravel(), (sign * live / units / scale).ravel())
    if answer.status == "optimal":
        object.__setattr__(answer, "value", answer.value / scale)
    return answer


def row_units(block):
    """Units of the six equations of a block: its weight, and its weight times its size."""
    weight = Decimal(block.weight)
    return [weight] * 3 + [weight * Decimal(block.size)] * 3


def wrenches(interface, free, place, units):
    """Rows met, and the wrench on their blocks of each cone's three components."""
    s1, s2, n = exact(interface.axes)
    centroid = exact(interface.centroid)
    ends = [(place[name], sign) for name, sign in ((interface.block_i, ONE), (interface.block_j, -ONE)) if name in place]
    # forces are counted in the weight of the lighter block: the solver's start is then of a sensible size
    unit = min(units[k, 0] for k, _ in ends)
    rows = np.concatenate([6 * k + np.arange(6) for k, _ in ends])
    forces = cone_axes(interface.joint, s1, s2, n)
    columns = []
    for x1, x2 in exact(interface.polygon):
        point = centroid + x1 * s1 + x2 * s2
        for force in forces:
            wrench = []
            for k, sign in ends:
                arm = point - exact(free[k].centroid)
                wrench += [sign * unit * f / u for f, u in zip([*force, *cross(arm, force)], units[k], strict=True)]
            columns.append(wrench)
    return rows, np.array(columns, dtype=object).T


def cone_axes(joint, s1, s2, n):
    """Forces on block i of the unit components of each cone, three to a cone."""
    nothing = ZERO * n
    if joint.friction == 0.0:
        return [-n, nothing, nothing]
    mu = Decimal(joint.friction)
    if joint.cone == "exact":  # x0 = mu |N|
        return [-n / mu, s1, s2]
    # a polygonal cone is spanned by its edges, one pressure each; the first corner of "inner" is along V1
    half = 0.0 if joint.cone == "inner" else 0.5
    angles = 2 * np.pi * (np.arange(joint.sides) + half) / joint.sides
    reach = mu if joint.cone == "inner" else mu / Decimal(np.cos(np.pi / joint.sides))
    edges = [-n + reach * (Decimal(np.cos(a)) * s1 + Decimal(np.sin(a)) * s2) for a in angles]
    return [part for edge in edges for part in (edge, nothing, nothing)]


def cross(a, b):
    return np.array(
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]], dtype=object
    )
