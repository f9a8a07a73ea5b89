"""Ties that a mechanism neither stretches nor shortens: no equation says what they carry."""

from __future__ import annotations

from collections import Counter

import numpy as np

from limitblocks.errors import few
from limitblocks.evidence.determined import determined, determined_as_slip_turns
from limitblocks.evidence.relative_rates import MOVING, largest_rate, relative_rates
from limitblocks.joints import Tie
from limitblocks.model import Model
from limitblocks.problem import Flow, State

CARRIED = 1e-6  # of the unit of force of an interface: a tension below it is none


def locked_tension(model: Model, flow: Flow, state: State) -> tuple[str, ...]:
    """Return a remark for ties, strips and fill that carry a force across which their ends only move.

    Without dilatancy a strip over a joint that slides presses the joint together by any tension from zero to
    its strength, and friction grows with it: none of the equations says which. A tie whose force statics
    determine, as one between two walls that hinge, is none of these.
    """
    problem = flow.problem
    tied = np.array([isinstance(one.joint, Tie) for one in model.interfaces])
    if flow.associated or not tied.any():
        return ()
    rates = np.zeros((len(model.blocks), 6))
    rates[model.free] = problem.in_si(state).u.reshape(-1, 6)
    dq, least = relative_rates(model, rates), MOVING * largest_rate(model, rates)
    N = (problem.resultants @ state.x)[2::6]
    across = np.hypot(dq[:, 0], dq[:, 1])
    locked = tied & (N > CARRIED) & (across > least) & (np.abs(dq[:, 2]) <= MOVING * across)
    if locked.any():
        forces = problem.resultants[6 * np.flatnonzero(locked) + 2]
        one_value = determined(problem, state.y, forces)
        if one_value.any():
            one_value &= determined_as_slip_turns(flow, state, forces)
        locked[locked] = ~one_value
    if not locked.any():
        return ()
    counts = Counter(problem.interfaces[k] for k in np.flatnonzero(locked))
    names = [name if count == 1 else f"{count} × {name}" for name, count in counts.items()]
    most = float((N * problem.units.interface_force)[locked].max())
    return (
        f"a force of up to {most:.4g} N is locked in {few(names, 3)}, whose ends move across it alone: it "
        "may be any from zero to the strength, and the load factor with it; load_factor_range says how far",
    )
