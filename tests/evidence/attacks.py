"""Falsified claims with the residuals that refuse them, most of them true claims changed in one respect."""

from dataclasses import dataclass, replace

import numpy as np
from true_claims import (
    DEPTH,
    FLOOR,
    MU,
    UNIT_WEIGHT,
    B,
    H,
    changed,
    claimed,
    determinate,
    moving,
    state_of,
    true,
    twisted,
)

import limitblocks as lb
from limitblocks.evidence.mechanism import find_mechanism
from limitblocks.problem import ASSOCIATED, Flow, Mode, State, Turning

ATTACKS = {}


@dataclass(frozen=True)
class Attack:
    """A false claim: made by `make` as (model, claim), refused by exactly the residuals `names`."""

    make: object
    names: frozenset


def attack(*names, **variants):
    """Register what makes a false claim; one for each variant (a label and the arguments)."""

    def register(function):
        word = function.__name__.replace("_", " ")
        for label, arguments in variants.items() or [("", ())]:
            name = f"{word}, {label}" if label else word
            assert name not in ATTACKS
            ATTACKS[name] = Attack(lambda given=arguments: function(*given), frozenset(names))
        return function

    return register


def each(*names):
    """Variants: true claims by name."""
    return {name: (name,) for name in names}


def with_part(name, **change):
    """The true claim `name` with parts of its state changed by functions."""
    model, claim = true(name)
    state = state_of(model, claim)
    return model, changed(model, claim, **{part: f(getattr(state, part)) for part, f in change.items()})


def balanced(model, claim, load_factor):
    """The claim of another load factor with the stresses that balance it, the least change of them."""
    p, state = model.problem, state_of(model, claim)
    a = load_factor * p.units.live
    more = np.linalg.lstsq(p.C.T.toarray(), (a - state.load_factor) * p.live, rcond=None)[0]
    return changed(model, claim, load_factor=a, x=state.x + more)


# ------------------------------------------------------------------------------------- equilibrium


@attack(
    "equilibrium",
    **each(
        "sliding, octagon", "sliding, circle", "rocking", "scales", "wall", "points", "associated", "twisted"
    ),
)
def load_factor_one_millionth_too_high(name):
    return with_part(name, load_factor=lambda a: a * (1 + 1e-6))


@attack("equilibrium", **each("associated", "associated points"))
def lower_bound_raised_by_1e_5(name):
    return with_part(name, load_factor=lambda a: a * (1 + 1e-5))


@attack("equilibrium")
def load_factor_of_the_heavy_cube_for_the_light_stone():
    """The 10 m cube slides at .6, the 2 cm stone at .3: at .6 its joint carries half of its push."""
    model, claim = true("scales")
    cube = moving(model, cube=np.array([1.0, 0, 0, 0, 0, 0]))
    of_stone = model.problem.stress_interface == 1
    x = np.where(of_stone, state_of(model, claim).x, state_of(model, balanced(model, claim, 0.6)).x)
    a = 0.6 * model.problem.units.live
    return model, changed(model, claim, load_factor=a, x=x, u=cube, y=slip_of(model, 0, cube))


@attack("yield")
def light_stone_held_by_what_it_does_not_have():
    """The cube's mechanism and multipliers are right for .6; the stone's shear is twice its friction."""
    model, claim = true("scales")
    cube = moving(model, cube=np.array([1.0, 0, 0, 0, 0, 0]))
    return model, changed(model, balanced(model, claim, 0.6), u=cube, y=slip_of(model, 0, cube))


def slip_of(model, interface, u):
    """Multipliers of the slip cone of one interface for the rates u."""
    p = model.problem
    y, rate = np.zeros(len(p.g)), p.C @ u
    rows = [k for k in np.flatnonzero(p.row_interface == interface) if p.row_mode[k] is Mode.SLIP]
    head, across = rows[0], rows[1:3]
    V = p.G[across].toarray()
    y[across] = -np.linalg.lstsq(V.T, rate, rcond=None)[0]
    y[head] = np.linalg.norm(y[across])
    return y


@attack("equilibrium")
def stresses_halved():
    return with_part("wall", x=lambda x: x / 2)


@attack("equilibrium")
def one_block_of_the_tower_out_of_balance():
    """A torsion of one millionth at a joint that nothing moves."""
    model, claim = true("tower")
    x = state_of(model, claim).x.copy()
    x[5] += 1e-6 * np.abs(x[:6]).max()
    return model, changed(model, claim, x=x)


