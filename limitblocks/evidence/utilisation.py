"""How much of its strength each interface uses, from the yield rows. numpy only."""

from __future__ import annotations

from collections import defaultdict

import numpy as np

from limitblocks.arrays import Array, Indices
from limitblocks.joints import forces_at_points
from limitblocks.joints.base import joint_of
from limitblocks.joints.queries import normal_share
from limitblocks.model import Model

NOISE = 1e-9  # of the unit of force of an interface: a strength below it counts as none


def utilisation(model: Model, stresses: Array) -> Array:
    """Return the utilisation of each interface, shape (m,), from 0 to 1 on the yield surface.

    It is 1/t, t the largest multiple of (V1, V2, M1, M2, T) within the yield rows under the same N, or the
    share of the compressive or tensile strength that N uses by itself, if that is more, as
    :meth:`limitblocks.joints.queries.Queries.utilisation` has it. Where the rows act on the forces of points
    (PointContact), which are not unique, those that carry the largest multiple count, to some 1e-6; a joint
    of one's own that has constant terms beside such rows is given 1, the most it can be.

    Parameters
    ----------
    model : Model
        The structure.
    stresses : Array, shape (s,)
        Generalised stresses of a result, N and N m.
    """
    problem = model.problem
    x = stresses / problem.stress_units
    N = problem.resultants[2::6].tocsr()
    normal = np.zeros(len(x))
    normal[N.indices] = 1.0
    alone = np.bincount(problem.stress_interface, minlength=len(problem.interfaces)) == 1
    normal[alone[problem.stress_interface]] = 0.0  # a tie uses its strength by N itself
    held, rest = problem.F @ (x * normal) + problem.g, problem.F @ (x * (1.0 - normal))
    used = np.zeros(len(problem.interfaces))
    np.maximum.at(used, problem.member_interface, problem.cones.share(held, rest, NOISE))
    points = np.flatnonzero(np.diff(N.indptr) > 1)  # rows that act on the forces of points
    if len(points):
        used[points] = _by_points(model, points, (problem.resultants @ x).reshape(-1, 6)[points])
    normals = N @ x * problem.units.resultants[2::6]
    alone = [
        normal_share(one.joint, one, own) for one, own in zip(model.interfaces, normals.tolist(), strict=True)
    ]
    return np.maximum(used, np.minimum(alone, 1.0))


def _by_points(model: Model, points: Indices, Q: Array) -> Array:
    """Utilisation of interfaces `points` whose rows act on the forces of points; dimensionless Q (k, 6)."""
    used = np.where(np.abs(Q).max(axis=1) > NOISE, 1.0, 0.0)
    alike = defaultdict(list)
    for k in np.flatnonzero(-Q[:, 2] > NOISE).tolist():
        interface = model.interfaces[points[k]]
        alike[joint_of(interface), len(interface.polygon)].append(k)
    for (joint, _), own in alike.items():
        length = model.problem.units.interface_length[points[own]]
        rows = joint.yield_rows(
            np.stack([model.interfaces[k].polygon for k in points[own]]) / length[:, None, None]
        )
        if not rows.g.any():
            used[own] = forces_at_points.used(rows, Q[own])
    return used
