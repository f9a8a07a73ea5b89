"""False claims of structures that fall under their dead loads, and claims of other structures."""

from dataclasses import replace

import numpy as np
from attacking import attack
from stones import sloping
from true_claims import DEPTH, MU, UNIT_WEIGHT, B, H, claimed, true

import limitblocks as lb
from limitblocks.evidence.mechanism import find_mechanism
from limitblocks.problem import Flow, State

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
    return fallen(sloping(UNIT_WEIGHT, joint, DOWN))


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
