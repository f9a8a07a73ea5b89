"""From blocks, interfaces and loads to the dimensionless limit problem."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy import sparse

from limitblocks.arrays import Array, Indices, read_only
from limitblocks.errors import ModelError
from limitblocks.geometry import Block, Interface
from limitblocks.geometry.ends import ends_of
from limitblocks.geometry.polygon import areas, second_moments
from limitblocks.joints.base import Joint, YieldRows, joint_of
from limitblocks.mechanics.compatibility import compatibility_matrix
from limitblocks.mechanics.measures import row_units, units_of
from limitblocks.problem import Cones, LimitProblem, Mode, Units, in_units


@dataclass(frozen=True)
class _Group:
    """Interfaces of one joint and one number of corners, with the places of their rows and columns.

    `polygons` are in their unit of length.
    """

    interfaces: Indices
    polygons: Array
    rows: YieldRows
    row_index: Indices
    column_index: Indices


def limit_problem(
    free: Sequence[Block], interfaces: Sequence[Interface], dead: Array, live: Array
) -> LimitProblem:
    """Assemble the limit problem of the blocks `free`; other blocks named by interfaces do not move.

    Parameters
    ----------
    free : sequence of Block
        The blocks that can move.
    interfaces : sequence of Interface
        At least one of the two blocks of each is free.
    dead, live : Array, shape (n, 6)
        Forces (N) and moments (N m) at the centroids of the free blocks.

    Raises
    ------
    ModelError
        If the live load is zero, or neither load has a force to scale with.
    """
    ends, centroids = ends_of(free, interfaces), _stacked([block.centroid for block in free])
    units = units_of(free, interfaces, ends, dead, live)
    groups, cones = _grouped(interfaces, units)
    n_stresses = sum(group.column_index.size for group in groups)
    resultants = _blocks(
        [(g.rows.resultants, 6 * g.interfaces[:, None] + np.arange(6), g.column_index) for g in groups],
        (6 * len(interfaces), n_stresses),
    )

    def per_row(name: str) -> sparse.csr_array:
        parts = [(getattr(g.rows, name), g.row_index, g.column_index) for g in groups]
        return _blocks(parts, (cones.height, n_stresses))

    F = per_row("F")
    units = replace(units, row=row_units(F, cones))
    rows, columns = 1.0 / units.row, np.ones(n_stresses)
    return LimitProblem(
        C=(resultants.T @ _compatibility(centroids, interfaces, ends, units)).tocsr(),
        dead=read_only(dead.ravel() / units.loads),
        live=read_only(live.ravel() / (units.loads * units.live)),
        F=in_units(F, rows, columns),
        G=in_units(per_row("G"), rows, columns),
        cones=cones,
        resultants=resultants,
        compliance=read_only(_compliance(resultants, groups, units)),
        ends=ends,
        **_numbers(groups, units.row, len(interfaces)),
        units=units,
        blocks=tuple(block.name for block in free),
        interfaces=tuple(interface.name for interface in interfaces),
        centroids=read_only(centroids),
    )


def _numbers(groups: Sequence[_Group], unit: Array, m: int) -> dict[str, Any]:
    """What rows and interfaces have beside matrices, by field of the problem; `unit` (R,) is of the rows."""
    g, pivot, half_sides, friction = np.zeros(len(unit)), np.zeros(len(unit)), np.zeros((m, 2)), np.zeros(m)
    row_interface, row_mode = np.zeros(len(unit), dtype=np.int64), np.empty(len(unit), dtype=object)
    for group in groups:
        g[group.row_index], pivot[group.row_index] = group.rows.g, group.rows.pivot
        row_interface[group.row_index] = group.interfaces[:, None]
        row_mode[group.row_index] = np.array(_modes(group.rows), dtype=object)
        half_sides[group.interfaces] = group.rows.half_sides
        friction[group.interfaces] = group.rows.friction
    row_interface.flags.writeable = row_mode.flags.writeable = False
    numbers = {"g": g / unit, "pivot": pivot / unit, "half_sides": half_sides, "friction": friction}
    kept = {name: read_only(values) for name, values in numbers.items()}
    return {**kept, "row_interface": row_interface, "row_mode": row_mode}


def _modes(rows: YieldRows) -> list[Mode]:
    try:
        return [Mode(mode) for mode in rows.modes]
    except ValueError as error:
        words = ", ".join(repr(mode.value) for mode in Mode)
        raise ModelError(f"a joint's failure mode: {error}; expected one of {words}") from None


def _members(
    interfaces: Sequence[Interface], units: Units
) -> dict[tuple[Joint, int, float, float], list[int]]:
    """Places of the interfaces of one joint, number of corners, unit of force and unit of length."""
    number: dict[Joint, int] = {}  # equal joints are one: hashed once each, not for every interface
    kinds = {id(interface.joint): interface for interface in interfaces}
    joint = {own: number.setdefault(joint_of(interface), len(number)) for own, interface in kinds.items()}
    scales = zip(units.interface_force.tolist(), units.interface_length.tolist(), strict=True)
    members = defaultdict(list)
    for k, (interface, scale) in enumerate(zip(interfaces, scales, strict=True)):
        members[joint[id(interface.joint)], len(interface.polygon), *scale].append(k)
    joints = list(number)
    return {(joints[own], *rest): places for (own, *rest), places in members.items()}


def _grouped(interfaces: Sequence[Interface], units: Units) -> tuple[list[_Group], Cones]:
    """Ask each joint for its rows, and order all rows: linear ones first, then cones by size."""
    asked = []
    for (joint, _, force, length), places in _members(interfaces, units).items():
        polygons = _stacked([interfaces[k].polygon for k in places]) / length
        rows = joint.yield_rows(polygons, force / length**2)
        _refuse_rows(joint, rows)
        asked.append((np.array(places), polygons, rows))
    linear = sum(rows.linear * len(own) for own, _, rows in asked)
    sizes = sorted({size for _, _, rows in asked for size in rows.cones})
    counts = {size: sum(rows.cones.count(size) * len(own) for own, _, rows in asked) for size in sizes}
    cones = Cones(linear, tuple((counts[size], size) for size in sizes))
    firsts = {
        size: int(index[0, 0]) for (_, size), index in zip(cones.second_order, cones.groups, strict=True)
    }
    next_row = {0: 0} | firsts
    groups, next_column = [], 0
    for own, polygons, rows in asked:
        m, stresses = len(own), rows.resultants.shape[2]
        index = [_take(next_row, 0, m, rows.linear)]
        index += [_take(next_row, size, m, size) for size in rows.cones]
        column_index = next_column + np.arange(m * stresses).reshape(m, stresses)
        next_column += m * stresses
        groups.append(_Group(own, polygons, rows, np.concatenate(index, axis=1), column_index))
    return groups, cones


def _refuse_rows(joint: Joint, rows: YieldRows) -> None:
    """ModelError where the rows of a joint, of one's own, are none of its cones or leave a stress free."""
    own = {name: getattr(rows, name).shape[1] for name in ("F", "g", "G", "pivot")}
    expected = rows.linear + sum(rows.cones)
    for name, count in (own | {"modes": len(rows.modes)}).items():
        if count != expected:
            raise ModelError(
                f"{joint}: yield_rows has {name} of {count} rows, expected {expected} by linear and cones"
            )
    free = np.flatnonzero(~rows.F.any(axis=(0, 1)))
    if len(free):
        raise ModelError(
            f"{joint}: yield_rows has no row of F that limits the generalised stress {free[0]}, counted"
            " from 0; give it a limit, or leave it out of F, G and resultants: it is zero then"
        )


