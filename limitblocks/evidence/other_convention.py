"""Stresses of another program that are out of equilibrium by their signs or their unit of force alone."""

from __future__ import annotations

import numpy as np

from limitblocks.problem import LimitProblem, State

_SAME = 1e-6  # of the largest load: what a program rounds its forces to


def other_convention(problem: LimitProblem, state: State) -> tuple[str, ...]:
    """Return the question for stresses that a factor, or the sign of N, may bring into equilibrium.

    The factor that leaves least of F - factor C^T Q, Eq. (56), is asked about if it leaves nothing.
    """
    acting = problem.dead + state.load_factor * problem.live
    carried = problem.balance @ state.x
    square = float(carried @ carried)
    factor = float(acting @ carried) / square if square else 0.0
    if factor and np.abs(acting - factor * carried).max() <= _SAME * np.abs(acting).max():
        why = (
            "N is negative in compression?"
            if factor < 0.0
            else "another unit of force? they are in N and N m"
        )
        return (f"{factor:.6g} times the stress resultants would be in equilibrium: {why}",)
    N = (problem.resultants @ state.x)[2::6]
    if N.max(initial=0.0) > 0.0 <= N.min(initial=0.0):
        return ("no interface is compressed: N is negative in compression",)
    return ()
