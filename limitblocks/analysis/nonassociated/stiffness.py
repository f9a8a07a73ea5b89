"""Compliance of the joints from their stiffness, in the units of a problem."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from limitblocks.arrays import Array, real
from limitblocks.errors import ModelError
from limitblocks.joints.base import Joint, joint_of
from limitblocks.model import Model
from limitblocks.problem import LimitProblem

Stiffness = tuple[float, float]  # normal and shear, N/m3


def compliance_of(
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


def displacement_units(model: Model, problem: LimitProblem) -> Array:
    """Displacements of the free blocks (6 n,), m and rad, over dimensionless ones, for softness one."""
    return np.asarray(np.prod(_means(model.problem)) / problem.units.loads)
