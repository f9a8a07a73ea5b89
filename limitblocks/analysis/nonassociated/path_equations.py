"""Equations of a tracked path and their residuals.

    rho W (x - x0) = C u + G(x)^T y + theta r,   dead + a live = C^T x,   live . u = 1,
    F x + g = s,   s o y = mu w,   s, y in int K,        rho = rho0 max(theta^p, floor),   mu = mu0 theta

At theta = 1 it is a small step of rigid blocks on joints of compliance W from the stresses x0, at theta = 0
Eqs (54)-(59). The weights w of rows and cones are random where a seed is given: they break the symmetry of
structures whose paths would branch (Chow, Mallet-Paret & Yorke 1978, Math. of Computation 32). Every point
satisfies the products exactly: a move changes v = s / sigma - sigma y and takes s and y back from it, so that
a row that starts or stops to yield is no boundary of the step. What is large on the way is told by the
compliance, not by the units of the numbers. Where rho has reached its floor, x0 moves on
with x, else the stresses of rigid parts lose their equations; r carries the jump that this would make and
fades with theta.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from limitblocks.analysis.nonassociated.path_layout import Layout
from limitblocks.analysis.nonassociated.path_measures import Measures
from limitblocks.arrays import Array
from limitblocks.mechanics.loads.load import number
from limitblocks.problem import Cones, Flow, State
from limitblocks.problem.barrier import central, curvature, spread

LEAST_THETA = 0.05  # part of theta that a move leaves
MOST_THETA = 3.0  # and its largest growth
WIDE = float(np.log(5.0))  # how far a product may be from its target, logarithm of the quotient
FLOW = 0.05  # of theta: how far off the flow may be, in strains of its measure
# Where the compliance stays, on the way to the point asked for: the flow may be off by a share of the strains
# of stresses of their measure, but products are closer to their targets, or some points have no successor.
# By this alone 234 load paths take .8 of the time, and 245 of 278 converge where 234 did.
LAX, CLOSER = 1e-4, float(np.log(1.5))
ROUNDING = 4.0 * float(np.finfo(float).eps)  # of the stresses: what the compliance makes of it is no error


@dataclass(frozen=True)
class Barrier:
    """How compliance and barrier fade along a path: mu = size theta, rho = rho0 max(theta^power, floor).

    A small barrier follows the loading of joints of compliance W; a large one leads to another solution of
    the set, mostly at a higher load factor, with fewer folds. Rows that flow along their normal, of what
    opens, hinges or crushes, have the share `opening` of it: .3 of a large one leaves fewer folds still.
    """

    size: float = 0.02
    power: float = 1.0
    floor: float = 1e-6
    opening: float = 1.0

    def __post_init__(self) -> None:
        number(self.size, "size of the barrier", "", above=0.0)
        number(self.power, "power of the barrier", "", least=0.0)
        number(self.floor, "floor of the barrier", "", least=0.0)
        number(self.opening, "opening of the barrier", "", above=0.0)


@dataclass(frozen=True, eq=False)
class Point:
    """Variables of a path, or a direction: stresses, rates, load factor, slacks, multipliers, theta."""

    x: Array
    u: Array
    load_factor: float
    s: Array
    y: Array
    theta: float = 0.0

    @property
    def state(self) -> State:
        """The point without slacks and theta."""
        return State(self.load_factor, self.x, self.u, self.y)

    def moved(self, t: float, d: Point) -> Point:
        """Return this point moved by t along the direction d."""
        return Point(
            self.x + t * d.x,
            self.u + t * d.u,
            self.load_factor + t * d.load_factor,
            self.s + t * d.s,
            self.y + t * d.y,
            self.theta + t * d.theta,
        )

    def scaled(self, t: float) -> Point:
        """Return this direction t times as long."""
        return Point(t * self.x, t * self.u, t * self.load_factor, t * self.s, t * self.y, t * self.theta)


@dataclass(frozen=True, eq=False)
class Path:
    """What fixes a path: flow, barrier, weights w (R,), rho0 W, and x0 with the residual r it carries.

    The power of its measures is the unit of the barrier's size. Increments may count tau = 1 / rho from
    `behind` before x0: live . u = 1 - behind rho.
    """

    flow: Flow
    layout: Layout
    barrier: Barrier
    weights: Array
    elastic: Array
    x0: Array
    carried: Array
    measures: Measures
    behind: float = 0.0

    @property
    def cones(self) -> Cones:
        """The cone K."""
        return self.flow.problem.cones

    def rho(self, theta: float) -> float:
        """Share of the elastic compliance at theta."""
        return float(max(theta**self.barrier.power, self.barrier.floor))

    def at_floor(self, theta: float) -> bool:
        """Whether rho has reached its floor."""
        return bool(theta**self.barrier.power <= self.barrier.floor)

    def target(self, theta: float) -> Array:
        """Products s o y of the path at theta, shape (R,)."""
        return self.barrier.size * self.measures.power * theta * self.weights


@dataclass(frozen=True, eq=False)
class Equations:
    """What is left of the equations of a path: flow, equilibrium, normalisation, slacks, products.

    `multiplier` is L(s)^-1 times what is left of the products.
    """

    flow: Array
    balance: Array
    work: float
    slack: Array
    multiplier: Array


def residuals(path: Path, z: Point) -> Equations:
    """Return the residuals at a point, of which the products are exact."""
    p = path.flow.problem
    elastic = path.rho(z.theta) * path.elastic * (z.x - path.x0)
    return Equations(
        elastic - p.C @ z.u - path.layout.potential(z.x) @ z.y - z.theta * path.carried,
        p.dead + z.load_factor * p.live - path.layout.balance @ z.x,
        float(p.live @ z.u - 1.0 + path.behind * path.rho(z.theta)),
        p.F @ z.x + p.g - z.s,
        np.zeros_like(z.y),
    )


def theta_slope(path: Path, z: Point) -> Equations:
    """Return the derivative of the residuals by theta."""
    p, power = path.flow.problem, path.barrier.power
    rho = 0.0 if path.at_floor(z.theta) else power * z.theta ** (power - 1.0)
    flow = rho * path.elastic * (z.x - path.x0) - path.carried
    return Equations(flow, np.zeros_like(p.dead), path.behind * rho, np.zeros_like(z.s), -z.y / z.theta)


def distance(path: Path, z: Point, left: Equations, lax: bool = False) -> float:
    """Return how far a point is from the path, products by the slack F x + g; at most one is near.

    A `lax` one may be farther off where the compliance stays: theta says nothing of the flow there.
    """
    rounding = ROUNDING * path.rho(z.theta) * path.elastic * np.abs(z.x)
    flow = FLOW * z.theta * (1.0 - path.behind) * path.measures.strain + rounding
    lax = lax and not path.barrier.power
    flow += LAX * path.elastic * path.measures.stress if lax else 0.0
    off = float((np.abs(left.flow) / flow).max())
    far = spread(path.cones, z.s + left.slack, z.y, path.target(z.theta))
    return max(off, far / (CLOSER if lax else WIDE))


def moved(path: Path, z: Point, t: float, d: Point) -> Point:
    """Return the point moved by t along d, or as far as theta may change, on the products of its theta."""
    if d.theta:
        change = (LEAST_THETA if d.theta < 0.0 else MOST_THETA) - 1.0
        t = min(t, change * z.theta / d.theta)
    ahead = z.moved(t, d)
    # balances the sizes of slacks and multipliers, which decides what counts as large
    unit = path.measures.slack
    s, y = z.s / unit, z.y * unit
    sigma = float(np.sqrt(np.sqrt(s @ s) / np.sqrt(y @ y))) * unit
    s, y = central(path.cones, ahead.s / sigma - sigma * ahead.y, path.target(ahead.theta))
    return Point(ahead.x, ahead.u, ahead.load_factor, sigma * s, y / sigma, ahead.theta)


def moved_on(path: Path, z: Point) -> Path:
    """Return the path through the same points with x0 := x once rho is at its floor."""
    if not path.at_floor(z.theta):
        return path
    jump = path.rho(z.theta) * path.elastic * (z.x - path.x0) / z.theta
    return replace(path, x0=z.x, carried=path.carried - jump)


class Covector(NamedTuple):
    """What takes directions to their product with one: mean of the relative changes of s and y, and of theta.

    `theta` is that of the direction, `at` that of the point.
    """

    s: Array
    y: Array
    theta: float
    at: float
    degree: int

    def of(self, b: Point) -> float:
        """Return the product with a direction."""
        return float(self.s @ b.s + self.y @ b.y) / self.degree + self.theta * b.theta / self.at**2

    def scaled(self, t: float) -> Covector:
        """Return that of the direction t times as long."""
        return self._replace(s=t * self.s, y=t * self.y, theta=t * self.theta)


class Base(NamedTuple):
    """Where predictors start: a point near the path, its last correction, its tangent, products with it."""

    point: Point
    correction: Point
    tangent: Point
    ahead: Covector


def covector(cones: Cones, z: Point, a: Point) -> Covector:
    """Return what takes directions at z to their product with one of them."""
    return Covector(curvature(cones, z.s, a.s), curvature(cones, z.y, a.y), a.theta, z.theta, cones.degree)


def inner(cones: Cones, z: Point, a: Point, b: Point) -> float:
    """Return the product of two directions."""
    return covector(cones, z, a).of(b)
