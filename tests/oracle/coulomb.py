"""Oracle: the associated load factor of PointContact models, from the equations in another form.

Only blocks, interfaces and loads of a model are read. Unknowns are the forces at the corners of the contact
polygons; equations are the equilibrium of each block in global axes, about its own centroid, measured in its
own weight and size. Blocks that meet only through supports are solved by themselves, each group in its own
scale.
"""

from dataclasses import dataclass
from decimal import Decimal, localcontext

import numpy as np
from cone_program import DIGITS, ONE, ZERO, exact, maximise
from scipy import sparse

EDGE = Decimal("1e-12")  # a margin below it is that of rounding in the data
ROUNDED = Decimal(2) ** -50  # relative error of the doubles that describe a model, a few roundings each
POSED = Decimal("1e-8")  # relative change of a load factor by such errors beyond which no program can know it


@dataclass(frozen=True)
class Truth:
    """What `lb.bounds` should say of a model.

    `verdict` is "number" (`load_factor`), "unlimited", "falls" or "undecided", where the oracle's own gap or
    residuals leave it open or the dead loads are on the edge of falling. `interior`: whether some stress
    state under the dead loads is strictly within every cone; None if unknown.
    """

    verdict: str
    load_factor: float = np.nan
    interior: bool | None = None


def truth(model) -> Truth:
    """Return the truth of a model whose joints are all PointContact, from its two programs for each group."""
    with localcontext() as context:
        context.prec = DIGITS[-1]
        groups = [Group(model, names) for names in groups_of(model)]
        margins = [group.margin() for group in groups]
        if any(margin is None for margin in margins):
            return Truth("undecided")
        margin = min(margins)
        if margin < -EDGE:
            return Truth("falls", interior=False)
        if margin < EDGE:
            return Truth("undecided", interior=False)
        most = [group.largest() for group in groups if group.live.any()]
    if any(value is None for value in most):
        return Truth("undecided", interior=True)
    most = float(min(most))
    return Truth("unlimited" if most == np.inf else "number", most, True)


def groups_of(model):
    """Names of free blocks that hang together without the supports."""
    names = [block.name for block in model.free_blocks]
    place = {name: k for k, name in enumerate(names)}
    pairs = [
        (place[i.block_i], place[i.block_j]) for i in model.interfaces if {i.block_i, i.block_j} <= set(names)
    ]
    i, j = np.array(pairs, dtype=int).reshape(-1, 2).T
    graph = sparse.coo_array((np.ones(len(i)), (i, j)), shape=(len(names),) * 2)
    count, part = sparse.csgraph.connected_components(graph, directed=False)
    return [{names[k] for k in np.flatnonzero(part == c)} for c in range(count)]


class Group:
    """The conic programs of one group of blocks."""

    def __init__(self, model, names):
        keep = [k for k, block in enumerate(model.free_blocks) if block.name in names]
        free = [model.free_blocks[k] for k in keep]
        units = np.array([row_units(block) for block in free], dtype=object)
        self.dead, self.live = (
            (exact(load.on(model.free_blocks)[keep]) / units).ravel() for load in (model.dead, model.live)
        )
        place = {block.name: k for k, block in enumerate(free)}
        self.columns = [
            wrenches(i, free, place, units) for i in model.interfaces if {i.block_i, i.block_j} & names
        ]

    def largest(self, sign=1):
        """Largest load factor (of the live load times `sign`); inf, or None if undecided or there is none."""
        scale = abs(self.live).max()  # the live load brought to unit size
        answer = maximise(self.columns, len(self.live), self.dead, sign * self.live / scale)
        if answer.status == "optimal" and self.sensitivity(answer) * ROUNDED > POSED * abs(answer.value):
            return None
        return value_of(answer, scale)

    def sensitivity(self, answer):
        """Change of the optimum for unit relative changes of every number of the program, at worst."""
        rates, forces, at = abs(answer.rates), abs(answer.forces).ravel(), 0
        result = rates @ abs(self.dead) + abs(answer.value)
        for rows, matrix in self.columns:
            result += rates[rows] @ abs(matrix) @ forces[at : at + matrix.shape[1]]
            at += matrix.shape[1]
        return result

    def margin(self):
        """Largest m such that the dead loads stand with every force m within its cone (see `wrenches`)."""
        along = np.full(len(self.dead), ZERO, dtype=object)
        for rows, matrix in self.columns:
            along[rows] += matrix[:, ::3].sum(axis=1)
        scale = abs(along).max()
        if scale < EDGE:  # these forces balance each other: self-stress within every cone
            return Decimal("inf")
        return value_of(maximise(self.columns, len(along), self.dead, along / scale), scale)


def value_of(answer, scale):
    """The optimum, its variable having been measured in 1/scale."""
    if answer.status == "unbounded":
        return Decimal("inf")
    return answer.value / scale if answer.status == "optimal" else None


def row_units(block):
    """Units of the six equations of a block: its weight, and its weight times its size."""
    weight = Decimal(block.weight)
    return [weight] * 3 + [weight * Decimal(block.size)] * 3


def wrenches(interface, free, place, units):
    """Rows met, and the wrench on their blocks of each cone's three components."""
    s1, s2, n = exact(interface.axes)
    centroid = exact(interface.centroid)
    ends = [
        (place[name], sign)
        for name, sign in ((interface.block_i, ONE), (interface.block_j, -ONE))
        if name in place
    ]
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
                wrench += [
                    sign * unit * f / u for f, u in zip([*force, *cross(arm, force)], units[k], strict=True)
                ]
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
