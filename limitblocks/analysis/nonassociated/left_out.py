"""Solutions of a model without the stones that carry nothing: no stresses of theirs lead a path astray."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from limitblocks.analysis.interior import carried, carrying
from limitblocks.analysis.nonassociated.path_record import INTERRUPTED
from limitblocks.analysis.polish import polish
from limitblocks.errors import ModelError, NotConverged, SolveError
from limitblocks.evidence.mechanism import find_mechanism
from limitblocks.evidence.residuals import mcp_residuals
from limitblocks.evidence.results import Nonassociated
from limitblocks.model import Model
from limitblocks.problem import Flow, State


def without_idle(model: Model) -> Model | None:
    """Return the model without stones that no loads act on and that carry nothing under the dead loads.

    None where there are none.
    """
    problem = model.problem
    x = carried(problem)
    if x is None:
        return None
    kept = np.zeros(len(problem.interfaces), dtype=bool)
    kept[problem.stress_interface[carrying(problem, x)]] = True
    loads = np.stack([problem.dead, problem.live]).reshape(2, -1, 6)
    busy = np.union1d(np.flatnonzero(loads.any(axis=(0, 2))), problem.ends[kept])
    idle = set(problem.blocks) - {problem.blocks[k] for k in busy.tolist() if k >= 0}
    if not idle:
        return None
    try:
        return replace(
            model,
            blocks=[block for block in model.blocks if block.name not in idle],
            interfaces=[one for one in model.interfaces if not {one.block_i, one.block_j} & idle],
        )
    except ModelError:  # a load names one of them
        return None


def without_what_is_idle(
    model: Model, flow: Flow, tolerance: float, answer: Callable[[Model], Nonassociated]
) -> tuple[State, str] | None:
    """Return a solution that an answer of the model without its idle stones leads to, and how it was found.

    The idle stones bear no stresses; a linear program finds how they move along. None where that is no
    solution within the tolerance, but for one that the user interrupts.
    """
    smaller = without_idle(model)
    if smaller is None:
        return None
    try:
        found = answer(smaller)
    except NotConverged as error:
        found = error.result
    except SolveError:
        return None
    p, place = flow.problem, {name: k for k, name in enumerate(flow.problem.interfaces)}
    own, x = smaller.problem, np.zeros(flow.problem.C.shape[0])
    for k, name in enumerate(own.interfaces):
        x[p.stress_interface == place[name]] = found.generalised_stresses[own.stress_interface == k]
    x /= p.stress_units
    state = polish(flow, State(found.load_factor * p.units.live, x, *find_mechanism(flow, x)))
    ended = found.how.endswith(INTERRUPTED) or mcp_residuals(flow, state).worst.value <= tolerance
    return (state, found.how) if ended else None