@attack("equilibrium")
def self_stress_of_1e9_hides_an_imbalance():
    """The key slides along the walls at .3; under 1e9 weights between them .45 looks balanced to 1e-10."""
    model, claim = true("keyed")
    state = state_of(model, claim)
    x = np.where(model.problem.stress_interface == 0, state.x, state.x - 1e9)
    return model, changed(model, claim, x=x, load_factor=1.5 * state.load_factor)


@attack("yield", "complementarity")
def self_stress_of_1e9_hides_a_violation():
    """The same with the shear of .45 on a floor that has .3."""
    model, claim = true("keyed")
    p, own = model.problem, model.problem.stress_interface == 0
    a = 1.5 * state_of(model, claim).load_factor
    x = np.full(len(own), -1e9)
    x[own] = np.linalg.solve(p.C.T.toarray()[:, own], p.dead + a * p.live)
    return model, changed(model, claim, x=x, load_factor=a)


@attack("equilibrium", "complementarity")
def stresses_of_two_interfaces_swapped():
    model, claim = true("wall")
    x = state_of(model, claim).x.reshape(-1, 6)[[1, 0, *range(2, len(model.interfaces))]]
    return model, changed(model, claim, x=x.ravel())


@attack("equilibrium", "yield", "complementarity", "dissipation")
def stresses_in_reverse_order():
    model, claim = true("octagonal wall")
    return model, changed(model, claim, x=state_of(model, claim).x.reshape(-1, 6)[::-1].ravel())


@attack("equilibrium", "complementarity", "dissipation", **each("sliding, circle", "sliding, octagon"))
def shear_of_the_other_sign(name):
    """As if the load pushed the other way; the slip is where it was."""
    model, claim = true(name)
    p, x = model.problem, state_of(model, claim).x.copy()
    return model, changed(model, claim, x=x * np.array([-1, -1, 1, -1, -1, -1])[: p.C.shape[0]])


# ------------------------------------------------------------------------------------------- yield


@attack("yield")
def overturns_by_7_5_per_cent():
    """Slides at mu = .43; it would have turned over at b/h = .4."""
    model = lb.structures.block(lb.OrdunaLourenco(0.43), width=0.4, height=1.0)
    p, a = model.problem, 0.43 * model.problem.units.live
    u = moving(model, block_1=np.array([1.0, 0, 0, 0, 0, 0]))
    x = np.linalg.solve(p.C.T.toarray(), p.dead + a * p.live)
    return model, claimed(model, State(a, x, u, slip_of(model, 0, u)))


@attack("yield", "complementarity", **each("sliding, octagon", "sliding, circle", "rocking", "drifting"))
def load_factor_raised_with_its_stresses(name):
    model, claim = true(name)
    return model, balanced(model, claim, 1.01 * claim.load_factor)


@attack("complementarity")
def friction_of_1e_6_with_1_005e_6():
    """The violation is 5e-9 of the weight, within every tolerance, and half a per cent of the load factor."""
    model, claim = true("slippery")
    return model, balanced(model, claim, 1.005e-6)


@attack("yield")
def self_stress_beyond_the_strength():
    """In balance with nothing; on interfaces that do not move, so that complementarity has no say."""
    model, claim = true("associated points")
    p, state = model.problem, state_of(model, claim)
    still = np.abs(p.C @ state.u) < 1e-9
    still = np.isin(
        p.stress_interface, [k for k in range(len(p.ends)) if still[p.stress_interface == k].all()]
    )
    still &= ~np.isin(p.stress_interface, p.row_interface[np.abs(state.y) > 1e-9])
    _, sizes, right = np.linalg.svd(p.C.T.toarray()[:, still])
    more = np.zeros(len(still))
    more[still] = 10.0 * right[len(sizes[sizes > 1e-9])]
    return model, changed(model, claim, x=state.x + more)


@attack("yield")
def the_top_of_the_tower_beside_would_have_slid():
    """Its top cube, pushed by twice its weight, slides at half of the load factor."""
    model, claim = true("tower")
    top = model.free_blocks[-1]
    pushed = replace(
        model, live=model.live + lb.force(top.name, (2.0 * top.weight, 0.0, 0.0), at=top.centroid)
    )
    p, u = pushed.problem, state_of(model, claim).u
    u = u / (p.live @ u)
    return pushed, determinate(pushed, MU, u)


