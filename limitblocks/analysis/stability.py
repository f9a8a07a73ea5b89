"""Does it stand under its dead loads: with a margin, only by self-stress, or not at all."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import product

import numpy as np
from scipy import sparse

from limitblocks.analysis.falling import Fall, falling
from limitblocks.analysis.forms import Stresses
from limitblocks.analysis.in_plane import in_plane
from limitblocks.analysis.in_si import in_model_order, resultants_of
from limitblocks.analysis.one_thread import one_thread
from limitblocks.analysis.programs import ROUNDS, solved, solvers
from limitblocks.analysis.scales import Scaled, balanced, scaled, unmoved, unpressed
from limitblocks.analysis.unstressed import joint_compliance, may_arise, not_held
from limitblocks.arrays import Array, Indices, read_only
from limitblocks.errors import ModelError, NoEquilibrium, SolverFailure
from limitblocks.evidence.crushing import ALONE, beyond_stress_block
from limitblocks.evidence.residuals import TOLERANCE, Residual, Residuals, nearest, static_residuals
from limitblocks.evidence.stability_result import TOLERANCE as ARISEN
from limitblocks.evidence.stability_result import Stability, Standing, arising_residuals, mechanism_residuals
from limitblocks.known import known
from limitblocks.model import Model
from limitblocks.problem import ASSOCIATED, Flow, LimitProblem, Mode
from limitblocks.problem.plane import Choice

MOST = 1.0  # of the force of each interface: a structure that can be wedged at will has no largest margin
UNDECIDED = (
    "stresses that carry the dead loads exist, but whether they arise by themselves is undecided: {}; "
    "docs/stability.md has what helps"
)
WEDGED = 1e4  # mean of the rows in their units: a self-stress without bounds leaves no digits to the loads


@one_thread
def stability(model: Model) -> Stability:
    """Say whether the structure stands under its dead loads alone, with the states that prove it.

    Stresses within the yield surface that carry the dead loads are found as far within it as they can be, or
    a mechanism proves that there are none (static and kinematic theorem). Where they exist, the dead loads
    are put on unstressed blocks with slightly compliant joints and zero dilatancy: only if that brings
    about such stresses does the structure stand by itself.

    Parameters
    ----------
    model : Model
        The structure; its live load is of no account.

    Raises
    ------
    ModelError
        If there is no dead load.
    SolverFailure
        If nothing is proven.
    """
    problem = model.problem
    if not problem.dead.any():
        raise ModelError("no dead load acts on a free block: whether it stands under none is no question")
    try:
        x = dead_load_state(problem)
    except NoEquilibrium:
        fall = falling(Flow(problem, ASSOCIATED), problem.dead)
        assert fall  # it was just found
        return _answer(model, Standing.FALLS, standing_margin(model), fall=fall)
    margin = min(MOST, max(0.0, _margin(problem, x)))  # it is, to rounding
    flow, weights = Flow(problem), joint_compliance(problem)
    for own in may_arise(flow, weights):
        entries = arising_residuals(flow, weights, own)
        if Residuals(entries).worst.value <= ARISEN:
            return _answer(model, Standing.STANDS, margin, x, own.x, entries)
    fall = _slides_through(problem, weights)
    return _answer(model, Standing.SELF_STRESS, margin, x, fall=fall)


def _slides_through(problem: LimitProblem, weights: Array) -> Fall:
    """Mechanism of the blocks that friction does not hold where nobody wedges them; SolverFailure if none."""
    moving = not_held(problem, weights)
    if moving is None or not moving.any():
        raise SolverFailure(UNDECIDED.format("neither such that do nor blocks that slide through were found"))
    free = sparse.diags_array(np.repeat(1.0 * moving, 6))
    alone = replace(problem, C=sparse.csr_array(problem.C @ free), dead=np.asarray(free @ problem.dead))
    fall = falling(Flow(alone), alone.dead)
    if fall is None:
        raise SolverFailure(
            UNDECIDED.format("blocks that nobody wedges move, but no mechanism of them was found")
        )
    return fall


def _answer(
    model: Model,
    kind: Standing,
    margin: float,
    x: Array | None = None,
    arisen: Array | None = None,
    entries: tuple[Residual, ...] = (),
    fall: Fall | None = None,
) -> Stability:
    """The result, with the residuals of the states it has."""
    problem = model.problem
    static = () if x is None else static_residuals(problem, 0.0, x)
    moved = mechanism_residuals(fall.flow, fall.loads, fall.state) if fall else ()
    return Stability(
        kind=kind,
        margin=margin,
        blocks=fall.blocks if fall else (),
        stress_resultants=None if x is None else resultants_of(problem, x),
        generalised_stresses=None if x is None else read_only(x * problem.stress_units),
        arising=None if arisen is None else resultants_of(problem, arisen),
        displacement_rates=in_model_order(model, fall.rates) if fall else None,
        residuals=Residuals((*static, *entries, *moved)),
        digest=model.digest,
        remarks=() if x is None else beyond_stress_block(model, resultants_of(problem, x), ALONE),
    )


@one_thread
def standing_margin(model: Model, load_factor: float = 0.0) -> float:
    """Return the largest least distance to yield of all states in equilibrium, over the interfaces' forces.

    Over all stresses in equilibrium with dead + load_factor live, the largest t <= 1 by which each yield
    function can be lowered, that of Eq. (39) too, every interface in the largest dead force on a block that
    it is tied to. A state within the yield surface exists, and the loads stand (static theorem), exactly
    where t >= 0; below, -t is how much every yield function would have to be widened: what a root finder
    needs, and yes and no do not give.
    Joints without friction carry no shear; where no stresses at all balance the loads, the margin is -1.

    Parameters
    ----------
    model : Model
        The structure.
    load_factor : float
        Of the live load.

    Raises
    ------
    SolverFailure
        If no solver finds a state whose recomputed equilibrium residual is within 1e-8.
    """
    return remarked_margin(model, load_factor)[0]


def remarked_margin(model: Model, load_factor: float) -> tuple[float, tuple[str, ...]]:
    """Return the margin of :func:`standing_margin`, and what to know of its stresses."""
    problem = model.problem
    tried: list[Residual] = []
    for x, worst in _all_states(problem, load_factor * problem.units.live):
        if worst.value <= TOLERANCE or worst.name == "yield":
            stresses = resultants_of(problem, x)
            return min(MOST, _margin(problem, x)), beyond_stress_block(model, stresses, ALONE)
        tried.append(worst)
    if falls(problem, problem.dead + load_factor * problem.units.live * problem.live):
        return -MOST, ()
    raise SolverFailure(f"how safely the loads stand is undecided: {nearest(tried, 'state')}")


def dead_load_state(problem: LimitProblem) -> Array:
    """Return stresses that carry the dead loads alone, as far within yield as they can be.

    Raises
    ------
    NoEquilibrium
        If a mechanism proves that they fall; it names the blocks.
    SolverFailure
        If neither is proven.
    """
    return known(problem, "dead-load state", lambda: _dead_load_state(problem))


def _dead_load_state(problem: LimitProblem) -> Array:
    tried: list[Residual] = []
    for x, worst in _all_states(problem, 0.0):
        if worst.value <= TOLERANCE:
            return read_only(x)
        # one mechanism proves what all the other states would only suggest
        if not tried and (fallen := falls(problem, problem.dead)):
            raise NoEquilibrium(fallen, problem.left_out)
        tried.append(worst)
    raise SolverFailure(f"whether the dead loads stand is undecided: {nearest(tried, 'state')}")


def _all_states(problem: LimitProblem, load_factor: float) -> Iterator[tuple[Array, Residual]]:
    """States of largest margin found in the plane, judged in the whole problem, and then of the whole."""
    plane, lowered = in_plane(problem, Choice.EVERY), _lowered(problem)
    if plane is not None:
        for own, _ in _states(plane.problem, load_factor, plane.multipliers.T @ lowered):
            x = plane.stresses @ own
            yield x, Residuals(static_residuals(problem, load_factor, x)).worst
    yield from _states(problem, load_factor, lowered)


def _states(problem: LimitProblem, load_factor: float, lowered: Array) -> Iterator[tuple[Array, Residual]]:
    """States of largest margin of one solver after the other, with the worst of their residuals.

    Each is found again in the units of the one before. The margin as it is defined comes first, in the forces
    of :func:`_own_loads`, then that in the force of each interface: where weights are decades apart solvers
    find it more easily, as they do stresses without a bound.
    """
    ways = list(product(solvers(bool(problem.cones.second_order)), (np.inf, WEDGED)))
    for k, (solver, most) in enumerate([ways[0], *ways]):
        measured: Scaled | None = scaled(problem)
        for _ in range(ROUNDS):
            if measured is None:
                break
            loads = (problem.dead + load_factor * problem.live) / measured.equation
            force = _own_loads(problem) if k == 0 else measured.force
            room = lowered * force[problem.row_interface] / measured.row
            (v,) = solved(Stresses(measured).within(loads, most, room), solver).values
            x, found = v[1:], np.isfinite(v).all()
            own = measured.stress * (balanced(measured, loads, x) if found else x)
            yield own, Residuals(static_residuals(problem, load_factor, own)).worst
            if found and (bare := unpressed(measured, loads, x)) is not None:
                bare = measured.stress * bare
                yield bare, Residuals(static_residuals(problem, load_factor, bare)).worst
            measured = measured.measured(unmoved(problem, load_factor, own)) if found else None


def _own_loads(problem: LimitProblem) -> Array:
    """Largest dead force on a block that an interface is tied to, in its unit of force, shape (m,)."""
    force = problem.units.block_force
    loads = np.linalg.norm(problem.dead.reshape(-1, 6)[:, :3], axis=1) * force  # moments hang on a length
    largest = np.zeros_like(force)
    np.maximum.at(largest, problem.parts, loads)
    own = largest[problem.parts][problem.ends.max(axis=1)]
    return np.asarray(np.where(own > 0.0, own / problem.units.interface_force, 1.0))


def _crushing(problem: LimitProblem) -> Indices:
    """First rows of the cones ||(1 - s, 2 N / sqrt(a))|| <= 1 + s of Eq. (39)."""
    heads = problem.cones.heads
    return np.asarray(heads[problem.row_mode[heads] == Mode.CRUSH])


def _lowered(problem: LimitProblem) -> Array:
    """What rows lose as the yield functions of each interface are lowered by its unit of force, (R,)."""
    lost = problem.cones.identity.copy()
    lost[_crushing(problem) + 1] = -1.0  # s, not 1 + s alone: the 1 is an arbitrary unit
    return np.asarray(lost / problem.units.row)


def _margin(problem: LimitProblem, x: Array) -> float:
    """Least distance to yield over the largest dead force on the blocks tied to the interface."""
    rows, cones, heads = problem.F @ x + problem.g, problem.cones, _crushing(problem)
    first, second, across = (rows[heads + k] for k in range(3))
    distance = cones.margin(rows)
    distance[cones.member[heads]] = (first - second - across**2 / (first + second)) / 2.0  # s - N^2 / a
    distance *= problem.units.row[cones.heads]
    return float((distance / _own_loads(problem)[problem.member_interface]).min())


def falls(problem: LimitProblem, loads: Array) -> tuple[str, ...]:
    """Return the blocks that move in a mechanism which proves that the loads fall; none where none does."""
    fall = falling(Flow(problem, ASSOCIATED), loads)
    return fall.blocks if fall else ()
