"""False claims that break equilibrium or yield."""

from dataclasses import replace

import numpy as np
from attacking import attack, balanced, each, slip_of, with_part
from true_claims import MU, changed, claimed, determinate, moving, state_of, true

import limitblocks as lb
from limitblocks.problem import State

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
        model, live=model.live + lb.loads.force(top.name, (2.0 * top.weight, 0.0, 0.0), at=top.centroid)
    )
    p, u = pushed.problem, state_of(model, claim).u
    u = u / (p.live @ u)
    return pushed, determinate(pushed, MU, u)