# -------------------------------------------------------------------------------------------- flow


@attack("flow", **{"1e-3": (1e-3,), "1e-6": (1e-6,), "1e-7": (1e-7,)})
def slip_turned_on_the_circle(angle):
    """The rates are turned about the vertical, the multipliers are not."""
    model, claim = true("sliding, circle")
    u = state_of(model, claim).u.copy()
    u[1] = np.tan(angle) * u[0]
    return model, changed(model, claim, u=u)


@attack("complementarity", "normalisation")
def slip_and_multipliers_turned_by_1e_3():
    """Across the shear force: normalisation has the cosine."""
    model, claim = true("sliding, circle")
    state = state_of(model, claim)
    turned = np.hypot(*state.u[:2]) * np.array([np.cos(1e-3), np.sin(1e-3), 0, 0, 0, 0])
    return model, changed(model, claim, u=turned, y=slip_of(model, 0, turned))


@attack("complementarity", **{"1e-3": (1e-3,), "1e-6": (1e-6,)})
def slip_at_an_angle_to_the_shear_force(angle):
    """The same with the work of the live load kept."""
    model, claim = true("sliding, circle")
    u = moving(model, block_1=np.array([1.0, np.tan(angle), 0, 0, 0, 0]))
    return model, changed(model, claim, u=u, y=slip_of(model, 0, u))


@attack("flow", **each("sliding, octagon", "sliding, circle"))
def rises_as_it_slides(name):
    """The rates of the associated flow claimed as zero dilatancy."""
    model, claim = true(name)
    rates = claim.displacement_rates.copy()
    rates[:, 2] = MU * rates[:, 0]
    return model, replace(claim, displacement_rates=rates)


@attack("flow")
def bounds_claimed_as_zero_dilatancy():
    model, claim = true("associated, sliding")
    return model, replace(claim, dilatancy=0.0)


@attack("flow")
def zero_dilatancy_claimed_as_associated():
    model, claim = true("sliding, circle")
    return model, replace(claim, dilatancy=ASSOCIATED)


@attack("flow")
def dilatancy_one_millionth_off():
    model, claim = true("sliding, circle")
    return model, replace(claim, dilatancy=1e-6)


@attack("flow")
def table_5_claimed_as_centroid():
    model, claim = true("twisted, Table 5")
    return model, replace(claim, turning=Turning.CENTROID)


@attack("flow")
def centroid_claimed_as_table_5():
    model, claim = true("twisted")
    return model, replace(claim, turning=Turning.PRESSURE)


@attack("flow", "dissipation")
def centroid_claimed_as_table_5_that_gives_work():
    model, claim = true("twisted against its shear")
    return model, replace(claim, turning="centre of pressure")


@attack("flow", **each("wall", "points", "rocking"))
def multipliers_forgotten(name):
    return with_part(name, y=np.zeros_like)


@attack("flow")
def mirrored_mechanism():
    """Symmetric about x: the block turns over the other edge, with the work of the live load kept."""
    model, claim = true("rocking")
    rates = claim.displacement_rates * np.array([1, 1, -1, 1, 1, 1])
    return model, replace(claim, displacement_rates=rates)


@attack("flow")
def a_free_block_moved_along():
    """The heavy cube drifts, a millionth of the stone's rate, on a floor that holds it."""
    model, claim = true("drifting")
    u = state_of(model, claim).u.copy()
    u[8] += 1e-6  # lifts without opening rows
    return model, changed(model, claim, u=u)


# ----------------------------------------------------------------------------------- normalisation


@attack("normalisation", **each("sliding, octagon", "rocking", "wall", "points", "associated"))
def rates_scaled_with_their_multipliers(name):
    return with_part(name, u=lambda u: u * (1 + 1e-6), y=lambda y: y * (1 + 1e-6))


@attack("normalisation", **each("wall", "sliding, circle"))
def nothing_moves(name):
    return with_part(name, u=np.zeros_like, y=np.zeros_like)


@attack("flow", "normalisation")
def rates_scaled_alone():
    return with_part("sliding, circle", u=lambda u: u * 1.01)


@attack("normalisation", "multipliers", "dissipation")
def everything_runs_backwards():
    """Complementarity cannot tell: the product of -y is zero as that of y."""
    return with_part("scales", u=np.negative, y=np.negative)


