"""False claims that break the signs of the multipliers, complementarity or the dissipation."""

from dataclasses import replace

import numpy as np
from attacking import attack, balanced, each, rows_of, slip_of
from true_claims import FLOOR, UNIT_WEIGHT, changed, claimed, moving, state_of, true, twisted

import limitblocks as lb
from limitblocks.problem import Mode, State, Turning

# ------------------------------------------------------------------------------------- multipliers


def parted():
    """A load that draws the block of friction .3 away from its neighbour; no force between them."""
    model, _ = true("pushed")
    a = next(block for block in model.blocks if block.name == "a")
    return replace(model, live=lb.loads.force("a", (-a.weight, 0.0, 0.0), at=a.centroid))


def separate(model, load_factor, toward):
    """Block a slides by itself, in the direction `toward` of X, with no force between the blocks."""
    p, names = model.problem, model.problem.interfaces
    between, below = names.index("a|b"), names.index("floor|a")
    a = load_factor * p.units.live
    own = np.isin(p.stress_interface, [k for k, name in enumerate(names) if name.startswith("floor|")])
    x = np.zeros(len(own))
    x[own] = np.linalg.solve(p.C.T.toarray()[:, own], p.dead + a * p.live)
    u = moving(model, a=np.array([toward, 0.0, 0, 0, 0, 0]))
    y = slip_of(model, below, np.where(np.arange(len(u)) < 6, u, 0.0))
    rate = (p.C @ u)[6 * between : 6 * between + 6]
    rows = rows_of(model, Mode.HINGE, between)
    G = p.G.toarray()[rows][:, 6 * between : 6 * between + 6]
    y[rows] = np.linalg.lstsq(G.T, -rate, rcond=None)[0]
    return claimed(model, State(a, x, u, y))


@attack("multipliers")
def one_block_slides_into_the_other():
    """.3 moves block a alone, if block b lets it in: the joint closes, by negative multipliers."""
    model, _ = true("pushed")
    return model, separate(model, 0.3, 1.0)


@attack("multipliers", **{"1": (1.0,), "1e-9": (1e-9,), "1e-12": (1e-12,)})
def slides_into_a_stone_that_leans_on_a_wall(light):
    """Nothing can move: no load factor of .3. However light the stone is."""
    joint = lb.OrdunaLourenco(0.3)
    a, b = (
        lb.Block.box(n, (1, 1, 0.5), (x, 0, 0.25), w * UNIT_WEIGHT)
        for n, x, w in (("a", 0.0, 1.0), ("b", 1.0, light))
    )
    stop = lb.Block.box("stop", (1.0, 4.0, 1.0), (2.0, 0.0, 0.5))
    found = [lb.find_interfaces([*pair], joint) for pair in ((FLOOR, a), (FLOOR, b), (a, b), (b, stop))]
    live = lb.loads.force("a", (a.weight, 0.0, 0.0), at=a.centroid)
    blocks, supports = [FLOOR, stop, a, b], ["floor", "stop"]
    model = lb.Model(blocks, supports, [each for one in found for each in one], lb.self_weight(), live)
    return model, separate(model, 0.3, 1.0)


def drawn_apart(change):
    """The true claim of `parted`, with multipliers changed at the joint that opened without a force."""
    model = parted()
    claim = separate(model, 0.3, -1.0)
    y = state_of(model, claim).y.copy()
    between = model.problem.interfaces.index("a|b")
    change(model, between, y)
    return model, changed(model, claim, y=y)


@attack("multipliers")
def negative_slip_where_nothing_is_pressed():
    """Without dilatancy the head of a slip cone moves nothing."""

    def change(model, between, y):
        y[rows_of(model, Mode.SLIP, between)[0]] -= 1e-3

    return drawn_apart(change)


@attack("multipliers")
def twists_of_both_signs_that_cancel():
    def change(model, between, y):
        y[rows_of(model, Mode.TWIST, between)] -= 1e-3

    return drawn_apart(change)


@attack("multipliers")
def bending_twists_of_both_signs_that_cancel():
    def change(model, between, y):
        y[rows_of(model, Mode.MOMENT_TWIST, between)] -= 1e-6

    return drawn_apart(change)


@attack("multipliers", "complementarity")
def negative_multipliers_on_loaded_rows_cancel_in_the_sum():
    """20 % too low: the work the slip does not find is given back by the tower, 1/10,000 at each row."""
    model, claim = true("tower")
    false = balanced(model, claim, 0.8 * claim.load_factor)
    p, state = model.problem, state_of(model, false)
    s, y = p.F @ state.x + p.g, state.y.copy()
    # twists of both signs move nothing; all cubes together give back what the slip row leaves over
    idle = [
        k for k in range(len(p.g)) if p.row_mode[k] is Mode.TWIST and p.blocks[0] not in interface_of(p, k)
    ]
    y[idle] = -(s @ y) / s[idle].sum()
    assert abs(s @ y) < 1e-12
    return model, changed(model, false, y=y)


def interface_of(problem, row):
    return problem.interfaces[problem.row_interface[row]]


# --------------------------------------------------------------------------------- complementarity


@attack("complementarity", **each("sliding, octagon", "sliding, circle", "drifting", "tower", "scales"))
def load_factor_20_per_cent_too_low(name):
    """Within yield, in balance, with the true mechanism: only nothing yields yet."""
    model, claim = true(name)
    return model, balanced(model, claim, 0.8 * claim.load_factor)


@attack("complementarity", "dissipation")
def overturning_before_the_edge_is_reached():
    """A hinge that is not at yield gives the work that its pressure does as it closes."""
    model, claim = true("rocking")
    return model, balanced(model, claim, 0.8 * claim.load_factor)


@attack("complementarity")
def drift_of_1e17_hides_that_nothing_yields():
    """A block that costs nothing to move makes the power of all forces large."""
    model, claim = true("drifting")
    u = state_of(model, claim).u.copy()
    u[7] = 1e17
    return model, changed(model, balanced(model, claim, 0.5 * claim.load_factor), u=u)


@attack("complementarity", **each("tower", "round tower"))
def idle_twists_on_loaded_rows(name):
    """Multipliers of both signs of torsion on rows far from yield: they move nothing."""
    model, claim = true(name)
    y = state_of(model, claim).y.copy()
    y[rows_of(model, Mode.TWIST, 3)] += 1e-6
    return model, changed(model, claim, y=y)


# ------------------------------------------------------------------------------------- dissipation


@attack("dissipation", square=((1.0, 1.0),), long=((1.0, 2.0),), longer=((4.0, 1.0),))
def table_5_at_an_interface_that_gives_work(sides):
    """Every equation of the paper holds, at load factor -1."""
    return twisted(Turning.PRESSURE, sides, against=True)
