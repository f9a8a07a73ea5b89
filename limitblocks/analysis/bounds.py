"""Static and kinematic bounds for the associated flow, each proven by residuals of its own.

Stresses and mechanism are the primal and the dual solution of one convex program: an interior-point method
finds both together. The kinematic program by itself comes where the dual is too rough.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import islice

import numpy as np

from limitblocks.analysis.certified import CLOSE, certified
from limitblocks.analysis.direct import Programs
from limitblocks.analysis.in_plane import in_plane
from limitblocks.analysis.in_si import in_model_order, resultants_of
from limitblocks.analysis.interior import carried
from limitblocks.analysis.limit_state import IN_HALF, in_units_of, limit_state, programs_of
from limitblocks.analysis.one_thread import one_thread
from limitblocks.analysis.polish import polish
from limitblocks.analysis.programs import ROUNDS, kinematic_program, solved, solvers, static_program
from limitblocks.analysis.scales import Scaled, repaired, scaled, unmoved
from limitblocks.analysis.splitting import Splitting
from limitblocks.analysis.stability import dead_load_state
from limitblocks.analysis.unlimited import explain
from limitblocks.arrays import Array, read_only
from limitblocks.errors import SolverFailure, refuse_no_progress
from limitblocks.evidence.associated import Bounds
from limitblocks.evidence.crushing import beyond_stress_block
from limitblocks.evidence.measure import Measure, without_rounding
from limitblocks.evidence.proof import Proof
from limitblocks.evidence.residuals import OF_BOUNDS, Residual, Residuals, bounds_residuals, nearest
from limitblocks.known import known
from limitblocks.mechanics.loads.load import number
from limitblocks.model import Model
from limitblocks.problem import ASSOCIATED, Flow, LimitProblem, State

PER_BLOCK = 1e-10  # accuracy of a solution of many blocks: a polish costs more than it betters
PAIRS = 4  # that pass the tolerance, tried for a proof where the load factor is small
Tell = Callable[[str], None]


@dataclass(frozen=True, eq=False)
class Pair:
    """A static and a kinematic solution as one state, its problem and its evidence."""

    problem: LimitProblem
    state: State
    solver: str

    @property
    def upper(self) -> float:
        """Dissipation less work of the dead loads: the kinematic load factor."""
        return float(self.problem.g @ self.state.y - self.problem.dead @ self.state.u)

    @cached_property
    def residuals(self) -> Residuals:
        """Of both theorems, and the gap."""
        return bounds_residuals(Flow(self.problem, ASSOCIATED), self.state, self.upper)

    def width(self, proof: Proof) -> float:
        """Distance of proven bounds over the load factor; zero where they are so to rounding."""
        rounding = np.finfo(float).eps * Measure(self.problem, self.state).everything
        size = max(abs(proof.lower), abs(proof.upper)) * self.problem.units.live
        return 0.0 if size <= rounding else proof.width


@one_thread
def bounds(model: Model, *, tolerance: float = OF_BOUNDS, progress: Tell | None = None) -> Bounds:
    """Return the static (lower) and the kinematic (upper) bound on the associated load factor.

    Parameters
    ----------
    model : Model
        The structure.
    tolerance : float
        Largest gap and residual accepted, dimensionless; see :class:`limitblocks.results.Residuals`.
    progress : callable, optional
        Called with the name of each stage as it begins.

    Raises
    ------
    ModelError
        If the tolerance is no number above 0.
    NoEquilibrium
        If the dead loads alone cannot stand; names the blocks that fall.
    UnlimitedLoad
        If the live load can grow without limit.
    SolverFailure
        If no solver gives a pair of bounds within the tolerance.

    Notes
    -----
    Solved once for each model and tolerance. Proven bounds of large models may be farther apart, and say so.
    """
    number(tolerance, "tolerance", "", above=0.0)
    refuse_no_progress(progress)
    tell = progress or (lambda _: None)
    return known(model, ("bounds", tolerance), lambda: _bounds(model, tolerance, tell))


def _bounds(model: Model, tolerance: float, tell: Tell) -> Bounds:
    # a live load that holds up what would fall gives a load factor, too
    problem, digest = model.problem, model.digest  # both walk all blocks: while they are in the cache
    dead, pair, proof = _directly(problem, tolerance, tell) or _with_care(problem, tolerance, tell)
    state, upper = without_rounding(problem, pair.state, pair.upper)
    si = problem.in_si(state)
    upper = proof.upper if proof.complete else upper / problem.units.live
    resultants = resultants_of(problem, pair.state.x)
    return Bounds(
        lower=si.load_factor,
        upper=upper,
        gap=pair.residuals["gap"],
        worth=pair.residuals["worth"],
        stress_resultants=resultants,
        generalised_stresses=read_only(si.x),
        displacement_rates=in_model_order(model, si.u),
        flow_multipliers=read_only(si.y),
        dead_load_stresses=read_only(dead * model.problem.stress_units),
        residuals=pair.residuals,
        proof=proof,
        solvers=(pair.solver, pair.solver),
        tolerance=tolerance,
        digest=digest,
        remarks=beyond_stress_block(model, resultants),
    )


def _directly(problem: LimitProblem, tolerance: float, tell: Tell) -> tuple[Array, Pair, Proof] | None:
    """Dead-load stresses, and the pair of bounds of an accurate solve that proves most, if close enough."""
    accurate = min(max(CLOSE, PER_BLOCK * len(problem.blocks)), tolerance)
    close = max(CLOSE, min(accurate, tolerance / 10.0))
    forms = list(programs_of(problem))
    last, splitting = forms[-1], Splitting(forms[0].form.problem)
    dead = _dead_loads(problem, splitting, tell)
    good: list[tuple[Pair, Proof]] = []
    for programs in forms:
        tell("load factor")
        found = limit_state(programs, in_plane(problem))
        if found is None:
            continue
        tell("proof")
        raw = Pair(problem, *found)
        pair, proof = _certified(raw, programs, dead, close, splitting)
        # another solution is no better where this one is that accurate, and only its proof takes more
        enough = proof.complete and raw.residuals.worst.value <= accurate
        if enough or max(pair.width(proof), pair.residuals.worst.value) <= tolerance:
            good.append((pair, proof))
            if pair.width(proof) <= (tolerance if enough else close):
                break
        if programs is last:  # where a small load factor is wide, accurate is not enough
            forms += in_units_of(last, problem, pair.state)
            accurate = 0.0
    return (dead, *min(good, key=lambda one: one[0].width(one[1]))) if good else None


def _dead_loads(problem: LimitProblem, splitting: Splitting | None, tell: Tell) -> Array:
    """Stresses that carry the dead loads, as far within yield as any are."""
    tell("dead loads")
    found = carried(problem, splitting)
    if found is None:
        tell("dead loads, again with care")
        found = dead_load_state(problem)
    return found


def _certified(
    raw: Pair, programs: Programs, dead: Array, close: float, splitting: Splitting
) -> tuple[Pair, Proof]:
    """The pair near the raw one that proves its bounds, and its proof."""
    problem, plane = raw.problem, in_plane(raw.problem)
    patience = 1 if plane is not None and plane.flat else programs.form.patience
    state, proof = certified(problem, raw.state, dead, close=close, patience=patience, splitting=splitting)
    return replace(raw, state=state), proof


def _with_care(problem: LimitProblem, tolerance: float, tell: Tell) -> tuple[Array, Pair, Proof]:
    """Dead-load stresses and a pair of bounds by one solver after the other."""
    dead = _dead_loads(problem, None, tell)
    tell("load factor, again with care")
    for raw in islice(pairs_of_bounds(problem, dead_load_state(problem), tolerance), PAIRS):
        pair, proof = _proven(raw, dead, tolerance)
        # small beside what acts on a block may be large beside the live load
        small = raw.residuals.worst.value <= tolerance * abs(raw.state.load_factor)
        if pair.width(proof) <= tolerance or small:
            break
    if proof.complete and pair.width(proof) > tolerance:
        wide = f"proven is only {proof.lower:.6g} to {proof.upper:.6g}, more than {tolerance:g} apart"
        proof = Proof(-np.inf, np.inf, wide, wide)
    return dead, pair, proof


def _proven(pair: Pair, dead: Array, tolerance: float) -> tuple[Pair, Proof]:
    """The pair that proves its bounds, rounding errors included; or the same, and why it proves nothing."""
    for whole in (False, True) if in_plane(pair.problem) else (True,):
        state, proof = certified(pair.problem, pair.state, dead, whole=whole)
        if pair.width(proof) <= tolerance:
            return replace(pair, state=state), proof
    return pair, proof


def pairs_of_bounds(problem: LimitProblem, dead: Array, tolerance: float) -> Iterator[Pair]:
    """Pairs of solutions that pass the tolerance, or the error that explains why there is none."""
    said: list[str] = []
    tried: list[Residual] = []
    for pair in _all_pairs(problem, dead, tolerance, said):
        tried.append(pair.residuals.worst)
        if tried[-1].value <= tolerance:
            yield pair
    if not any(worst.value <= tolerance for worst in tried):
        best = [nearest(tried, "pair")] if tried else []
        failures = dict.fromkeys(said)
        raise SolverFailure("; ".join([f"no pair of bounds within {tolerance:g}", *best, *failures]))


def _all_pairs(problem: LimitProblem, dead: Array, tolerance: float, said: list[str]) -> Iterator[Pair]:
    """Pairs of the problem in its plane, to be judged in the whole one, and then of the whole."""
    plane = in_plane(problem)
    if plane is not None:
        for pair in _pairs(plane.problem, plane.stresses_of(dead), tolerance, said, explained=True):
            name = pair.solver + (" in the plane" if plane.flat else IN_HALF)
            yield Pair(problem, plane.lifted(pair.state), name)
    yield from _pairs(problem, dead, tolerance, said)


def _pairs(
    problem: LimitProblem, dead: Array, tolerance: float, said: list[str], explained: bool = False
) -> Iterator[Pair]:
    """Pairs of solutions by one solver after the other: as they are, repaired, polished, in better units."""
    flow = Flow(problem, ASSOCIATED)
    resting = scaled(problem).measured(unmoved(problem, 0.0, dead))  # units where a solver finds nothing
    for solver in solvers(bool(problem.cones.second_order)):
        measured: Scaled | None = scaled(problem)
        for _ in range(ROUNDS):
            if measured is None:
                break
            found = solved(static_program(measured), solver)
            u, *rows = found.duals
            load_factor, x, y = *found.values, np.concatenate(rows)
            if not all(np.isfinite(part).all() for part in (load_factor, x, u, y)):
                said.append(f"{solver.name} {found.status}")
                if not explained:
                    explain(problem, dead)
                    explained = True
                measured, resting = resting, None
                continue
            state = State(float(load_factor), x, u, y)
            yield Pair(problem, measured.in_problem(state), solver.name)
            state = measured.in_problem(repaired(measured, state))
            yield Pair(problem, state, solver.name)
            polished = polish(flow, state, until=tolerance / 10)
            if polished is not state:
                yield Pair(problem, polished, solver.name)
            u, y = solved(kinematic_program(measured), solver).values  # where duals are too rough
            if np.isfinite(u).all() and np.isfinite(y).all():
                state = repaired(measured, State(float(load_factor), x, u, y))
                state = polish(flow, measured.in_problem(state), until=tolerance / 10)
                yield Pair(problem, state, solver.name)
            measured = measured.measured(polished)
