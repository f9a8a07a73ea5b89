"""Load factors known by formula: blocks that each stand on one other, grooves, neighbours that push."""

from itertools import pairwise

import numpy as np
from coulomb import Truth

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
    """Truth where the load factors from `least` to `most`, and no others, are admissible."""
    if not least <= 0.0 <= most:
        return Truth("falls", interior=False)
    return Truth("unlimited" if most == np.inf else "number", float(most))


def carrying(interface, upwards, above, live):
    """Interval of load factors that one interface carries; `upwards`: its normal points to its load."""
    s1, s2, n = interface.axes if upwards else interface.axes * np.array([[1.0], [-1.0], [-1.0]])
    polygon = interface.polygon if upwards else (interface.polygon * (1.0, -1.0))[::-1]
    # relative to the interface: differences of large coordinates are formed once
    arms = np.array([block.centroid - interface.centroid for block in above])
    weights = np.array([block.weight for block in above])
    x1, x2, height = np.array([s1, s2, n]) @ (weights @ arms / weights.sum())
    v, up = np.array([s1, s2, n]) @ live, np.array([s1, s2, n]) @ UP
    # a linear function a + b alpha >= 0 for each side, inside being on its left, and one for pressure
    linear = [(up[2], -v[2])]
    for q, r in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        inward = np.array([q[1] - r[1], r[0] - q[0]])
        d = inward @ (np.array([x1, x2]) - q)
        linear.append((d * up[2] - height * inward @ up[:2], -d * v[2] + height * inward @ v[:2]))
    least, most = -np.inf, np.inf
    for a, b in linear:
        if b > 0.0:
            least = max(least, -a / b)
        elif b < 0.0:
            most = min(most, -a / b)
        elif a < 0.0:
            return np.inf, -np.inf
    low, high = within_cone(v, up, interface.joint.friction)
    return max(least, low), min(most, high)


def within_cone(v, up, friction):
    """Interval of alpha with ||(alpha v - up)_t|| <= friction (up - alpha v)_n."""
    mu2 = friction**2
    a = v[:2] @ v[:2] - mu2 * v[2] ** 2
    b = -(v[:2] @ up[:2]) + mu2 * v[2] * up[2]
    c = up[:2] @ up[:2] - mu2 * up[2] ** 2
    roots = [-c / (2 * b)] if a == 0.0 and b != 0.0 else []
    if a != 0.0 and b * b >= a * c:
        q = -(b + np.copysign(np.sqrt(b * b - a * c), b))
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
