"""False claims that break the flow rule or the normalisation."""

from dataclasses import replace

import numpy as np
from attacking import attack, each, slip_of, with_part
from true_claims import MU, changed, moving, state_of, true

from limitblocks.problem import ASSOCIATED, Turning

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
