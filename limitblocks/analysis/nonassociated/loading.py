"""Increments from the permanent loads to collapse: each starts at the stresses of the one before.

Slip that has stopped stays where it is, as in incremental plasticity: multipliers of an increment are not
negative, whatever flowed before. At collapse the stresses stop changing, the compliance plays no part any
more and Eqs (54)-(59) hold; the polish takes them to rounding.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from limitblocks.analysis.nonassociated.increment import NO_BARRIER, Increment, Tried, faded, increment
from limitblocks.analysis.nonassociated.path import DEGENERATE
from limitblocks.analysis.nonassociated.path_equations import Barrier, Path
from limitblocks.analysis.nonassociated.path_measures import by_units
from limitblocks.analysis.nonassociated.path_record import RETURNS
from limitblocks.analysis.nonassociated.path_start import path_from
from limitblocks.analysis.nonassociated.settings import Settings
from limitblocks.analysis.nonassociated.stretch import ARRIVED
from limitblocks.analysis.pivot import pivoted
from limitblocks.analysis.polish import defect, polish
from limitblocks.arrays import Array
from limitblocks.evidence.residuals import Residuals, mcp_residuals
from limitblocks.evidence.results import Iteration
from limitblocks.problem import Flow, State

log = logging.getLogger(__name__)

SOFTENING = 1e-3  # of the force of an interface: the epsilon of Table 5 while stepping
ADMISSIBLE = 1e-8  # residuals of equilibrium and yield at the end of an increment
NEAR = 0.1  # flow residual below which the polish is tried
DRIFT = 1e-3  # change of the load factor, relative, up to which the polished state is that of the increment
FAST = 4.0  # growth where the flow residual is below a tenth of NEAR: nothing but the collapse is left
BEHIND = 20.0  # of an increment that springs back beyond the permanent loads: tau counts from so many before
CLIMBED = 1e4  # times dead loads and strengths, beside which they count for nothing: the path has no end
LEAST = 1e-6  # of the first increment: smaller ones are not tried
USED_UP = (
    "the increments of the load path have used up their {} factorisations; Settings(budget=...) of "
    "limitblocks.settings, settings= of load_path, gives them more"
)
TOO_SMALL = (
    "increments of the load path fail, however small; Settings(first=10) of limitblocks.settings, "
    "settings= of load_path, begins with a larger one"
)
CLIMBS = (
    "the live load can grow without limit along the load path: its increments, each in equilibrium within "
    f"yield, reach a live load {CLIMBED:g} times the dead loads and the strengths of the joints; either "
    "the blocks jam against it, or its direction is not the one that was meant"
)
SPRINGS_BACK = (
    f"; near load factor {{:.6g}} the structure {RETURNS}, farther than they follow: a smaller barrier, "
    "Settings(barrier=1e-6), may"
)


@dataclass(frozen=True, eq=False)
class Pushed:
    """An increment, the stresses it starts from, the state at its end, its residuals, and its cost."""

    start: Array
    increment: Increment
    state: State
    residuals: Residuals
    factorisations: int
    failures: int

    def told(self, unit: float) -> Iteration:
        """Return what it tells the user; `unit` is that of the live load."""
        return Iteration(
            load_factor=float(self.state.load_factor / unit),
            kind="step",
            step_size=float(1.0 / self.increment.rho),
            residuals=self.residuals.to_dict(),
            inner=self.factorisations,
            failures=self.failures,
        )


Progress = Callable[[Pushed], None]


@np.errstate(all="ignore")  # a state that ran away is none of the path
def pushed(
    flow: Flow,
    x0: Array,
    weights: Array,
    tolerance: float,
    settings: Settings,
    scale: float,
    progress: Progress | None = None,
    share: Array | float = 1.0,
) -> tuple[tuple[Pushed, ...], State, str]:
    """Push from the stresses `x0` until the structure collapses.

    Parameters
    ----------
    flow, x0, weights, share
        As for :func:`limitblocks.analysis.nonassociated.path_start.path_from`.
    tolerance : float
        Largest residual of a solution.
    settings : Settings
        Size of the increments.
    scale : float
        Load factor that increments are measured by, dimensionless.
    progress : callable, optional
        Called with each increment.

    Returns
    -------
    tuple of Pushed, State, str
        The increments, the collapse or the last state within yield, and why there is no collapse, in words.
    """
    soft, blocks = replace(flow, softening=SOFTENING), len(flow.problem.blocks)
    barrier = Barrier(settings.barrier, floor=0.0)
    path = path_from(soft, x0, weights, barrier, 0, scale / blocks, share, by_units)
    first = rho = float(path.elastic[0] / weights[0]) / blocks / settings.first
    strength = float(np.linalg.norm(flow.problem.g) / np.linalg.norm(flow.problem.live))
    endless = CLIMBED * max(scale, strength)
    pushes: list[Pushed] = []
    farthest: tuple[Pushed, ...] = ()  # before any were taken back
    used, failures, sprung = 0, 0, None
    while used < settings.budget and rho * LEAST < first:
        met, proof, closed = _ended(flow, increment(path, weights, rho, settings.left), tolerance)
        used += met.factorisations
        if met.increment is None or proof is None:
            log.info("increment rho %.2g failed after %d", rho, met.factorisations)
            failures += 1
            if met.returned:
                sprung = (pushes[-1].state if pushes else at_rest(flow, x0)).load_factor
                farthest = max(farthest, tuple(pushes), key=_length)
            path, rho = _again(path, rho, pushes, met.returned, settings.growth)
            continue
        state = met.increment.end.state
        pushes.append(Pushed(path.x0, met.increment, state, proof, met.factorisations, failures))
        if progress is not None:
            progress(pushes[-1])
        if closed is not None:
            return tuple(pushes), closed, ""
        if state.load_factor > endless:
            return tuple(pushes), state, CLIMBS
        path, failures = replace(path, x0=state.x, behind=0.0), 0
        rho /= FAST if proof["flow"] < NEAR / 10.0 else settings.growth
    why = USED_UP.format(settings.budget) if used >= settings.budget else TOO_SMALL
    if sprung is not None:
        why += SPRINGS_BACK.format(sprung / flow.problem.units.live)
    farthest = max(tuple(pushes), farthest, key=_length)
    return farthest, farthest[-1].state if farthest else at_rest(flow, x0), why


def _length(pushes: tuple[Pushed, ...]) -> float:
    """Displacement of increments together."""
    return sum(1.0 / one.increment.rho for one in pushes)


def _again(path: Path, rho: float, pushes: list[Pushed], returned: bool, growth: float) -> tuple[Path, float]:
    """Where the increment after one that failed starts, and how large it is; a push may be taken back."""
    if returned and pushes:  # a snap longer than the increment: once more, from farther back
        last = pushes.pop()
        return replace(path, x0=last.start), 1.0 / (1.0 / rho + 1.0 / last.increment.rho)
    if returned and not path.behind:  # beyond the permanent loads
        return replace(path, behind=BEHIND / rho), rho
    return path, rho * growth**2


def at_rest(flow: Flow, x0: Array) -> State:
    """The state of stresses `x0` before anything moves: of the permanent loads, or one with live load."""
    p = flow.problem
    load_factor = float((p.C.T @ x0 - p.dead) @ p.live / (p.live @ p.live))
    state = State(load_factor, x0, np.zeros(p.C.shape[1]), np.zeros(len(p.g)))
    permanent = replace(state, load_factor=0.0)
    return permanent if mcp_residuals(flow, permanent)["equilibrium"] <= ADMISSIBLE else state


def _ended(flow: Flow, met: Tried, tolerance: float) -> tuple[Tried, Residuals | None, State | None]:
    """The increment, residuals of its end, and the collapse; without a barrier where it may be near one.

    Without residuals the end is not in equilibrium within yield; without a collapse there is more to push.
    """
    proof = None if met.increment is None else _proof(flow, met.increment)
    if met.increment is None or proof is None or proof["flow"] > NEAR:
        return met, proof, None
    closed = _closed(flow, met.increment, tolerance)
    if closed is not None or met.increment.left <= ARRIVED * NO_BARRIER:
        return met, proof, closed
    return _ended(flow, faded(met.increment, used=met.factorisations), tolerance)


def _proof(flow: Flow, met: Increment) -> Residuals | None:
    """Residuals of the end of an increment, None where it is not in equilibrium within yield."""
    residuals = mcp_residuals(flow, met.end.state)
    return residuals if max(residuals["equilibrium"], residuals["yield"]) <= ADMISSIBLE else None


def _closed(flow: Flow, met: Increment, tolerance: float) -> State | None:
    """The collapse that an increment ends at, None if it does not: polished, else by pivots."""
    reached, before = met.end.state, met.end.load_factor
    state = polish(flow, reached)
    if tolerance < defect(flow, state) < DEGENERATE:
        state = pivoted(flow, reached)
    return state if near(state, before) and defect(flow, state) <= tolerance else None


def near(state: State, load_factor: float) -> bool:
    """Whether a polished state is that of an increment that ends at this load factor."""
    return abs(state.load_factor - load_factor) <= DRIFT * max(abs(state.load_factor), abs(load_factor))
