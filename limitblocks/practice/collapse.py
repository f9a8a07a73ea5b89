"""Supports that settle by as much as the structure bears: reaction against settlement, and the fall."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from limitblocks.arrays import Array
from limitblocks.errors import NoEquilibrium, SolveError
from limitblocks.mechanics.loads.load import number
from limitblocks.model import Model, checked_model
from limitblocks.practice.advance import Advanced, advanced, farthest, refuse_left_behind, shut, stopped
from limitblocks.practice.capacity_result import Control
from limitblocks.practice.collapse_result import SettlementCurve, SettlementPoint
from limitblocks.practice.contact import CLOSED
from limitblocks.practice.displaced import Assembly, assembly_of
from limitblocks.practice.kept import gathered, solved
from limitblocks.practice.rejoined import joined
from limitblocks.practice.settlement import Settlement, settlement
from limitblocks.practice.settling import settling
from limitblocks.practice.touching import across

STEP = 0.01  # of the size of the structure: the largest step
FIRST = 1e-3  # the same: the first one
GROWTH = 4.0  # of a step over the one before
ACCURACY = 1e-6  # of the size of the structure: the interval in which it falls


def settlement_to_collapse(
    model: Model,
    support: str | Sequence[str],
    direction: Sequence[float],
    *,
    without_dilatancy: bool = True,
    step: float | None = None,
    largest: float = np.inf,
    accuracy: float | None = None,
    progress: Callable[[SettlementPoint], None] | None = None,
) -> SettlementCurve:
    """Return the reaction of a support, or several, that moves along `direction` until the structure falls.

    At each point the least reaction of the displaced structure is found as by
    :func:`~limitblocks.practice.settlement`, from its permanent loads; the mechanism that follows the support
    moves the blocks by finite screws, and the contacts that it does not open are brought together again.
    So are those that then press across a gap, where the structure stands without it.
    Where a step leads to a structure that cannot stand on supports at rest, it is halved, until the interval
    in which it falls is as short as `accuracy`.

    Parameters
    ----------
    model : Model
        Its live load is not used. Dead loads may be weights, added masses, forces and moments on blocks: they
        move with the blocks, and keep their directions.
    support : str or sequence of str
        Name of the support that moves, or names of those that do, as one body.
    direction : sequence of float
        Of the motion; any length.
    without_dilatancy : bool
        Whether blocks move by the mechanism without dilatancy, or by that of associated flow.
    step : float, optional
        Largest step, m. Default: .01 of the size of the structure.
    largest : float
        Settlement at which the curve ends, m; at most the size of the structure, which is the largest
        distance of two of its vertices.
    accuracy : float, optional
        Of the settlement at collapse, m. Default: 1e-6 of the size of the structure.
    progress : callable, optional
        Called with each point.

    Raises
    ------
    ModelError
        If a load or passive fill stays behind as its block moves, or as
        :func:`~limitblocks.practice.settlement`.
    SolveError
        As :func:`~limitblocks.practice.settlement` at the first point; later the curve ends, and says why.
    """
    checked_model(model)
    refuse_left_behind("settlement until collapse", model, ("dead",))
    assembly = assembly_of(model)
    size = assembly.size
    step = number(STEP * size if step is None else step, "step", "m", above=0.0)
    accuracy = number(ACCURACY * size if accuracy is None else accuracy, "accuracy", "m", above=0.0)
    largest = farthest(largest, "settlement")
    own = settling(model, support, direction)
    unit, first = own.direction, own.supports[0]
    place = next(block for block in model.blocks if block.name == first).centroid
    control = Control(first, place, unit)

    def found(there: Assembly) -> Settlement:
        now = joined(there, there.contacts[there.tight])
        answer = partial(settlement, now, own.supports, unit.tolist(), without_dilatancy=without_dilatancy)
        return replace(solved(answer), digest=model.digest)

    begin = SettlementPoint(0.0, found(assembly), ())
    lengths = min(step, FIRST * size), step, accuracy, largest
    points, end = gathered(_way(assembly, control, begin, found, lengths), progress)
    falls, ended = (None, end) if isinstance(end, str) else end
    return SettlementCurve(tuple(points or [begin]), falls, ended)


def _way(
    assembly: Assembly,
    control: Control,
    point: SettlementPoint,
    found: Callable[[Assembly], Settlement],
    lengths: tuple[float, float, float, float],
) -> Generator[SettlementPoint, None, tuple[float | None, str]]:
    """Yield the points; return the settlement at which it falls, or None, and why the way ends."""
    step, longest, accuracy, largest = lengths
    falls: float | None = None
    end = min(largest, whole := assembly.size)
    while True:
        yield point
        if point.displacement >= end * (1.0 - 1e-12):
            size = "" if largest <= whole else ", the size of the structure,"
            return None, f"the settlement {end:g} m{size} is reached"
        if not (point.reaction > CLOSED * point.found.settling.unit or _bears(assembly, point.found)):
            return None, f"nothing rests on what settles any more at {point.displacement:.6g} m"
        while True:
            step = min(step, end - point.displacement)
            at = point.displacement + step
            try:
                there = advanced(assembly, control, _rates(point.found), step)
                if there is None:
                    return None, stopped(point.displacement)
                at = point.displacement + float((there.control.point - control.point) @ control.direction)
                answer, why = found(there.assembly), ""
                break
            except NoEquilibrium:
                falls, why = at, f"the structure falls between {point.displacement:.9g} and {at:.9g} m"
            except SolveError as error:
                until = "" if falls is None else f" until it falls at {falls:.9g} m"
                why = f"no checked answer beyond {point.displacement:.6g} m{until}: {error}"
            if at - point.displacement <= accuracy:
                return falls, why
            step = (at - point.displacement) / 2.0
        there, point = _settled(there, at, answer, found)
        assembly, control = there.assembly, there.control
        if falls is not None and falls - at < accuracy:
            falls = None  # it stands as near: it was the length of the step that fell
        step = min(GROWTH * step, longest) if falls is None else (falls - at) / 2.0


def _bears(assembly: Assembly, found: Settlement) -> bool:
    """Whether blocks press what settles, across its way if not along it: a beam on one that slides away."""
    moving = found.settling.supports
    forces = (found.result or found.bounds).stress_resultants
    resultant = np.zeros(3)
    tight = assembly.contacts[assembly.tight].interfaces
    for own, force in zip(tight, forces, strict=False):  # guides come last
        sign = (own.block_i in moving) - (own.block_j in moving)
        resultant += sign * force[:3] @ own.axes
    return float(np.linalg.norm(resultant)) > CLOSED * found.settling.unit


def _settled(
    there: Advanced, at: float, answer: Settlement, found: Callable[[Assembly], Settlement]
) -> tuple[Advanced, SettlementPoint]:
    """The point after a step; joints that press across a gap are closed where it then stands without any.

    Of several mechanisms at one reaction a step may be one that opens joints on which it cannot stand.
    """
    pressed = _across(there, answer)
    point = SettlementPoint(at, answer, there.changes, tuple(pressed.values()))
    closed = shut(there, pressed) if pressed else None
    if closed is None:
        return there, point
    try:
        again = found(closed.assembly)
    except SolveError:
        return there, point
    if _across(closed, again):
        return there, point
    return closed, SettlementPoint(at, again, closed.changes)


def _across(there: Advanced, answer: Settlement) -> dict[int, str]:
    end = answer.result or answer.bounds
    tight = there.assembly.tight
    return across(there.assembly, end.stress_resultants[: len(tight)], tight)  # without those of guides


def _rates(found: Settlement) -> Array:
    """Mechanism that follows the support."""
    return (found.result or found.bounds).displacement_rates