# ------------------------------------------------------------------------------------- multipliers


def rows_of(model, mode, interface):
    p = model.problem
    found = np.flatnonzero(p.row_interface == interface)
    return [k for k in found if p.row_mode[k] is mode]


def parted():
    """A load that draws the block of friction .3 away from its neighbour; no force between them."""
    model, _ = true("pushed")
    a = next(block for block in model.blocks if block.name == "a")
    return replace(model, live=lb.force("a", (-a.weight, 0.0, 0.0), at=a.centroid))


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
    live = lb.force("a", (a.weight, 0.0, 0.0), at=a.centroid)
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


# ---------------------------------------------------------------------------------------- standing


def fallen(model):
    """Load factor -1 for live = -z: nothing acts, and the first mechanism that falls is a solution."""
    p = model.problem
    x = np.zeros(p.C.shape[0])
    u, y = find_mechanism(Flow(p), x)
    return model, claimed(model, State(-p.units.live, x, u, y))


DOWN = (0.0, 0.0, -1.0)


@attack("standing", octagon=(lb.OrdunaLourenco(0.6, slip="paper"),), points=(lb.PointContact(0.6),))
def a_stack_that_leans_too_far(joint):
    return fallen(
        lb.structures.overhang(joint, count=3, length=1.0, height=0.3, fraction=1.05, direction=DOWN)
    )


@attack("standing", circle=(lb.OrdunaLourenco(0.4),), points=(lb.PointContact(0.4),))
def a_block_on_a_slope_too_steep(joint):
    """Slope 1:2 and friction .4."""
    angle = np.arctan2(1.0, 2.0)
    turn = np.array([(np.cos(angle), 0, np.sin(angle)), (0, 1, 0), (-np.sin(angle), 0, np.cos(angle))])
    blocks = [
        lb.Block.box("slope", (4, 1, 0.2), (0, 0, -0.1)).moved(turn, (0, 0, 0)),
        lb.Block.box("block", (1, 1, 0.5), (0, 0, 0.25), UNIT_WEIGHT).moved(turn, (0, 0, 0)),
    ]
    found = lb.find_interfaces(blocks, joint)
    return fallen(lb.Model(blocks, ["slope"], found, lb.self_weight(), lb.mass_proportional(DOWN)))


@attack("standing")
def a_dead_load_state_of_nothing():
    model, claim = true("wall")
    return model, replace(claim, dead_load_stresses=0.0 * claim.generalised_stresses)


@attack("standing")
def a_dead_load_state_that_carries_the_live_load_too():
    model, claim = true("sliding, circle")
    return model, replace(claim, dead_load_stresses=claim.generalised_stresses)


@attack("standing")
def a_dead_load_state_beyond_yield():
    """Self-stress between the walls: pulled instead of pressed."""
    model, claim = true("keyed")
    p = model.problem
    own = p.stress_interface == 0
    x = np.full(len(own), 1.0)
    x[own] = np.linalg.solve(p.C.T.toarray()[:, own], p.dead)
    return model, replace(claim, dead_load_stresses=x * p.stress_units)


@attack("standing")
def a_dead_load_state_that_hides_behind_self_stress():
    model, claim = true("keyed")
    p = model.problem
    x = np.where(p.stress_interface == 0, 0.0, -1e9)
    return model, replace(claim, dead_load_stresses=x * p.stress_units)


# ----------------------------------------------------------------------- claims of other structures


@attack("equilibrium", "normalisation")
def claim_of_a_block_one_thousandth_higher():
    model = lb.structures.block(lb.OrdunaLourenco(MU), width=B, height=1.001 * H, depth=DEPTH)
    return model, replace(true("sliding, circle")[1], digest="")


@attack("complementarity")
def claim_of_a_block_of_less_friction():
    """The same block with friction .301: nothing yields."""
    model = lb.structures.block(lb.OrdunaLourenco(MU + 1e-3), width=B, height=H, depth=DEPTH)
    return model, replace(true("sliding, circle")[1], digest="")


@attack("equilibrium", "normalisation")
def claim_of_a_block_that_is_pushed_the_other_way():
    model, claim = true("sliding, circle")
    opposite = replace(model, live=lb.mass_proportional((-1.0, 0.0, 0.0)))
    return opposite, replace(claim, digest="")
