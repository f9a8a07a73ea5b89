"""Interfaces that give power instead of taking it up, as Table 5 can: a solution with them is no collapse."""

from __future__ import annotations

import numpy as np

from limitblocks.errors import few
from limitblocks.evidence.measure import Measure
from limitblocks.problem import Flow, State

SHOWN = 3  # interfaces


def given_power(flow: Flow, state: State, tolerance: float) -> tuple[str, ...]:
    """Return a remark that names the interfaces whose residual "dissipation" is above the tolerance."""
    p = flow.problem
    with np.errstate(divide="ignore", invalid="ignore"):  # a state without power of the live load
        power = flow.dissipation(state.x, state.y) / Measure(p, state).power
    giving = np.flatnonzero(power < -tolerance)
    if not len(giving):
        return ()
    order = giving[np.argsort(power[giving])]
    shown = few([f"{p.interfaces[k]} ({-power[k]:.1e})" for k in order], SHOWN)
    return (
        f"interfaces give power instead of taking it up, over that of the live load: {shown}; "
        "no joint can, so that this is no collapse",
    )
