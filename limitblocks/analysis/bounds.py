"""Static and kinematic bounds for the associated flow, each solved by itself and proven by residuals."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from limitblocks.analysis.certified import certified
from limitblocks.analysis.in_si import in_model_order, resultants_of
from limitblocks.analysis.polish import polish
from limitblocks.analysis.programs import (
    ROUNDS,
    Solution,
    jamming_program,
    kinematic_program,
    remeasured,
    solved,
    solvers,
    static_program,
)
from limitblocks.analysis.stability import balanced, dead_load_state
from limitblocks.arrays import Array, read_only
from limitblocks.errors import SolverFailure, UnlimitedLoad
from limitblocks.evidence.associated import Bounds
from limitblocks.evidence.proof import Proof
from limitblocks.evidence.residuals import (
    Residuals,
    bounds_residuals,
    static_residuals,
)
from limitblocks.model import Model
from limitblocks.problem import ASSOCIATED, Flow, LimitProblem, State

TOLERANCE = 1e-6  # largest residual, gap and worth of a pair of bounds
CERTIFIED = 1e-7  # largest residual of a certificate that explains why there is no answer


@dataclass(frozen=True, eq=False)
class _Pair:
    """A static and a kinematic solution as one state, its problem and its evidence."""

    problem: LimitProblem
    state: State
    solvers: tuple[str, str]

    @property
    def upper(self) -> float:
        """Dissipation less work of the dead loads: the kinematic load factor."""
        return float(self.problem.g @ self.state.y - self.problem.dead @ self.state.u)

    @property
    def residuals(self) -> Residuals:
        """Of both theorems, and the gap."""
        return bounds_residuals(Flow(self.problem, ASSOCIATED), self.state, self.upper)


def bounds(model: Model, *, tolerance: float = TOLERANCE) -> Bounds:
    """Return the static (lower) and the kinematic (upper) bound on the associated load factor.

    Parameters
    ----------
    model : Model
        The structure.
    tolerance : float
        Largest gap and residual accepted: every block measured by what acts on it, see
        :mod:`limitblocks.evidence.residuals`.

    Raises
    ------
    NoEquilibrium
        If the dead loads alone cannot stand; names the blocks that fall.
    UnlimitedLoad
        If the live load can grow without limit.
    SolverFailure
        If no solver gives a pair of bounds within the tolerance.
    """
    dead = dead_load_state(model.problem)  # a live load that holds up what would fall gives a load factor too
    pair, proof = _proven(model.problem, _solved(model.problem, dead, tolerance), dead, tolerance)
    problem, si = pair.problem, pair.problem.in_si(pair.state)
    upper = proof.upper if proof.complete else pair.upper / problem.units.live
    return Bounds(
        lower=si.load_factor,
        upper=upper,
        gap=pair.residuals["gap"],
        worth=pair.residuals["worth"],
        stress_resultants=resultants_of(problem, pair.state.x),
        generalised_stresses=read_only(si.x),
        displacement_rates=in_model_order(model, si.u),
        flow_multipliers=read_only(si.y),
        dead_load_stresses=read_only(dead * model.problem.stress_units),
        residuals=pair.residuals,
        proof=proof,
        solvers=pair.solvers,
        tolerance=tolerance,
        digest=model.digest,
    )


def _proven(problem: LimitProblem, pair: _Pair, dead: Array, tolerance: float) -> tuple[_Pair, Proof]:
    """The pair that proves its bounds, rounding errors included; or the same, and why it proves nothing."""
    own = pair.problem
    state, proof = certified(problem, own, pair.state, dead * problem.stress_units / own.stress_units)
    if proof.width <= tolerance:
        return _Pair(own, state, pair.solvers), proof
    if proof.complete:
        wide = f"proven is only {proof.lower:.6g} to {proof.upper:.6g}, more than {tolerance:g} apart"
        proof = Proof(-np.inf, np.inf, wide, wide)
    return pair, proof


def _solved(problem: LimitProblem, dead: Array, tolerance: float) -> _Pair:
    """The first pair of solutions that passes the tolerance, or the error that explains why there is none."""
    said: list[str] = []
    for pair in _pairs(problem, dead, tolerance, said):
        worst = pair.residuals.worst
        if worst.value <= tolerance:
            return pair
        place = f" at {worst.where}" if worst.where else ""
        said.append(f"{' and '.join(pair.solvers)}, {worst.name} residual {worst.value:.1e}{place}")
    raise SolverFailure(f"no pair of bounds within {tolerance:g}: " + "; ".join(said))


def _pairs(problem: LimitProblem, dead: Array, tolerance: float, said: list[str]) -> Iterator[_Pair]:
    """Pairs of solutions by one solver after the other, each as it is, polished, and in better units."""
    explained = False
    standing = State(0.0, dead, np.zeros(problem.C.shape[1]), np.zeros(len(problem.g)))
    resting = remeasured(problem, standing)  # where a solver finds nothing: units of the dead loads alone
    for solver in solvers(bool(problem.cones.second_order)):
        measured: LimitProblem | None = problem
        for _ in range(ROUNDS):
            if measured is None:
                break
            problem = measured
            static = solved(static_program(problem), solver)
            kinematic = solved(kinematic_program(problem), solver)
            state = _state(static, kinematic)
            if not all(np.isfinite(part).all() for part in (state.load_factor, state.x, state.u, state.y)):
                said.append(f"{solver.name} {static.status} and {kinematic.status}")
                if not explained:
                    explain(problem)
                    explained = True
                measured, resting = resting, None
                continue
            pair = _Pair(problem, state, (static.solver, kinematic.solver))
            yield pair
            polished = polish(Flow(problem, ASSOCIATED), state, until=tolerance / 10)
            if polished is not state:
                yield _Pair(problem, polished, pair.solvers)
            measured = remeasured(problem, polished)


def _state(static: Solution, kinematic: Solution) -> State:
    return State(float(static.values[0]), static.values[1], *kinematic.values)


def explain(problem: LimitProblem) -> None:
    """Raise UnlimitedLoad where a recomputed certificate proves it; else return."""
    none = np.zeros_like(problem.g)
    pushed = replace(problem, dead=problem.live, g=none)  # any multiple of the live load
    for _ in range(ROUNDS):
        for solver in solvers(bool(problem.cones.second_order)):
            (x,) = solved(jamming_program(pushed), solver).values
            x = balanced(pushed, 0.0, x)
            if Residuals(static_residuals(pushed, 0.0, x)).worst.value <= CERTIFIED:
                raise UnlimitedLoad(
                    "the live load can grow without limit: a stress state within the yield surface balances "
                    "it alone; check its direction, or use the non-associated analysis"
                )
        found = np.isfinite(x).all()
        better = remeasured(pushed, State(0.0, x, np.zeros(pushed.C.shape[1]), none)) if found else None
        if better is None:
            return
        pushed = better
