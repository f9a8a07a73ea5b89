"""A model with its corners moved by a field, and a state in the rows and stresses of the moved one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from limitblocks.analysis.unique import YIELDING
from limitblocks.arrays import Array, Indices, largest_in_rows, positions, read_only, reals_if_any, repeated
from limitblocks.errors import ModelError
from limitblocks.geometry import Interface
from limitblocks.geometry.polygon import areas, centroids
from limitblocks.joints import Backfill, Dowel, Tie
from limitblocks.model import Model
from limitblocks.problem import LimitProblem, State, in_units

NEAR = 10.0  # change of a row, in its size, per move of the corners, in the root of the area
ROUNDING = 1e-6  # of a row: more is a change where nothing moves

Field = Callable[[Array], Array]


def moved(model: Model, field: Field, t: float) -> Model:
    """Return the model with the corners of blocks and interfaces moved by t field(r)."""
    blocks = [replace(block, vertices=_shifted(block.vertices, field, t)) for block in model.blocks]
    return replace(model, blocks=blocks, interfaces=[_carried(i, field, t) for i in model.interfaces])


def _shifted(points: Array, field: Field, t: float) -> Array:
    """Points (k, 3) moved by t field(points); ModelError where that is no displacement of each."""
    if not callable(field):
        raise ModelError(
            f"field is {field!r}, expected a function of points (k, 3) that gives their displacements"
        )
    given = field(points)
    shift = reals_if_any(given)
    if shift.shape != points.shape or not np.isfinite(shift).all():
        was = f"shape {shift.shape}" if shift.size else repr(given)
        raise ModelError(
            f"field gives {was} for points {points.shape}, expected finite numbers of that shape"
        )
    return points + t * shift


def _carried(interface: Interface, field: Field, t: float) -> Interface:
    """The interface with its corners moved, its first axis turned as little as its plane.

    A tie stays between its anchors; it keeps its section, as strips, dowels and fill do.
    """

    def at(points: Array) -> Array:
        return _shifted(points, field, t)

    joint, old = interface.joint, interface.axes
    if isinstance(joint, Tie) and joint.length:
        ends = at(interface.centroid + np.outer((-0.5, 0.5), joint.length * old[2]))
        axes, long = _turned(old[0], ends[1] - ends[0])
        joint = replace(joint, length=long)
        return replace(interface, centroid=ends.mean(axis=0), axes=axes, joint=joint)
    corners = at(interface.centroid + interface.polygon @ old[:2])
    middle = corners.mean(axis=0)
    arms = corners - middle
    axes, _ = _turned(old[0], np.cross(arms, np.roll(arms, -1, axis=0)).sum(axis=0))
    if isinstance(joint, Tie | Dowel):
        return replace(interface, centroid=middle, axes=old if isinstance(joint, Backfill) else axes)
    flat = arms @ axes[:2].T
    centre = centroids(flat)
    return replace(
        interface, centroid=middle + centre @ axes[:2], axes=axes, polygon=read_only(flat - centre)
    )


def _turned(first: Array, normal: Array) -> tuple[Array, float]:
    """Axes about a normal of any length, the first one turned as little as may be, and that length."""
    size = float(np.linalg.norm(normal))
    normal = normal / size
    first = first - (first @ normal) * normal
    first = first / np.linalg.norm(first)
    return np.stack([first, np.cross(normal, first), normal]), size


def carried_over(model: Model, moved: Model, si: State) -> State:
    """Return a state of `model`, SI units, in the order of stresses and rows of `moved`.

    Units, and with them groups of interfaces, may change with a shape. Each linear row that flows becomes the
    one that it moved to. Where it parts in several, as facets of a hull may, that is the one that holds the
    stresses most: all of them limit the yield set. Cones keep their order.

    Raises
    ------
    ModelError
        If a row that flows has moved to none, or the stresses are far outside another: the yield set jumps.
    """
    p, q = model.problem, moved.problem
    x, units = (_by_interface(p.stress_interface, q.stress_interface, v) for v in (si.x, p.stress_units))
    first, linear = p.cones.linear, q.cones.linear
    limit, y, z = _limits(model, moved), np.zeros(len(q.g)), x / q.stress_units
    y[linear:] = _by_interface(p.row_interface[first:], q.row_interface[linear:], si.y[first:])
    margin, size = (q.F @ z + q.g)[:linear], (abs(q.F) @ np.abs(z) + np.abs(q.g))[:linear]
    outside = margin < -limit[q.row_interface[:linear]] * size
    if outside.any():
        raise _jump(model, q.row_interface[outside.argmax()])
    flowing = np.flatnonzero(si.y[:first])
    if len(flowing):
        old, new = _rows(p, p.stress_units)[flowing], _rows(q, units)
        interface, force = p.row_interface[flowing], margin * _row_units(q)[:linear]
        best, near = _nearest(old, interface, new, q.row_interface[:linear], limit[interface], force)
        strain = np.abs(p.dimensionless(si).y) * largest_in_rows(p.F)
        lost = ~near & (strain[flowing] > YIELDING * strain.max())
        if lost.any():
            raise _jump(model, interface[lost.argmax()])
        np.add.at(y, best, np.where(near, si.y[flowing], 0.0))
    return State(si.load_factor, x, si.u, y)


def _nearest(
    old: Array, own: Indices, new: Array, theirs: Indices, limit: Array, margin: Array
) -> tuple[Indices, npt.NDArray[np.bool_]]:
    """Of each old row (k, s) the new one of least margin within its limit, and whether there is one (k,)."""
    count = np.bincount(theirs, minlength=int(own.max()) + 1)
    which, nth = repeated(count[own])
    there = np.argsort(theirs, kind="stable")[(np.cumsum(count) - count)[own][which] + nth]
    most = limit * np.abs(old).max(axis=1)
    near = np.abs(new[there] - old[which]).max(axis=1) <= most[which]
    order = np.lexsort((np.where(near, margin[there], np.inf), which))
    best = order[np.searchsorted(which[order], np.arange(len(old)))]
    return there[best], near[best]


def _by_interface(old: Indices, new: Indices, values: Array) -> Array:
    """Values that belong to interfaces `old`, in the order of `new`: those of one keep theirs."""
    ordered = np.empty_like(values)
    ordered[np.argsort(new, kind="stable")] = values[np.argsort(old, kind="stable")]
    return ordered


def _rows(problem: LimitProblem, units: Array) -> Array:
    """Linear rows of F, in N, as functions of the stresses of their interface in `units`, (linear, most)."""
    F = in_units(problem.F, _row_units(problem), units / problem.stress_units)[: problem.cones.linear]
    column = positions(problem.stress_interface)
    rows = np.zeros((F.shape[0], int(column.max()) + 1))
    rows[np.repeat(np.arange(len(rows)), np.diff(F.indptr)), column[F.indices]] = F.data
    return rows


def _row_units(problem: LimitProblem) -> Array:
    return np.asarray(problem.units.interface_force[problem.row_interface] * problem.units.row)


def _limits(model: Model, moved: Model) -> Array:
    """Largest change of a row of each interface that its corners account for, shape (m,)."""
    pairs = zip(model.interfaces, moved.interfaces, strict=True)
    moves = [np.abs(b.polygon - a.polygon).max() / np.sqrt(areas(a.polygon)) for a, b in pairs]
    return NEAR * np.array(moves) + ROUNDING


def _jump(model: Model, k: int) -> ModelError:
    one = model.interfaces[k]
    return ModelError(
        f"interface {one.name}: the yield set of {one.joint!r} jumps by this field, as where a rectangle is "
        "skewed, so that the load factor has no derivative; compare bounds of models moved to both sides"
    )