def _stacked(arrays: Sequence[Array]) -> Array:
    """Arrays of one shape as one, faster than np.stack where there are thousands."""
    return np.concatenate(arrays).reshape(len(arrays), *arrays[0].shape)


def _take(next_row: dict[int, int], kind: int, m: int, count: int) -> Indices:
    """Reserve `count` consecutive rows for each of m interfaces among the rows of one kind."""
    index = next_row[kind] + np.arange(m * count).reshape(m, count)
    next_row[kind] += m * count
    return index


def _blocks(parts: list[tuple[Array, Indices, Indices]], shape: tuple[int, int]) -> sparse.csr_array:
    """Sparse matrix from stacks of dense blocks (m, r, c) with row (m, r) and column (m, c) places."""
    data, rows, columns = [], [], []
    for values, row, column in parts:
        keep = values != 0.0
        data.append(values[keep])
        rows.append(np.broadcast_to(row[:, :, None], values.shape)[keep])
        columns.append(np.broadcast_to(column[:, None, :], values.shape)[keep])
    triplets = (np.concatenate(data), (np.concatenate(rows), np.concatenate(columns)))
    return sparse.coo_array(triplets, shape=shape).tocsr()


def _compatibility(
    centroids: Array, interfaces: Sequence[Interface], ends: Indices, units: Units
) -> sparse.csr_array:
    """Compatibility matrix of the paper, rows in stress resultants, in the units of both."""
    at = _stacked([interface.centroid for interface in interfaces])
    axes = _stacked([interface.axes for interface in interfaces])
    block_i, block_j = ends.T
    C = compatibility_matrix(
        axes, at - centroids[block_i], at - centroids[block_j], block_i, block_j, len(centroids)
    )
    return in_units(C, units.resultants, 1.0 / units.loads)


def _compliance(resultants: sparse.csr_array, groups: list[_Group], units: Units) -> Array:
    """Strain per generalised stress at one stiffness per area; forces of n points share the area.

    In the mean force and length of the interfaces, so that it is near one.
    """
    length, force = units.interface_length, units.interface_force
    inertia = np.ones((len(length), 6))
    for group in groups:
        second = second_moments(group.polygons)
        inertia[group.interfaces, :3] = areas(group.polygons)[:, None]
        inertia[group.interfaces, 3:] = second[:, [1, 0, 0]]
        inertia[group.interfaces, 5] += second[:, 1]
    squares = resultants.multiply(resultants).tocsr()
    share = squares.sum(axis=1) / inertia.ravel()
    is_force = np.tile([True, True, True, False, False, False], len(length))
    forces, moments = squares.T @ (share * is_force), squares.T @ (share * ~is_force)
    places = resultants.tocoo()
    own = np.zeros(resultants.shape[1], dtype=int)
    own[places.col] = places.row // 6
    unit = force / length / (np.mean(force) / np.mean(length))
    return np.asarray(np.where(forces > 0.0, forces, moments) * unit[own] ** 2)
