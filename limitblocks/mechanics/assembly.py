"""From blocks, interfaces and loads to the dimensionless limit problem."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import sparse

from limitblocks.arrays import Array, Indices, read_only
from limitblocks.errors import ModelError
from limitblocks.geometry import Block, Interface
from limitblocks.geometry.polygon import areas, second_moments
from limitblocks.joints.base import YieldRows, joint_of
from limitblocks.mechanics.compatibility import compatibility_matrix
from limitblocks.problem import Cones, LimitProblem, Scales


@dataclass(frozen=True)
class _Group:
    """Interfaces of one joint and one number of corners, with the places of their rows and columns."""

    interfaces: Indices
    rows: YieldRows
    row_index: Indices
    column_index: Indices


def limit_problem(
    free: Sequence[Block],
    interfaces: Sequence[Interface],
    dead: Array,
    live: Array,
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
    scales = _scales(free, dead, live)
    groups, cones = _grouped(interfaces, scales)
    n_stresses = sum(group.column_index.size for group in groups)
    resultants = _blocks(
        [(g.rows.resultants, 6 * g.interfaces[:, None] + np.arange(6), g.column_index) for g in groups],
        (6 * len(interfaces), n_stresses),
    )
    n_rows = sum(group.row_index.size for group in groups)

    def per_row(name: str) -> sparse.csr_array:
        parts = [(getattr(g.rows, name), g.row_index, g.column_index) for g in groups]
        return _blocks(parts, (n_rows, n_stresses))

    g, pivot = np.zeros(n_rows), np.zeros(n_rows)
    row_interface = np.zeros(n_rows, dtype=np.int64)
    row_mode = np.empty(n_rows, dtype=object)
    reach, friction = np.zeros((len(interfaces), 2)), np.zeros(len(interfaces))
    for group in groups:
        g[group.row_index], pivot[group.row_index] = group.rows.g, group.rows.pivot
        row_interface[group.row_index] = group.interfaces[:, None]
        row_mode[group.row_index] = np.array(group.rows.modes, dtype=object)
        reach[group.interfaces], friction[group.interfaces] = group.rows.reach, group.rows.friction
    row_interface.flags.writeable = False
    unit = scales.resultants
    return LimitProblem(
        C=(resultants.T @ _compatibility(free, interfaces, scales)).tocsr(),
        dead=read_only((dead / unit).ravel()),
        live=read_only((live / (unit * scales.live)).ravel()),
        F=per_row("F"),
        g=read_only(g),
        G=per_row("G"),
        cones=cones,
        pivot=read_only(pivot),
        reach=read_only(reach),
        resultants=resultants,
        compliance=read_only(_compliance(resultants, interfaces, scales)),
        row_interface=row_interface,
        row_mode=tuple(row_mode),
        friction=read_only(friction),
        scales=scales,
        blocks=tuple(block.name for block in free),
        interfaces=tuple(interface.name for interface in interfaces),
    )


def _scales(free: Sequence[Block], dead: Array, live: Array) -> Scales:
    """Mean block weight and length, and the live load's resultant, sum of |f| + |m| / length, over it."""
    length = float(np.mean([np.cbrt(block.volume) for block in free]))

    def magnitude(load: Array) -> float:
        return float(
            (np.linalg.norm(load[:, :3], axis=1) + np.linalg.norm(load[:, 3:], axis=1) / length).sum()
        )

    if magnitude(live) == 0.0:
        raise ModelError("the live load is zero on every free block, expected a force or moment to multiply")
    force = (magnitude(dead) or magnitude(live)) / len(free)
    return Scales(force=force, length=length, live=magnitude(live) / force)


def _grouped(interfaces: Sequence[Interface], scales: Scales) -> tuple[list[_Group], Cones]:
    """Ask each joint for its rows, and order all rows: linear ones first, then cones by size."""
    members = defaultdict(list)
    for k, interface in enumerate(interfaces):
        members[joint_of(interface), len(interface.polygon)].append(k)
    stress_unit = scales.force / scales.length**2
    asked = []
    for (joint, _), places in members.items():
        polygons = np.stack([interfaces[k].polygon for k in places]) / scales.length
        asked.append((np.array(places), joint.yield_rows(polygons, stress_unit)))
    linear = sum(rows.linear * len(found) for found, rows in asked)
    sizes = sorted({size for _, rows in asked for size in rows.cones})
    counts = {size: sum(rows.cones.count(size) * len(found) for found, rows in asked) for size in sizes}
    cones = Cones(linear, tuple((counts[size], size) for size in sizes))
    next_row = {0: 0} | {size: first for first, _, size in cones.blocks}
    groups, next_column = [], 0
    for found, rows in asked:
        m, stresses = len(found), rows.resultants.shape[2]
        index = [_take(next_row, 0, m, rows.linear)]
        index += [_take(next_row, size, m, size) for size in rows.cones]
        column_index = next_column + np.arange(m * stresses).reshape(m, stresses)
        next_column += m * stresses
        groups.append(_Group(found, rows, np.concatenate(index, axis=1), column_index))
    return groups, cones


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
    free: Sequence[Block], interfaces: Sequence[Interface], scales: Scales
) -> sparse.csr_array:
    """Compatibility matrix of the paper, rows in stress resultants, lengths over the block length."""
    place = {block.name: k for k, block in enumerate(free)}
    block_i = np.array([place.get(interface.block_i, -1) for interface in interfaces])
    block_j = np.array([place.get(interface.block_j, -1) for interface in interfaces])
    at = np.stack([interface.centroid for interface in interfaces])
    centroids = np.stack([block.centroid for block in free])
    axes = np.stack([interface.axes for interface in interfaces])
    at_i, at_j = (at - centroids[block_i]) / scales.length, (at - centroids[block_j]) / scales.length
    return compatibility_matrix(axes, at_i, at_j, block_i, block_j, len(free))


def _compliance(resultants: sparse.csr_array, interfaces: Sequence[Interface], scales: Scales) -> Array:
    """Strain per generalised stress at unit stiffness per area; forces of n points share the area."""
    inertia = np.ones((len(interfaces), 6))
    for n in {len(interface.polygon) for interface in interfaces}:
        these = [k for k, interface in enumerate(interfaces) if len(interface.polygon) == n]
        polygons = np.stack([interfaces[k].polygon for k in these]) / scales.length
        second = second_moments(polygons)
        inertia[these, :3] = areas(polygons)[:, None]
        inertia[these, 3:] = np.stack([second[:, 1], second[:, 0], second[:, 0] + second[:, 1]], axis=1)
    squares = resultants.multiply(resultants).tocsr()
    share = squares.sum(axis=1) / inertia.ravel()
    is_force = np.tile([True, True, True, False, False, False], len(interfaces))
    forces, moments = squares.T @ (share * is_force), squares.T @ (share * ~is_force)
    return np.asarray(np.where(forces > 0.0, forces, moments))
