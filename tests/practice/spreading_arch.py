"""The settlement at collapse of an arch on spreading supports by another program: three hinges, statics.

Written from radius and angles, with nothing of the library. The reasoning is that of Ochsendorf (2002, 2006):
a spreading arch has hinges at the extrados of the crown and at the intrados of a joint on each side; it falls
when the line of thrust reaches the extrados of the springing, its fourth hinge.
"""

import numpy as np
from scipy.optimize import brentq


def half_ring(voussoirs, thickness):
    """Intrados and extrados corners of the left half from springing to crown; areas and centroids between.

    A semicircle of radius 1 with straight-edged voussoirs.
    """
    return ring(np.linspace(np.pi, np.pi / 2, voussoirs // 2 + 1), thickness)


def ring(angles, thickness):
    """The same between joints at any angles."""
    joints = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    inner, outer = (1 - thickness / 2) * joints, (1 + thickness / 2) * joints
    areas, centres = [], []
    for k in range(len(angles) - 1):
        x, z = np.array([inner[k], outer[k], outer[k + 1], inner[k + 1]]).T
        twice = x * np.roll(z, -1) - np.roll(x, -1) * z
        areas.append(abs(twice.sum()) / 2)
        centres.append([((a + np.roll(a, -1)) * twice).sum() / (3 * twice.sum()) for a in (x, z)])
    return inner, outer, np.array(areas), np.array(centres)


def three_hinged(voussoirs, thickness, spread, hinge):
    """Thrust over weight, and where its line cuts each joint: 0 at the intrados, 1 at the extrados.

    Hinges at the extrados of the crown and the intrados of joint `hinge` from each springing; the part
    between turns about the latter until the crown hinge is over the middle of the spread arch.
    """
    inner, outer, areas, centres = half_ring(voussoirs, thickness)
    foot, arm = inner[hinge], outer[-1] - inner[hinge]
    turn = np.arccos((arm[0] + spread / 2) / np.hypot(*arm)) - np.arctan2(arm[1], arm[0])
    rotation = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])

    def at(points, moves):
        return np.where(moves[:, None], (points - foot) @ rotation.T + foot, points)

    k = np.arange(len(inner))
    crown = at(outer, k > hinge)[-1]
    inner, outer, centres = at(inner, k > hinge), at(outer, k > hinge), at(centres, k[:-1] >= hinge)
    thrust = areas[hinge:] @ (centres[hinge:, 0] - foot[0]) / (crown[1] - foot[1])

    def moments(points):  # of all that is above each joint
        own = [areas[j:] @ (centres[j:, 0] - points[j, 0]) for j in range(len(points))]
        return np.array(own) - thrust * (crown[1] - points[:, 1])

    a, b = moments(inner), moments(outer)
    return thrust / (2 * areas.sum()), a / (a - b)


def beside_the_crown(voussoirs, thickness, spread, left, right):
    """Of a ring with a stone at the crown: thrust over weight, and where it cuts the left springing.

    One hinge is at the extrados of the joint to the right of that stone, two at the intrados of joints `left`
    and `right` from the springings. Two bodies turn until the hinges are as far from one another as before.
    """
    inner, outer, areas, centres = ring(np.linspace(np.pi, 0.0, voussoirs + 1), thickness)
    inner, outer, centres = (
        points @ [1.0, 1j] for points in (inner, outer, centres)
    )  # a rotation is a factor
    crown, last = voussoirs // 2 + 1, voussoirs - right
    a, b, c = inner[left], inner[last] + spread, outer[crown]
    r, s, base = abs(c - a), abs(c - inner[last]), abs(b - a)
    along = (r**2 - s**2 + base**2) / (2 * base)
    top = a + (along + 1j * np.sqrt(r**2 - along**2)) * (b - a) / base

    w1, w2 = areas[left:crown], areas[crown:last]
    first = w1 @ (a + (centres[left:crown] - a) * (top - a) / (c - a)).real
    second = w2 @ (b + (centres[crown:last] - inner[last]) * (top - b) / (c - inner[last])).real
    moments = np.array([[(b - a).real, (a - b).imag], [(top - a).real, (a - top).imag]])  # about b and top
    loads = [b.real * (w1.sum() + w2.sum()) - first - second, top.real * w1.sum() - first]
    upwards, thrust = np.linalg.solve(moments, loads)

    def moment(point):  # of all that is above the left springing
        own = areas[:left] @ (centres[:left].real - point.real)
        return own + upwards * (a - point).real - thrust * (a - point).imag

    cut = moment(inner[0]) / (moment(inner[0]) - moment(outer[0]))
    return thrust / areas.sum(), cut


def first_hinge(voussoirs, thickness):
    """Joint of the intrados hinge: the one with which the thrust, at no spread, is greatest."""
    return int(np.argmax([three_hinged(voussoirs, thickness, 0.0, k)[0] for k in range(voussoirs // 2)]))


def fourth_hinge(voussoirs, thickness):
    """Spread over the radius at which the thrust reaches the extrados of the springing.

    The arch has to be such that the three hinges stay where they are: the thrust leaves no joint before.
    """
    hinge = first_hinge(voussoirs, thickness)

    def left(spread):
        return three_hinged(voussoirs, thickness, spread, hinge)[1][0] - 1.0

    inner, outer, *_ = half_ring(voussoirs, thickness)
    most = 2 * (np.hypot(*(outer[-1] - inner[hinge])) + inner[hinge][0]) - 1e-9
    spread = brentq(left, 1e-9, most, xtol=1e-14)
    for before in np.linspace(1e-9, spread, 25):
        cut = three_hinged(voussoirs, thickness, before, hinge)[1]
        assert (cut > -1e-9).all(), "another intrados hinge"
        assert (cut < 1 + 1e-9).all(), "another extrados hinge"
    return spread
