"""How the load factor changes with the data of a model: derivatives without solving again.

The load factor a is a stationary value of the Lagrangian of the static theorem,

    L = a + u.(C^T x - dead - a live) + y.(F x + g),

in which the displacement rates u, of unit live power, and the flow multipliers y are the mechanism. Its
derivative by a datum p is therefore that of L with the state held fixed, da/dp = dL/dp (envelope theorem;
Milgrom & Segal 2002, Econometrica 70): what changes is the assembly of C, F, g and the loads alone.
"""

from __future__ import annotations

from dataclasses import fields, is_dataclass, replace

import numpy as np
import numpy.typing as npt
from scipy import sparse

from limitblocks.analysis.one_thread import one_thread
from limitblocks.analysis.shape import Field, carried_over, moved
from limitblocks.analysis.unique import Yielding
from limitblocks.arrays import Array, read_only
from limitblocks.errors import refuse_kind
from limitblocks.evidence.associated import Bounds
from limitblocks.evidence.determined import determined
from limitblocks.evidence.sensitivity_result import LoadPosition, Sensitivities
from limitblocks.geometry import Interface
from limitblocks.joints.base import joint_of
from limitblocks.mechanics.loads.load import number
from limitblocks.model import Model, refuse_other
from limitblocks.problem import LimitProblem, State

STEP = 1e-5  # relative change of a datum in the difference of two assemblies
NOTHING = 1e-6  # of the largest derivative: less is rounding


@one_thread
def sensitivities(model: Model, bounds: Bounds) -> Sensitivities:
    """Return the derivatives of the associated load factor by the data of the model.

    By the friction, cohesion, compressive and tensile strength of each interface, by the unit weight of each
    block, and by the position of each load that acts at a point. Nothing is solved again: the envelope
    theorem needs the two states of the bounds alone, and two assemblies for each kind of datum. For the shape
    see :func:`limitblocks.studies.shape_sensitivity`.

    Where the mechanism or the stress state is not unique, the load factor has a kink in some data:
    derivatives to both sides differ, and those of the states at hand are returned, which lie between if one
    of the two is unique. `unique` tells whether the mechanism is the only one. Stresses are hardly ever
    unique; this matters only for the strengths of interfaces that move, and `agreed` tells for which of them
    the friction's derivative is the same in all stress states.

    Parameters
    ----------
    model : Model
        The structure.
    bounds : Bounds
        Of this model.

    Raises
    ------
    ModelError
        If the bounds belong to another model.
    """
    problem, si = _given(model, bounds)
    friction = _by_joints(model, si, "friction")
    yielding = Yielding(problem, problem.dimensionless(si))
    return Sensitivities(
        load_factor=bounds.lower,
        friction=friction,
        cohesion=_by_joints(model, si, "cohesion"),
        compressive_strength=_by_joints(model, si, "compressive_strength"),
        tensile_strength=_by_joints(model, si, "tensile_strength"),
        unit_weight=_by_weights(model, si),
        positions=_by_positions(model, si),
        weights=read_only(np.array([block.unit_weight or 0.0 for block in model.blocks])),
        frictions=read_only(np.array([_number(joint_of(i), "friction") for i in model.interfaces])),
        unique=yielding.alone,
        agreed=_agreed(model, si, friction),
        blocks=tuple(block.name for block in model.blocks),
        interfaces=tuple(interface.name for interface in model.interfaces),
        digest=model.digest,
        remarks=bounds.remarks,
    )


@one_thread
def shape_sensitivity(model: Model, bounds: Bounds, field: Field, *, step: float = STEP) -> float:
    """Return the derivative of the associated load factor as all points r move to r + t field(r), at t = 0.

    The corners of blocks and of interfaces move with the field, ties with their anchors; ties, strips, dowels
    and fill keep their sections. Loads that act at points given in space stay, the prestress of ties as well.
    A field that is zero but at one point moves the vertices there alone. The derivative is taken by a central
    difference of the assembly, not of the load factor.

    Parameters
    ----------
    model : Model
        The structure.
    bounds : Bounds
        Of this model.
    field : callable
        Displacement (k, 3), m, of points (k, 3), m.
    step : float
        The t of the difference; faces have to stay plane within tolerances.

    Returns
    -------
    float
        Per unit of t; see :func:`limitblocks.sensitivities` for what it is where the load factor has a kink.

    Raises
    ------
    ModelError
        If the bounds belong to another model, the field gives no displacement of each point, a moved shape is
        none, or the yield set of a joint jumps, as
        that of ExactTorsion may where a rectangle is skewed: there is no derivative then.
    """
    _, si = _given(model, bounds)
    step = number(step, "step", "", above=0.0)
    shapes = [moved(model, field, t) for t in (step, -step)]
    ahead, back = (_lagrangian(shape.problem, carried_over(model, shape, si)) for shape in shapes)
    return (ahead - back) / (2.0 * step)


def _given(model: Model, bounds: Bounds) -> tuple[LimitProblem, State]:
    """The problem and the state of the bounds in SI units, its rates those of the free blocks."""
    refuse_kind(bounds, Bounds, "bounds")
    refuse_other(model, bounds)
    return model.problem, State(
        bounds.lower,
        bounds.generalised_stresses,
        bounds.displacement_rates[model.free].ravel(),
        bounds.flow_multipliers,
    )


