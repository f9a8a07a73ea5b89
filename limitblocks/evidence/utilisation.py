"""How much of its strength each interface uses, from the yield rows. numpy only."""

from __future__ import annotations

import numpy as np

from limitblocks.arrays import Array
from limitblocks.joints.queries import normal_share
from limitblocks.joints.rows import hinge_gradients
from limitblocks.model import Model
from limitblocks.problem.cones import ratio

NOISE = 1e-9  # of the unit of force of an interface: a strength below it counts as none


def utilisation(model: Model, stresses: Array) -> Array:
    """Return the utilisation of each interface, shape (m,), from 0 to 1 on the yield surface.

    It is 1/t, t the largest multiple of (V1, V2, M1, M2, T) within the yield rows under the same N, or the
    share of the compressive or tensile strength that N uses by itself, if that is more, as
    :meth:`limitblocks.joints.queries.Queries.utilisation` has it. Where the rows act on the forces of points
    (PointContact), which are not unique, it is the larger of the friction in use over that available, summed
    over the points, and the way of the centre of pressure from the centroid to the edge.

    Parameters
    ----------
    model : Model
        The structure.
    stresses : Array, shape (s,)
        Generalised stresses of a result, N and N m.
    """
    problem = model.problem
    x = stresses / problem.stress_units
    V1, V2, N = (problem.resultants[k::6].tocsr() for k in range(3))
    normal = np.zeros(len(x))
    normal[N.indices] = 1.0
    alone = np.bincount(problem.stress_interface, minlength=len(problem.interfaces)) == 1
    normal[alone[problem.stress_interface]] = 0.0  # a tie uses its strength by N itself
    held, rest = problem.F @ (x * normal) + problem.g, problem.F @ (x * (1.0 - normal))
    used = np.zeros(len(problem.interfaces))
    np.maximum.at(used, problem.member_interface, problem.cones.share(held, rest, NOISE))
    points = np.flatnonzero(np.diff(N.indptr) > 1)  # rows that act on the forces of points
    if len(points):
        along, across = V1[points], V2[points]  # a guide has the second alone
        sizes = np.hypot(x[along.indices], x[across.indices])
        owner = np.repeat(np.arange(len(points)), np.diff(along.indptr))
        friction = np.bincount(owner, weights=sizes, minlength=len(points))
        used[points] = ratio(friction, problem.friction[points] * -(N @ x)[points], NOISE)
        Q = (problem.resultants @ x).reshape(-1, 6)
        for k in points.tolist():
            h = hinge_gradients(model.interfaces[k].polygon[None] / problem.units.interface_length[k])[0]
            used[k] = max(used[k], float(ratio((h[:, 3:] @ Q[k, 3:]).max(), -Q[k, 2], NOISE)))
    normals = N @ x * problem.units.resultants[2::6]
    alone = [
        normal_share(one.joint, one, own) for one, own in zip(model.interfaces, normals.tolist(), strict=True)
    ]
    return np.maximum(used, np.minimum(alone, 1.0))
