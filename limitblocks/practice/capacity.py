"""The capacity curve: load factor against displacement of the mechanism without dilatancy, to zero."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Generator, Sequence
from typing import Any

import numpy as np

from limitblocks.analysis.nonassociated.loop import nonassociated
from limitblocks.arrays import Array, as_typed, read_only
from limitblocks.errors import ModelError, NoEquilibrium, SolveError
from limitblocks.evidence.results import Nonassociated
from limitblocks.joints.base import checked_count
from limitblocks.mechanics.loads.load import resultant
from limitblocks.model import Model, checked_model
from limitblocks.practice.advance import STILL, control_point, farthest, refuse_left_behind, stopped, velocity
from limitblocks.practice.capacity_result import CapacityCurve, CapacityPoint, Control, to_zero, zero_of
from limitblocks.practice.contact import CLOSED
from limitblocks.practice.displaced import Assembly, assembly_of, size_of
from limitblocks.practice.kept import gathered
from limitblocks.practice.snapped import NoRest, held
from limitblocks.practice.touching import answered, pressed_in

FIRST = 1e-3  # of the size of the structure: the first step
GROWTH = 10.0  # of a step over the one before where the load factor rises
MOST = 50  # points a step asked for: a curve that snaps on and on has no end, nor has one that creeps so long
ZERO = 1e-8  # of the first load factor: it counts as none
SECANT, HALVING = 0.98, 0.5  # of a step beyond the zero: the most of the next one, the least and those after
JUMP = 1e-6  # of the size of the structure: a step in which the load factor goes through zero
NEARLY = 1e-6  # the same where a step moves nothing any more
EVENT = 1e-4  # of the size of the structure: a step in which it snaps, or to a zero that is not answered
SMALL = 1e-2  # of the first load factor: the most that is left at a zero that is not answered
SHORT = 0.99  # of the step to a zero that is not answered: the dead loads alone are at their limit there
SMALLEST = 0.1  # of the last step, to the zero: the same where it is shorter still


def capacity_curve(
    model: Model,
    *,
    control: tuple[str, Sequence[float]] | None = None,
    steps: int = 20,
    largest: float = np.inf,
    progress: Callable[[CapacityPoint], None] | None = None,
) -> CapacityCurve:
    """Return the load factor against the displacement of the mechanism, until it is zero.

    At each point the non-associated answer of the displaced structure is computed and checked; its mechanism
    moves the blocks by finite screws, and the contacts that it does not open are brought together again.
    An interface that has opened turns about the corners that are closed, its normal that of the face on which
    they rest, half way between both where edges meet; faces that slide flat on one another get the area that
    they then share. A joint that has opened or slid has no cohesion and no tensile strength any more.

    Parameters
    ----------
    model : Model
        Loads may be mass-proportional, added masses, forces and moments on blocks: they move with the
        blocks, and keep their directions.
    control : (str, sequence of float), optional
        Block and point (m) whose displacement along the live load is measured. Default: of the block that
        moves fastest along it, of several the highest (Z is up), the foremost of the highest corners, or the
        middle of several: on a wall that of the outer face, whose displacement at zero is the least.
    steps : int
        Points to the zero that the slope of the curve foretells. Between two of them the mechanism of the
        first is followed: more steps see sooner where another takes over.
    largest : float
        Displacement at which the curve ends, m.
    progress : callable, optional
        Called with each point.

    Raises
    ------
    ModelError
        If a load or passive fill stays behind as its block moves, the control point does not move along the
        live load, or a number is out of range.
    SolveError
        As :func:`~limitblocks.nonassociated` at the first point; later the curve ends, and says why.
    """
    checked_model(model)
    checked_count("steps", steps, 2)
    farthest(largest, "displacement")
    refuse_left_behind("capacity curve", model, ("dead", "live"))
    first = nonassociated(model)
    point = _control(model, first, control)
    points, ended = gathered(_curve(model, first, point, steps, largest), progress)
    points = points or [CapacityPoint(0.0, first.load_factor, 0.0, model, first, ())]
    zero = None if ended else zero_of(points)
    return CapacityCurve(tuple(points), point, zero, ended or f"load factor zero at {zero:.6g} m")


def _curve(
    model: Model, first: Nonassociated, control: Control, steps: int, largest: float
) -> Generator[CapacityPoint, None, str | None]:
    """Yield the points of the curve; return why it ends unless at zero."""
    assembly, scale = assembly_of(model), first.load_factor
    assembly = pressed_in(assembly, list(range(len(model.interfaces))), first.stress_resultants)
    whole, point = assembly.size, CapacityPoint(0.0, scale, 0.0, model, first, ())
    before: CapacityPoint | None = None
    behind: deque[CapacityPoint] = deque(maxlen=MOST)
    for _ in range(MOST * steps):
        yield point
        if len(behind) == MOST and _creeps(behind[0], point, EVENT * assembly.size, SMALL * scale):
            return f"{MOST} points lead from {behind[0].displacement:.6g} to {point.displacement:.6g} m only"
        behind.append(point)
        still = before is not None and abs(point.displacement - before.displacement) <= CLOSED * assembly.size
        if point.load_factor <= (NEARLY if still else ZERO) * scale:
            return None  # below it where it jumps through zero
        if point.displacement >= largest - CLOSED * whole:  # what is left moves nothing
            return f"the displacement {largest:g} m is reached"
        if not (pace := _pace(assembly.model, control, point.result.displacement_rates)) > STILL:
            return (
                f"the control point of block {control.block!r} moves along the live load no more at "
                f"{point.displacement:.6g} m; take one that goes on with the mechanism"
            )
        # no block moves farther than that, however slow the control point is
        next_step = min(_next_step(assembly, before, point, steps), whole / steps * min(pace, 1.0))
        step = min(next_step, largest - point.displacement)
        found = _ahead(assembly, control, point, step, scale, to_zero(before, point))
        small = point.load_factor <= SMALL * scale and to_zero(before, point) <= EVENT * assembly.size
        if isinstance(found, str) and small:
            return None  # it ends at the last checked point, on the safe side of the zero
        if isinstance(found, str) or still:
            return found if isinstance(found, str) else stopped(point.displacement)
        before, (assembly, control, point) = point, found
    return f"{MOST * steps} points do not lead to an end"


def _creeps(start: CapacityPoint, end: CapacityPoint, way: float, fall: float) -> bool:
    """Whether the curve goes less than a `way`, m, and its load factor falls by less than that."""
    moved, fell = end.displacement - start.displacement, end.load_factor - start.load_factor
    return abs(moved) < way and abs(fell) < fall


def _ahead(
    assembly: Assembly, control: Control, point: CapacityPoint, step: float, scale: float, ahead: float
) -> tuple[Assembly, Control, CapacityPoint] | str:
    """The structure one step on, no farther than to where its load factor is zero; or why there is none.

    The secant is zero `ahead`, m.
    """
    share = SHORT if step <= JUMP * assembly.size else SMALLEST
    most, least = SECANT, min(EVENT * assembly.size, share * step)
    while True:
        try:
            found = _advanced(assembly, control, point, step)
        except SolveError as error:
            step *= SHORT if step == ahead else 0.5
            if step < least or isinstance(error, NoRest):
                why = error.said if isinstance(error, NoEquilibrium) else error
                return f"no checked answer beyond {point.displacement:.6g} m: {why}"
            continue
        if found is None:
            return stopped(point.displacement)
        way, left = found[2].displacement - point.displacement, found[2].load_factor
        beyond = -to_zero(point, found[2]) if way > 0.0 else abs(way)  # the zero lies as far behind
        if left >= -ZERO * scale or min(abs(way), beyond) <= JUMP * assembly.size or found[2].snapped:
            return found
        part = max(HALVING, min(most, point.load_factor / (point.load_factor - left)))
        step, most = part * (way if way > 0.0 else step), HALVING


def _next_step(assembly: Assembly, before: CapacityPoint | None, point: CapacityPoint, steps: int) -> float:
    """A step of the curve, or the secant step to its zero once that is near; m, of the control point."""
    if before is None or point.snapped:
        return FIRST * assembly.size
    last_step, ahead = abs(point.displacement - before.displacement), to_zero(before, point)
    if ahead == np.inf:  # it may rise at first
        return GROWTH * last_step
    whole = (point.displacement + ahead) / steps
    return ahead if ahead <= 1.5 * whole or ahead <= last_step else whole


def _advanced(
    assembly: Assembly, control: Control, point: CapacityPoint, step: float
) -> tuple[Assembly, Control, CapacityPoint] | None:
    """The structure one step on and its point; None where contacts allow no step."""
    there = held(assembly, control, point.result.displacement_rates, step, EVENT * assembly.size)
    if there is None:
        return None
    way = float((there.control.point - control.point) @ control.direction)
    if way < -EVENT * assembly.size and not there.snapped:
        raise SolveError("its contacts come together only where the mechanism came from")
    at = point.displacement + way
    goal, shift, loaded, result, pressed = answered(there.assembly)
    found = CapacityPoint(
        at, result.load_factor - shift, shift, loaded, result, there.changes, pressed, there.snapped
    )
    return goal, there.control, found


def _control(model: Model, result: Nonassociated, given: Any) -> Control:
    """The point whose displacement is measured, along the sum of the live load."""
    push = resultant(model.live, model.free_blocks)
    if not np.linalg.norm(push) > 0.0:
        raise ModelError("the live loads add up to no force; a capacity curve needs a direction")
    direction = read_only(push / np.linalg.norm(push))
    rates = result.displacement_rates
    if given is None:
        speeds, tops = rates[:, :3] @ direction, np.array([b.vertices[:, 2].max() for b in model.blocks])
        tops[speeds < (1.0 - STILL) * speeds.max()] = -np.inf  # of blocks that move as one, the highest
        block = model.blocks[int((tops >= tops.max() - CLOSED * size_of(model)).argmax())]
        point = block.vertices
        for way in (np.array([0.0, 0.0, 1.0]), direction):
            ahead = point @ way
            point = point[ahead >= ahead.max() - CLOSED * block.size]
        point = point.mean(axis=0)  # which corner is the foremost may be a matter of rounding
    else:
        if not isinstance(given, tuple | list) or len(given) != 2 or not isinstance(given[0], str):
            raise ModelError(
                f"control is {as_typed(given)}, expected a block and a point, ('wall', (0.5, 0, 5))"
            )
        block, point = control_point(model, *given)
    control = Control(block.name, read_only(point), direction)
    if not _pace(model, control, rates) > STILL:
        raise ModelError(
            f"the control point of block {block.name!r} does not move along the live load; choose a block "
            "and a point of it that do"
        )
    return control


def _pace(model: Model, control: Control, rates: Array) -> float:
    """Speed of the control point along the live load over the largest of a centroid."""
    return float(
        velocity(model, control, rates) @ control.direction / np.linalg.norm(rates[:, :3], axis=1).max()
    )