def _lagrangian(problem: LimitProblem, si: State) -> float:
    """L of a state in SI units."""
    z = problem.dimensionless(si)
    balance = problem.C.T @ z.x - problem.dead - z.load_factor * problem.live
    power = z.load_factor + z.u @ balance + z.y @ (problem.F @ z.x + problem.g)
    return float(power / problem.units.live)


def _of_interfaces(model: Model, si: State) -> Array:
    """What the rows of each interface have in L, shape (m,)."""
    problem = model.problem
    z = problem.dimensionless(si)
    power = z.y * (problem.F @ z.x + problem.g)
    return np.bincount(problem.row_interface, power, len(problem.interfaces)) / problem.units.live


def _by_joints(model: Model, si: State, word: str) -> Array:
    """Derivatives by a number of the joints (m,); NaN where a joint has none, or it is zero."""
    values = np.array([_number(joint_of(i), word) for i in model.interfaces])
    has = values > 0.0
    if not has.any():
        return read_only(np.full(len(values), np.nan))
    ahead, back = (
        _of_interfaces(replace(model, interfaces=_rescaled(model, word, t)), si) for t in (STEP, -STEP)
    )
    change = np.where(has, 2.0 * STEP * values, 1.0)
    return read_only(np.where(has, (ahead - back) / change, np.nan))


def _agreed(model: Model, si: State, friction: Array) -> npt.NDArray[np.bool_]:
    """Whether all stress states agree on the derivative by the friction of each interface, shape (m,)."""
    problem = model.problem
    change = []
    for t in (STEP, -STEP):
        other = replace(model, interfaces=_rescaled(model, "friction", t)).problem
        y = other.dimensionless(si).y
        of_interface = sparse.coo_array((y, (other.row_interface, np.arange(len(y)))))
        change.append(of_interface.tocsr() @ other.F)
    functionals = sparse.csr_array(change[0] - change[1])
    matters = np.nan_to_num(np.abs(friction)) > NOTHING * np.nanmax(np.abs(friction), initial=0.0)
    agreed = np.ones(len(problem.interfaces), dtype=bool)
    y, asked = problem.dimensionless(si).y, functionals[np.flatnonzero(matters)]
    agreed[matters] = determined(problem, y, asked, load_factor=True)
    agreed.flags.writeable = False
    return agreed


def _rescaled(model: Model, word: str, t: float) -> list[Interface]:
    """Interfaces with a number of their joints scaled by 1 + t."""
    joints = {joint_of(i) for i in model.interfaces}
    scaled: dict[object, object] = {
        joint: replace(joint, **{word: (1.0 + t) * _number(joint, word)})  # type: ignore[type-var]
        for joint in joints
        if _number(joint, word) > 0.0
    }
    return [replace(i, joint=scaled.get(i.joint, i.joint)) for i in model.interfaces]


def _number(joint: object, word: str) -> float:
    """A number of a joint, NaN where it has none."""
    known = is_dataclass(joint) and word in {field.name for field in fields(joint)}
    value = getattr(joint, word) if known else None
    return np.nan if value is None else float(value)


def _by_weights(model: Model, si: State) -> Array:
    """Derivatives by the unit weights of all blocks (n,), zero for supports; a load is its block's own.

    Loads are linear in them, so that any step is exact, also that of a block without weight.
    """
    step = max(block.unit_weight or 0.0 for block in model.blocks) or 1.0
    heavier = [
        block if block.unit_weight is None else block.labelled(unit_weight=block.unit_weight + step)
        for block in model.blocks
    ]
    change = _loads_power(replace(model, blocks=heavier), si) - _loads_power(model, si)
    ordered = np.zeros(len(model.blocks))
    ordered[model.free] = -change / step
    return read_only(ordered)


def _loads_power(model: Model, si: State) -> Array:
    """Power of the dead loads and load factor times the live ones on each free block."""
    free = model.free_blocks
    loads = model.dead.on(free) + si.load_factor * model.live.on(free)
    return np.asarray((loads * si.u.reshape(-1, 6)).sum(axis=1))


def _by_positions(model: Model, si: State) -> tuple[LoadPosition, ...]:
    """Derivatives by the points at which loads act."""
    found = []
    free, u = model.free_blocks, si.u.reshape(-1, 6)
    for word, load, share in (("dead", model.dead, 1.0), ("live", model.live, si.load_factor)):
        for k, (factor, term) in enumerate(load.terms):
            at = getattr(term, "at", None)
            if at is None or len(at) != 3 or not hasattr(term, "block"):
                continue
            step = STEP * float(np.median([block.size for block in free]))
            gradient = np.zeros(3)
            for axis, move in enumerate(step * np.eye(3)):
                ahead, back = (replace(term, at=tuple(np.add(at, t * move))).on(free) for t in (1.0, -1.0))
                gradient[axis] = -share * factor * float((u * (ahead - back)).sum()) / (2.0 * step)
            found.append(LoadPosition(word, k, term.block, read_only(gradient)))
    return tuple(found)
