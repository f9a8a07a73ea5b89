"""Static and kinematic bounds for the associated flow, each solved by itself and proven by residuals."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from itertools import product
from typing import Any

import numpy as np

from limitblocks.analysis.programs import (
    Solution,
    attempts,
    falling_program,
    jamming_program,
    kinematic_program,
    static_program,
)
from limitblocks.arrays import Array, read_only
from limitblocks.errors import NoEquilibrium, SolverFailure, UnlimitedLoad
from limitblocks.evidence.residuals import (
    Residuals,
    kinematic_residuals,
    relative_gap,
    residual,
    static_residuals,
    worth_of_violations,
)
from limitblocks.model import Model
from limitblocks.problem import LimitProblem

TOLERANCE = 1e-6
MOVING = 1e-3  # of the largest displacement rate: less counts as standing still
FALLING = 1e-6  # block weights times block lengths: surplus work below it counts as balance
CERTIFIED = 1e-7  # largest residual of a certificate that explains why there is no answer


@dataclass(frozen=True, eq=False)
class Bounds:
    """Bounds on the load factor of the associated flow, with the states that prove them.

    For the yield surface used, a structure with associated flow collapses between `lower` (a stress state
    in equilibrium within the yield surface) and `upper` (a mechanism). Each comes from its own program.

    Attributes
    ----------
    lower, upper : float
        Static and kinematic load factor; equal up to `gap`.
    gap : float
        Difference relative to the larger of the two.
    stress_resultants : Array, shape (m, 6)
        (V1, V2, N, M1, M2, T) of each interface at the lower bound, local axes, N and N m; N <= 0.
    generalised_stresses : Array, shape (s,)
        What the joints' rows act on: for OrdunaLourenco the stress resultants, for PointContact the forces of
        the points, in the order of the limit problem, dimensionless.
    displacement_rates : Array, shape (n, 6)
        Mechanism of the upper bound: (du, dv, dw, dwX, dwY, dwZ) of each block of the model at its centroid,
        global axes, such that the live load does the work 1 N m, Eq. (55); zero for supports.
    flow_multipliers : Array, shape (R,)
        Flow multiplier of each row of the limit problem, m, in the scale of the mechanism.
    residuals : Residuals
        Recomputed from the limit problem without the solver; all at most `tolerance`.
    solvers : tuple of str
        Solver of the static and of the kinematic program.
    tolerance : float
        Largest residual and gap accepted.
    digest : str
        SHA-256 of the model.
    """

    lower: float
    upper: float
    gap: float
    stress_resultants: Array
    generalised_stresses: Array
    displacement_rates: Array
    flow_multipliers: Array
    residuals: Residuals
    solvers: tuple[str, str]
    tolerance: float
    digest: str

    def __str__(self) -> str:
        worst = self.residuals.worst
        return (
            f"associated load factor {self.lower:.6g} (static) to {self.upper:.6g} (kinematic), "
            f"gap {self.gap:.1e}, worst residual {worst.value:.1e} ({worst.name})"
        )

    def to_dict(self) -> dict[str, Any]:
        """Return the result as plain numbers, lists and text."""
        return {
            "analysis": "bounds",
            "lower": self.lower,
            "upper": self.upper,
            "gap": self.gap,
            "residuals": self.residuals.to_dict(),
            "tolerance": self.tolerance,
            "solvers": list(self.solvers),
            "stress_resultants": self.stress_resultants.tolist(),
            "generalised_stresses": self.generalised_stresses.tolist(),
            "displacement_rates": self.displacement_rates.tolist(),
            "flow_multipliers": self.flow_multipliers.tolist(),
            "model_digest": self.digest,
        }


def bounds(model: Model, *, tolerance: float = TOLERANCE) -> Bounds:
    """Return the static (lower) and the kinematic (upper) bound on the associated load factor.

    Parameters
    ----------
    model : Model
        The structure.
    tolerance : float
        Largest gap and residual accepted: dimensionless, in mean block weights and lengths.

    Raises
    ------
    NoEquilibrium
        If the dead loads alone cannot stand; names the blocks that fall.
    UnlimitedLoad
        If the live load can grow without limit.
    SolverFailure
        If no solver gives a pair of bounds within the tolerance.
    """
    problem = model.problem
    static, kinematic = _solved(problem, tolerance)
    load_factor, x = float(static.values[0]), static.values[1]
    refuse_falling(problem)  # a live load that holds up what would fall gives a load factor too
    u, y = kinematic.values
    upper = float(problem.g @ y - problem.dead @ u)
    scales = problem.scales
    return Bounds(
        lower=load_factor * scales.load_factor,
        upper=upper * scales.load_factor,
        gap=relative_gap(load_factor, upper),
        stress_resultants=read_only((problem.resultants @ x).reshape(-1, 6) * scales.resultants),
        generalised_stresses=read_only(x * problem.stress_units),
        displacement_rates=in_model_order(model, u),
        flow_multipliers=read_only(y * scales.work),
        residuals=bounds_residuals(problem, load_factor, x, upper, u, y),
        solvers=(static.solver, kinematic.solver),
        tolerance=tolerance,
        digest=model.digest,
    )


def bounds_residuals(
    problem: LimitProblem, lower: float, stresses: Array, upper: float, rates: Array, multipliers: Array
) -> Residuals:
    """Recompute every residual of a pair of bounds; all arguments dimensionless, see LimitProblem."""
    gap = residual("gap", relative_gap(lower, upper), "relative gap between the bounds")
    static = static_residuals(problem, lower, stresses)
    return Residuals((*static, *kinematic_residuals(problem, upper, rates, multipliers), gap))


def in_model_order(model: Model, rates: Array) -> Array:
    """Displacement rates (n, 6) of all blocks, supports as zero, in m and rad; `rates` dimensionless."""
    place = {block.name: k for k, block in enumerate(model.blocks)}
    found = np.zeros((len(place), 6))
    found[[place[name] for name in model.problem.blocks]] = (rates * model.problem.rate_units).reshape(-1, 6)
    return read_only(found)


def _solved(problem: LimitProblem, tolerance: float) -> tuple[Solution, Solution]:
    """A static and a kinematic solution that together pass the tolerance, or the error that explains."""
    conic = bool(problem.cones.second_order)
    programs = static_program(problem), kinematic_program(problem)
    statics: list[Solution] = []
    kinematics: list[Solution] = []
    said: list[str] = []
    for static, kinematic in zip(*(attempts(program, conic) for program in programs), strict=True):
        for found, kept, evidence in (
            (static, statics, static_residuals(problem, float(static.values[0]), static.values[1])),
            (
                kinematic,
                kinematics,
                kinematic_residuals(problem, _power(problem, kinematic), *kinematic.values),
            ),
        ):
            worst = Residuals(evidence).worst
            said.append(f"{found.solver} {found.status}, {worst.name} residual {worst.value:.1e}")
            if worst.value <= tolerance:
                kept.append(found)
        if statics and kinematics:
            pair = min(product(statics, kinematics), key=partial(_doubt, problem))
            gap = relative_gap(float(pair[0].values[0]), _power(problem, pair[1]))
            if gap <= tolerance:
                return pair
            said.append(f"gap {gap:.1e}")
        else:
            explain(problem)
    raise SolverFailure(f"no pair of bounds within {tolerance:g}: " + "; ".join(said))


def _doubt(problem: LimitProblem, pair: tuple[Solution, Solution]) -> float:
    """Gap between two solutions with what their violations may be worth: two that err alike agree too."""
    (load_factor, x), (u, y) = pair[0].values, pair[1].values
    gap = abs(_power(problem, pair[1]) - float(load_factor))
    return gap + worth_of_violations(problem, float(load_factor), x, u, y)


def _power(problem: LimitProblem, kinematic: Solution) -> float:
    """Dissipation less work of the dead loads: the kinematic load factor."""
    u, y = kinematic.values
    return float(problem.g @ y - problem.dead @ u)


def explain(problem: LimitProblem) -> None:
    """Raise NoEquilibrium or UnlimitedLoad where a recomputed certificate proves it; else return."""
    refuse_falling(problem)
    for found in attempts(jamming_program(problem), bool(problem.cones.second_order)):
        (x,) = found.values
        unbalanced = np.abs(problem.C.T @ x - problem.live).max()
        if unbalanced < CERTIFIED and problem.cones.margin(problem.F @ x).min() > -CERTIFIED:
            raise UnlimitedLoad(
                "the live load can grow without limit: a stress state within the yield surface balances it "
                "alone; check its direction, or use the non-associated analysis"
            )


def refuse_falling(problem: LimitProblem) -> None:
    """Raise NoEquilibrium unless a stress state, recomputed, proves that the dead loads alone stand.

    Raises
    ------
    NoEquilibrium
        If a mechanism proves that they fall.
    SolverFailure
        If neither is proven.
    """
    said = []
    for found in attempts(falling_program(problem), bool(problem.cones.second_order)):
        standing = Residuals(static_residuals(problem, 0.0, found.dual)).worst
        if standing.value <= TOLERANCE:
            return
        u, y = found.values
        flow = np.abs(problem.C @ u + problem.F.T @ y).max()
        surplus = problem.dead @ u - problem.g @ y
        if flow < CERTIFIED and problem.cones.margin(y).min() > -CERTIFIED and surplus > FALLING:
            speed = np.abs(u).reshape(-1, 6).max(axis=1)
            raise NoEquilibrium(tuple(np.array(problem.blocks)[speed > MOVING * speed.max()].tolist()))
        said.append(f"{found.solver} {found.status}, {standing.name} residual {standing.value:.1e}")
    raise SolverFailure("whether the dead loads stand is undecided: " + "; ".join(said))
