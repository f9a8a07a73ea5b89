"""The load path: states from the permanent loads to collapse, each in equilibrium and within yield."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Literal

import numpy as np

from limitblocks.analysis.nonassociated.finished import finished, tell_end
from limitblocks.analysis.nonassociated.in_the_plane import by_self_stress, flow_in_plane
from limitblocks.analysis.nonassociated.loaded import AT_ONCE, Loaded, at_once, lifted, loaded
from limitblocks.analysis.nonassociated.loading import CLIMBS, Pushed
from limitblocks.analysis.nonassociated.loop import end_of_first_path
from limitblocks.analysis.nonassociated.path_record import recorder
from limitblocks.analysis.nonassociated.path_steps import Told, told
from limitblocks.analysis.nonassociated.settings import Settings
from limitblocks.analysis.nonassociated.start import (
    Start,
    flow_of,
    load_scale,
    refuse_jammed,
    refuse_unlimited,
    start_stresses,
)
from limitblocks.analysis.one_thread import one_thread
from limitblocks.arrays import Array, real
from limitblocks.errors import ModelError, UnlimitedLoad, refuse_kind
from limitblocks.evidence.ending import Status
from limitblocks.evidence.load_path_result import LoadPath, compared
from limitblocks.evidence.residuals import TOLERANCE
from limitblocks.evidence.results import Iteration
from limitblocks.joints.base import Joint, joint_of
from limitblocks.mechanics.loads.load import number
from limitblocks.model import Model
from limitblocks.problem import Flow, LimitProblem, Turning
from limitblocks.problem.plane import Choice

ROUNDED = (
    "a snap could be followed with the barrier of the increments only, which rounds it: the load factor "
    "before it is low by some percent"
)
PASSED_OVER = (
    "a snap was passed over: from one step to the next the load factor falls from {:.6g} to {:.6g}, and may "
    "have been higher before; a smaller barrier, such as Settings(barrier=1e-6) of limitblocks.settings, may "
    "follow it"
)
NOT_COMPARED = "the tracked path of nonassociated was stopped by the user: nothing to compare this end with"
NO_END = "the user stopped this path: no end of it to compare with that of the tracked path of nonassociated"

Snaps = Literal["across", "along"]
Stiffness = tuple[float, float]  # normal and shear, N/m3


@one_thread
def load_path(
    model: Model,
    *,
    dilatancy: float = 0.0,
    turning: Turning | str = Turning.CENTROID,
    tolerance: float = TOLERANCE,
    start: Start | None = None,
    stiffness: Stiffness | Mapping[Joint, Stiffness] | None = None,
    snaps: Snaps = "across",
    settings: Settings | None = None,
    progress: Callable[[Iteration], None] | None = None,
    throw: bool = True,
) -> LoadPath:
    """Return the states through which the structure goes from the permanent loads to collapse.

    The blocks are rigid and the joints slightly compliant. The first state is what joints bear once the
    permanent loads are put on unstressed blocks; increments of the displacement on which the live load works
    follow, each from the stresses that the one before left, with slip and opening that do not go back. Each
    is followed by arclength: where the displacement has to fall before it can grow again the structure snaps.
    At collapse the stresses stop changing, the compliance plays no part any more, and Eqs (54)-(59) hold.
    Where increments end before, one push without end leads on from the last; `remarks` say so.
    What is unique: the way, for the compliance and the increments given. What is not: the permanent-load
    state without the compliance, and the collapse load itself.

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
    snaps : {"across", "along"}
        What the steps show of a snap: "across" its two ends, as a slow experiment under control of the
        displacement would, "along" the unstable states between them, too.
    settings : Settings, optional
        Size of the increments.

    Raises
    ------
    ModelError
        If a stiffness is not positive or a joint has none, `snaps` is unknown, the dilatancy is out of
        range, or `start` belongs to another model or is no state of it.
    NoEquilibrium
        If the dead loads alone cannot stand.
    UnlimitedLoad
        If the flow is associated everywhere, or normal forces alone balance the live load, and it can grow
        without limit; or if the increments climb without limit.
    NotConverged
        If the path ends above the tolerance, the push without end farther than 10 % from the increments, or
        the user interrupts it; carries the last state.
    """
    if snaps not in ("across", "along"):
        raise ModelError(f"snaps is {snaps!r}, expected 'across' or 'along'")
    number(tolerance, "tolerance", "", above=0.0)
    refuse_kind(settings or Settings(), Settings, "settings")
    flow, enclosing = flow_of(model, dilatancy, turning)
    problem = flow.problem
    refuse_jammed(enclosing)
    refuse_unlimited(flow, enclosing.associated)
    compliance = _compliance_of(model, problem, stiffness)
    softness = float(np.mean(compliance) / np.mean(problem.compliance))
    weights = compliance / softness  # the size of the steps must not depend on the size of the stiffness
    history, record = recorder(progress)

    def load(at: Flow, x0: Array, own: Array) -> Loaded:
        scale = load_scale(at.problem, enclosing.associated)
        share = 1.0 if at is flow or planar is None else planar.share
        return loaded(at, x0, own, tolerance, settings or Settings(), scale, record, share)

    planar = flow_in_plane(model, flow, weights, start, Choice.EVERY)
    found = at_once(model, flow, enclosing, weights, tolerance) if start is None else None
    if found is None and planar:
        found = lifted(planar, load(planar.flow, planar.x0, planar.weights), tolerance)
    found = found or load(flow, start_stresses(model, flow, weights, start), weights)
    if found.why == CLIMBS:
        raise UnlimitedLoad(CLIMBS)
    tell_end(flow, found.last, record)
    said = by_self_stress(model, flow, weights) if start is None and found.how != AT_ONCE else ()
    said = (*said, *(found.why,) * found.beyond)
    collapse = finished(
        model,
        found.last,
        enclosing,
        tuple(history),
        flow,
        found.how,
        tolerance,
        throw,
        why=found.why,
        said=said,
    )
    told_by = Told(softness * _displacement_units(model, problem), snaps)
    steps, folds, trace = told(model, flow, found.x0, found.pushes, found.last, told_by)
    remarks = (
        *_of_snaps(found.pushes, steps[0].load_factor, problem.units.live),
        *(found.why,) * bool(found.why),
    )
    if found.how == AT_ONCE:
        return LoadPath(steps, collapse, folds, trace, collapse.load_factor, remarks)
    if collapse.status is Status.INTERRUPTED:  # who stops the load path waits for no other
        return LoadPath(steps, collapse, folds, trace, np.nan, (NO_END, *remarks))
    try:
        tracked = end_of_first_path(model, flow, enclosing.associated, start, tolerance)
    except KeyboardInterrupt:  # the load path is complete
        return LoadPath(steps, collapse, folds, trace, np.nan, (NOT_COMPARED, *remarks))
    remarks = (*compared(collapse.load_factor, tracked, collapse.accepted), *remarks)
    return LoadPath(steps, collapse, folds, trace, tracked, remarks)


def _of_snaps(pushes: tuple[Pushed, ...], begin: float, unit: float) -> Iterator[str]:
    """What is said of snaps that were rounded or passed over; the path begins at the load factor `begin`.

    `unit` is that of the live load.
    """
    if any(one.increment.rounded and one.increment.folds for one in pushes):
        yield ROUNDED
    starts = (begin * unit, *(one.state.load_factor for one in pushes))
    falls = [
        (before, one.state.load_factor)
        for before, one in zip(starts, pushes, strict=False)
        if one.increment.rounded and not one.increment.folds
    ]
    if falls:
        before, after = max(falls, key=lambda fall: fall[0] - fall[1])
        yield PASSED_OVER.format(before / unit, after / unit)


def _compliance_of(
    model: Model, problem: LimitProblem, stiffness: Stiffness | Mapping[Joint, Stiffness] | None
) -> Array:
    """Dimensionless compliance of each generalised stress."""
    if stiffness is None:
        free = model.free_blocks
        weight = np.mean([b.volume * (b.unit_weight or 0.0) for b in free]) or np.mean(
            model.problem.units.block_force
        )
        unit = weight / np.mean([np.cbrt(b.volume) for b in free]) ** 3
        stiffness = (float(unit), float(unit))
    table = (
        stiffness if isinstance(stiffness, Mapping) else {joint_of(i): stiffness for i in model.interfaces}
    )
    pairs = []
    for interface in model.interfaces:
        pair = table.get(joint_of(interface))
        if pair is None or np.shape(pair) != (2,) or not all(0.0 < real(k) < np.inf for k in pair):
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


def _displacement_units(model: Model, problem: LimitProblem) -> Array:
    """Displacements of the free blocks (6 n,), m and rad, over dimensionless ones, for softness one."""
    return np.asarray(np.prod(_means(model.problem)) / problem.units.loads)
