"""Least thickness of arches and lunes: from blocks, by root finding; from thrust lines, without blocks."""

import numpy as np
from scipy.integrate import cumulative_simpson
from scipy.optimize import brentq, linprog

import limitblocks as lb


def least_thickness(build, start, *, change=lambda model: model, small=1e-5):
    """Return the thickness at which build(thickness) just stands, from above.

    There the load factor of a horizontal load proportional to the weight goes to zero, with a finite slope.
    The secant stops short of zero by a tenth, since there is no load factor below it.
    """

    def load_factor(thickness):
        return lb.bounds(change(build(thickness))).lower

    before, t = start, 0.998 * start
    old, new = load_factor(before), load_factor(t)
    while new > small:
        step = 0.9 * new * (before - t) / (old - new)
        before, old = t, new
        while True:
            try:
                new = load_factor(before - step)
            except lb.errors.NoEquilibrium:
                step /= 2
            else:
                break
        t = before - step
    return t - new * (before - t) / (old - new)


def stands(model):
    """Whether the dead loads stand, each answer proven by a stress state or a mechanism."""
    try:
        lb.bounds(model)
    except lb.errors.NoEquilibrium:
        return False
    return True


def thrust_line_margin(inner, outer, weight, moment):
    """Largest margin of a thrust line within half of a symmetrical arch, over its weight; negative: none.

    Heyman's assumptions: no tension, no crushing, no sliding. `inner` and `outer` (n, 2) are the ends of
    the cuts of the right half; `weight` and `moment` (n,) the weight from the crown to a cut, and its first
    moment about the middle. The crown thrust H acts at the height M / H: moments about the ends of every cut
    have opposite signs.
    """
    total = weight[-1]

    def moments(points):
        """Coefficients of (M, H) and the constant of the moment about points."""
        rows = np.column_stack([-np.ones(len(points)), points[:, 1]])
        return rows, (weight * points[:, 0] - moment) / total

    (a, p), (b, q) = moments(inner), moments(outer)
    ones = np.ones((len(a), 1))
    rows = np.vstack([np.hstack([a, ones]), np.hstack([-b, ones])])
    values = linprog([0, 0, -1], rows, np.concatenate([-p, q]), bounds=[(0, None), (0, None), (None, None)])
    return values.x[2]


def circular_half(thickness, *, radius=1.0, shift=0.0, embrace=np.pi, cuts=4001, lumped=False):
    """Right half of a circular ring, or of a pointed one whose centres lie `shift` beyond the middle."""
    s, share = np.polynomial.legendre.leggauss(20)
    s, share = s * thickness / 2 * (0 if lumped else 1) + radius, share * thickness / 2
    first = np.arcsin(shift / s)  # each circle meets the middle at an angle of its own
    angle = np.linspace(np.arcsin(shift / (radius - thickness / 2)), embrace / 2, cuts)[:, None]
    weight = (share * s) * (angle - first)
    moment = (share * s) * (s * (np.cos(first) - np.cos(angle)) - shift * (angle - first))
    ends = [
        r * np.column_stack([np.sin(angle), np.cos(angle)]) - (shift, 0.0)
        for r in (radius - thickness / 2, radius + thickness / 2)
    ]
    if shift:  # the joint at the apex is vertical
        apex = [(0.0, np.sqrt(r**2 - shift**2)) for r in (radius - thickness / 2, radius + thickness / 2)]
        ends = [np.vstack([top, end]) for top, end in zip(apex, ends, strict=True)]
        weight, moment = (np.vstack([np.zeros_like(part[:1]), part]) for part in (weight, moment))
    return *ends, weight.sum(axis=1), moment.sum(axis=1)


def vertical_half(thickness, *, cuts=4001):
    """Right half of a semicircle of radius 1 with vertical cuts down to the intrados, then the springing."""
    x = (1 - thickness / 2) * np.sin(np.linspace(0.0, np.pi / 2, cuts))
    x = np.append(x, 1 + thickness / 2)  # all beyond the last vertical cut bears on the springing
    ends, weight, moment = [], 0.0, 0.0
    for r, sign in ((1 - thickness / 2, -1), (1 + thickness / 2, 1)):
        at = np.minimum(x, r)
        height = np.sqrt(np.maximum(r**2 - at**2, 0.0))
        ends.append(np.column_stack([at, height]))
        weight = weight + sign * (at * height + r**2 * np.arcsin(at / r)) / 2
        moment = moment + sign * (r**3 - height**3) / 3
    return *ends, weight, moment


def elliptical_half(thickness, *, a, b, cuts=4001):
    """Right half of a ring about an ellipse of half axes a and b."""
    angle = np.linspace(0.0, np.pi / 2, cuts)
    normal = np.column_stack([np.sin(angle), np.cos(angle)])
    reach = np.hypot(a * normal[:, 0], b * normal[:, 1])
    line = normal * (a**2, b**2) / reach[:, None]
    curvature = a**2 * b**2 / reach**3
    weight = cumulative_simpson(curvature * thickness, x=angle, initial=0)
    arm = line[:, 0] * curvature * thickness + normal[:, 0] * thickness**3 / 12
    ends = (line - normal * thickness / 2, line + normal * thickness / 2)
    return *ends, weight, cumulative_simpson(arm, x=angle, initial=0)


def least_thickness_of_thrust_lines(half, low, high):
    """Return the thickness between `low` and `high` at which half(thickness) just holds a thrust line."""
    return brentq(lambda thickness: thrust_line_margin(*half(thickness)), low, high, xtol=1e-9)
