"""One path from the permanent loads to a solution of Eqs (54)-(59)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from limitblocks.analysis.nonassociated.path import BUDGET, Walk
from limitblocks.analysis.nonassociated.path_equations import Barrier
from limitblocks.analysis.nonassociated.path_record import Progress, Tracked
from limitblocks.analysis.nonassociated.path_start import path_from
from limitblocks.arrays import Array
from limitblocks.problem import Flow, State


def track(
    flow: Flow,
    x0: Array,
    weights: Array,
    *,
    barrier: Barrier | None = None,
    seed: int = 0,
    budget: int = BUDGET,
    patience: int | None = None,
    power: float = 1.0,
    progress: Callable[[Progress], None] | None = None,
    closing: Callable[[State], State] | None = None,
    further: Callable[[Walk], Walk] | None = None,
) -> tuple[State, Tracked]:
    """Follow one path from the permanent loads to a solution of Eqs (54)-(59).

    Parameters
    ----------
    flow, x0, weights, seed, power
        As for :func:`limitblocks.analysis.nonassociated.path_start.path_from`.
    barrier : Barrier, optional
        How compliance and barrier fade; a small barrier by default.
    budget : int
        Factorisations.
    patience : int, optional
        Factorisations in which theta must fall to a third; a path that takes longer is given up.
    progress : callable, optional
        Called with each accepted point.
    closing : callable, optional
        A further means to close a state near a solution, tried where the polish leaves one open.
    further : callable, optional
        Takes the walk at its end, and returns the one to tell of.

    Returns
    -------
    State, Tracked
        The solution, or the best state met, and how the path went.
    """
    with np.errstate(all="ignore"):  # a point that ran away is not accepted
        walk = Walk(path_from(flow, x0, weights, barrier or Barrier(), seed, power), budget, progress)
        walk.patience, walk.closing = patience, closing
        walk.end = walk.go()
        if further is not None:
            walk = further(walk)
        return walk.told(seed)
