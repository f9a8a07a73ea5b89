"""The load path: states from the permanent loads to collapse, each in equilibrium and within yield."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from limitblocks.analysis.in_si import resultants_of
from limitblocks.analysis.nonassociated.closing import evidence
from limitblocks.analysis.nonassociated.loading import stages
from limitblocks.analysis.nonassociated.loop import finished
from limitblocks.analysis.nonassociated.settings import Settings
from limitblocks.analysis.nonassociated.stage import Stage
from limitblocks.analysis.nonassociated.start import (
    Start,
    bracket,
    load_scale,
    own_units,
    refuse_unlimited,
    start_stresses,
)
from limitblocks.analysis.polish import polish
from limitblocks.arrays import Array, read_only
from limitblocks.errors import ModelError
from limitblocks.evidence.residuals import TOLERANCE
from limitblocks.evidence.results import Iteration, LoadPath, PathStep
from limitblocks.joints.base import Joint, joint_of
from limitblocks.model import Model
from limitblocks.problem import Flow, LimitProblem, State, Turning, checked_dilatancy, turning_of

FLOWING = 1e-6  # of the largest displacement rate: less counts as no flow
# Small steps, halved where one fails; viscosity only where the structure snaps at every size.
STEPS = Settings(
    first=0.05,
    growth=2.0,
    retries=((1.0, 0.0), (2.0, 0.0), (4.0, 0.0), (1.0, 1e-4), (1.0, 1e-3), (1.0, 1e-2)),
    leap=0,
    budget=3000,
)

Stiffness = tuple[float, float]


def load_path(
    model: Model,
    *,
    dilatancy: float = 0.0,
    turning: Turning | str = Turning.CENTROID,
    tolerance: float = TOLERANCE,
    start: Start | None = None,
    stiffness: Stiffness | Mapping[Joint, Stiffness] | None = None,
    settings: Settings = STEPS,
    progress: Callable[[Iteration], None] | None = None,
    throw: bool = True,
) -> LoadPath:
    """Return the states through which the structure goes from the permanent loads to collapse.

    The blocks are rigid and the joints slightly compliant. The first state is that of the permanent loads
    of least elastic energy; each implicit step pushes the blocks on by a prescribed work of the live load.
    At collapse the stresses stop changing, the compliance plays no part any more, and Eqs (54)-(59) hold.
    What is unique: every step, for the compliance given, but where the structure snaps (a step of kind
    "jump"). What is not: the permanent-load state without the compliance, and the collapse load itself.

    Parameters
    ----------
    model, dilatancy, turning, tolerance, progress, throw
        As for :func:`limitblocks.nonassociated`.
    start : Nonassociated, Bounds or array_like, shape (s,), optional
        State to start from, in place of that of the permanent loads; as for
        :func:`limitblocks.nonassociated`.
    stiffness : (float, float) or mapping from joints to (float, float), optional
        Normal and shear stiffness of the joints per area, N/m3. Their ratios influence the path; their size
        only the displacements. Without it both are one mean block weight per block length cubed, and
        displacements are relative.
    settings : Settings
        Size of the steps, and what is tried where one fails.

    Raises
    ------
    ModelError
        If a stiffness is not positive or a joint has none, the dilatancy is out of range, or `start` belongs
        to another model or is no state of it.
    NoEquilibrium
        If the dead loads alone cannot stand.
    NotConverged
        If the path ends above the tolerance; carries the collapse state.
    """
    slope, about = checked_dilatancy(model.problem, dilatancy), turning_of(turning)
    enclosing = bracket(model)
    problem = own_units(model, enclosing)
    flow = Flow(problem, slope, about)
    refuse_unlimited(flow, enclosing.associated)
    compliance = _compliance(model, problem, stiffness)
    softness = float(np.mean(compliance) / np.mean(problem.compliance))
    weights = compliance / softness  # the size of the steps must not depend on the size of the stiffness
    x0 = start_stresses(model, problem, weights, start)
    scale = load_scale(problem, enclosing.associated)
    history: list[Iteration] = []

    def record(stage: Stage) -> None:
        history.append(iteration(problem, stage))
        if progress is not None:
            progress(history[-1])

    found = stages(flow, x0, weights, tolerance, settings, scale, record)
    last = polish(flow, (found[-1] if found else initial(flow, x0)).state)
    end = Stage(last, evidence(flow, last), np.inf, "polish", 0, 0)
    how = "implicit steps of the load path"
    collapse = finished(model, last, enclosing, tuple(history), flow, how, tolerance, throw)
    return LoadPath(_steps(model, problem, x0, [*found, end], softness), collapse)


def initial(flow: Flow, x0: Array) -> Stage:
    """The permanent-load state as a stage: what is left to show where no step succeeds."""
    u, y = np.zeros(flow.problem.C.shape[1]), np.zeros(len(flow.problem.g))
    state = State(0.0, x0, u, y)
    return Stage(state, evidence(flow, state), np.inf, "step", 0, 0)


def iteration(problem: LimitProblem, stage: Stage) -> Iteration:
    """What a stage tells the user."""
    return Iteration(
        load_factor=stage.state.load_factor / problem.units.live,
        kind=stage.kind,
        step_size=1.0 / stage.rho,
        residuals=stage.residuals.to_dict(),
        inner=stage.inner,
        failures=stage.failures,
    )


def _compliance(
    model: Model, problem: LimitProblem, stiffness: Stiffness | Mapping[Joint, Stiffness] | None
) -> Array:
    """Dimensionless compliance of each generalised stress."""
    if stiffness is None:
        free = model.free_blocks
        unit = np.mean([b.weight for b in free]) / np.mean([np.cbrt(b.volume) for b in free]) ** 3
        stiffness = (float(unit), float(unit))
    table = (
        stiffness if isinstance(stiffness, Mapping) else {joint_of(i): stiffness for i in model.interfaces}
    )
    pairs = []
    for interface in model.interfaces:
        pair = table.get(joint_of(interface))
        if pair is None or np.shape(pair) != (2,) or not all(np.isfinite(k) and k > 0.0 for k in pair):
            raise ModelError(
                f"stiffness of {interface.joint!r} is {pair!r}, "
                "expected (normal, shear) in N/m3, both positive"
            )
        pairs.append(pair)
    force, length = _means(model.problem)
    unit = force / length**3
    normal, shear = np.array(pairs).T / unit
    per_resultant = np.stack([shear, shear, normal, normal, normal, shear], axis=1).ravel()
    B = abs(problem.resultants).tocoo()
    rows, columns = B.coords
    own = np.full(B.shape[1], -1)
    order = np.argsort(rows, kind="stable")[::-1]
    own[columns[order]] = rows[order]  # the first resultant that a stress feeds tells normal from shear
    return np.asarray(problem.compliance / per_resultant[own])


def _means(problem: LimitProblem) -> tuple[float, float]:
    """Mean units of force and length of the interfaces, in which compliances are near one."""
    return float(problem.units.interface_force.mean()), float(problem.units.interface_length.mean())


def _steps(
    model: Model, problem: LimitProblem, x0: Array, found: list[Stage], softness: float
) -> tuple[PathStep, ...]:
    """The permanent-load state and every stage, with displacements added up, `softness` times as large."""
    free = {block.name: k for k, block in enumerate(model.blocks)}
    places = [free[name] for name in problem.blocks]
    moved = np.zeros((len(model.blocks), 6))
    unit = np.prod(_means(model.problem)) / problem.units.loads
    first = {"equilibrium": 0.0, "yield": 0.0}
    steps = [_step(problem, 0.0, x0, moved, (), first, "permanent loads")]
    before: frozenset[tuple[str, str]] = frozenset()
    for stage in found:
        if stage.kind in ("step", "jump"):  # what follows changes the stresses at collapse, not the way to it
            moved = moved.copy()
            moved[places] += softness * (stage.state.u / stage.rho * unit).reshape(-1, 6)
        flowing = _flowing(problem, stage.state)
        state, residuals = stage.state, {name: stage.residuals[name] for name in first}
        new = tuple(sorted(flowing - before))
        steps.append(_step(problem, state.load_factor, state.x, moved, new, residuals, stage.kind))
        before = flowing
    return tuple(steps)


def _step(
    problem: LimitProblem,
    load_factor: float,
    x: Array,
    moved: Array,
    active: tuple[tuple[str, str], ...],
    residuals: dict[str, float],
    kind: str,
) -> PathStep:
    return PathStep(
        load_factor=load_factor / problem.units.live,
        stress_resultants=resultants_of(problem, x),
        displacements=read_only(moved),
        active=active,
        residuals=residuals,
        kind=kind,
    )


def _flowing(problem: LimitProblem, state: State) -> frozenset[tuple[str, str]]:
    """(interface, mode) of every row with a multiplier."""
    speed = np.abs(state.u / problem.units.loads).max()
    rates = np.abs(state.y) * problem.multiplier_units * problem.units.live
    rows = np.flatnonzero(rates > FLOWING * speed)
    return frozenset((problem.interfaces[problem.row_interface[r]], problem.row_mode[r]) for r in rows)
