"""Load factors known by formula: blocks that each stand on one other, grooves, neighbours that push."""

from itertools import pairwise, product

import numpy as np
from coulomb import Truth

import limitblocks as lb

UP = np.array([0.0, 0.0, 1.0])


def standing(model, carried, live):
    """Truth of a forest: every block stands on one interface, under its weight and `live`.

    Dead and live load are proportional to the masses, so that all above an interface acts on it as one force
    R = alpha live - up (per weight) through the common centroid. It is carried if and only if it presses,
    lies within the Coulomb cone and passes through the polygon: the corners then share it, each within its
    cone.

    Parameters
    ----------
    carried : sequence of sets of block names
        What stands on each interface of the model, in their order.
    live : array (3,)
        Mass-proportional live load, per weight.
    """
    least, most = -np.inf, np.inf
    blocks = {block.name: block for block in model.blocks}
    for interface, names in zip(model.interfaces, carried, strict=True):
        above = [blocks[name] for name in sorted(names)]
        low, high = carrying(interface, interface.block_j in names, above, np.asarray(live, dtype=float))
        least, most = max(least, low), min(most, high)
    return known(least, most)


def known(least, most):
    """Truth where the load factors from `least` to `most`, and no others, are admissible.

    Each limit is that of one condition, so that between them all are met strictly.
    """
    if not least <= 0.0 <= most:
        return Truth("falls", interior=False)
    return Truth("unlimited" if most == np.inf else "number", float(most), least < 0.0 < most)


def carrying(interface, upwards, above, live):
    """Interval of load factors that one interface carries; `upwards`: its normal points to its load."""
    s1, s2, n = interface.axes if upwards else interface.axes * np.array([[1.0], [-1.0], [-1.0]])
    polygon = interface.polygon if upwards else (interface.polygon * (1.0, -1.0))[::-1]
    # relative to the interface: differences of large coordinates are formed once
    arms = np.array([block.centroid - interface.centroid for block in above])
    weights = np.array([block.weight for block in above])
    at = np.array([s1, s2, n]) @ (weights @ arms / weights.sum())
    v, up = np.array([s1, s2, n]) @ live, np.array([s1, s2, n]) @ UP
    # moments per weight of the constant and of the variable force, which are constant + alpha variable
    moments = np.cross(at, -up), np.cross(at, v)
    if isinstance(interface.joint, lb.OrdunaLourenco):
        return within(paper_rows(polygon, interface.joint.friction, (-up, v), moments))
    rows = [(-up[2], v[2])]  # it presses, and within each side of the polygon
    for q, r in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        along = r - q
        # the moment about the side, which is -|N| times the distance inside it
        about = q[0] * along[1] - q[1] * along[0]
        rows.append([along @ m[:2] + about * f[2] for f, m in zip((-up, v), moments, strict=True)])
    low, high = within_cone(v, up, interface.joint.friction)
    least, most = within(rows)
    return max(least, low), min(most, high)


def within(rows):
    """Interval of alpha with a + alpha b <= 0 for all rows (a, b)."""
    least, most = -np.inf, np.inf
    for a, b in rows:
        if b < 0.0:
            least = max(least, -a / b)
        elif b > 0.0:
            most = min(most, -a / b)
        elif a > 0.0:
            return np.inf, -np.inf
    return least, most


def paper_rows(polygon, friction, forces, moments):
    """Eqs (23)-(30) and (36) on a rectangle, of the constant and the variable stress resultants."""
    l1, l2 = np.abs(polygon).max(axis=0)
    d = np.hypot(l1, l2)
    # torsion per mu |N| of uniform pressure: the mean distance from the centre
    c = d / 3 + l1**2 / (6 * l2) * np.log((l2 + d) / l1) + l2**2 / (6 * l1) * np.log((l1 + d) / l2)
    Q = np.array([np.concatenate(pair) for pair in zip(forces, moments, strict=True)]).T
    V, N, M1, M2, T = Q[:2], friction * Q[2], Q[3], Q[4], Q[5]
    rows = [N + t * T / c for t in (1, -1)]
    for angle in np.pi / 4 * np.arange(8):
        shear = np.cos(angle) * V[0] + np.sin(angle) * V[1]
        rows += [shear + N, *(shear + t * T / c + 1.3 * N for t in (1, -1))]
    for a, b, t in product((1, -1), repeat=3):
        rows.append(N / 2 + (friction / 2 * (a * M1 + b * M2) + t * T) / (l1 + l2))
    return rows + [s * M1 + l2 * Q[2] for s in (1, -1)] + [s * M2 + l1 * Q[2] for s in (1, -1)]


def within_cone(v, up, friction):
    """Interval of alpha with ||(alpha v - up)_t|| <= friction (up - alpha v)_n."""
    mu2 = friction**2
    a = v[:2] @ v[:2] - mu2 * v[2] ** 2
    b = -(v[:2] @ up[:2]) + mu2 * v[2] * up[2]
    c = up[:2] @ up[:2] - mu2 * up[2] ** 2
    roots = [-c / (2 * b)] if a == 0.0 and b != 0.0 else []
    # b^2 - a c, which vanishes where v and up are parallel: no difference of squares, that would leave 1e-8
    tilted, turned = v[:2] * up[2] - up[:2] * v[2], v[0] * up[1] - v[1] * up[0]
    more = mu2 * (tilted @ tilted) - turned**2
    if a != 0.0 and more >= 0.0:
        q = -(b + np.copysign(np.sqrt(more), b))
        roots = [q / a, c / q] if q != 0.0 else [0.0]
    ends = sorted({-np.inf, *roots, np.inf, *([up[2] / v[2]] if v[2] != 0.0 else [])})
    inside = [
        (low, high)
        for low, high in pairwise(ends)
        if (x := between(low, high)) * x * a + 2 * b * x + c <= 0.0 and up[2] - x * v[2] >= 0.0
    ]
    return (inside[0][0], inside[-1][1]) if inside else (np.inf, -np.inf)


def between(low, high):
    """A number between two ends that may be infinite."""
    if np.isinf(low) and np.isinf(high):
        return 0.0
    if np.isinf(low):
        return high - 1.0 - abs(high)
    return low + 1.0 + abs(low) if np.isinf(high) else (low + high) / 2


def groove(friction, half_angle):
    """A long prism on the two faces of a groove, pushed along it; associated flow.

    Each face carries n, a shear t along the groove and q down the face: n sin w + q cos w = W/2 and
    t^2 + q^2 = mu^2 n^2. The largest t is at q = -mu^2 n cot w, the faces squeezing the prism; there is none
    if mu >= tan w. (Without dilatancy it slides at mu / sin w.)
    """
    sin, cot = np.sin(half_angle), 1.0 / np.tan(half_angle)
    if friction * cot >= 1.0:
        return np.inf
    return friction / (sin * np.sqrt(1.0 - (friction * cot) ** 2))


def pushing(friction, weights):
    """Low blocks in a row on a floor, smooth where they touch, pushed along the row; the last is in front.

    Each can drive those before it but not pull those behind: the blocks from any one to the front slide
    together at the mean of their frictions, by weight; the least of these means is the load factor.
    """
    resistance, weight = np.multiply(friction, weights)[::-1], np.asarray(weights)[::-1]
    return float((np.cumsum(resistance) / np.cumsum(weight)).min())
