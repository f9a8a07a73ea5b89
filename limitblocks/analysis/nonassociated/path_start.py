"""The start of a path: one small elastic step from the permanent-load stresses, centred at its theta."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from hashlib import blake2b

import numpy as np

from limitblocks.analysis.nonassociated.path_equations import Barrier, Path, Point, distance, moved, residuals
from limitblocks.analysis.nonassociated.path_layout import Layout
from limitblocks.analysis.nonassociated.path_measures import Measures, by_compliance
from limitblocks.analysis.nonassociated.path_newton import Newton
from limitblocks.arrays import Array, positions
from limitblocks.errors import SolveError
from limitblocks.evidence.elimination import Factors
from limitblocks.problem import Flow, LimitProblem
from limitblocks.problem.barrier import quotient

# Of the logarithms of the weights: from interface to interface, and from row to row of one. Where rows of an
# interface have one weight its path ends at a centre of several solutions, and no step succeeds at last.
SPREAD, AMONG_ROWS = 0.6, 0.1
GOLDEN = (np.sqrt(5.0) - 1.0) / 2.0  # whose multiples spread evenly
INSIDE = 0.1  # least distance of the first slacks from the boundary, of their measure
ITERATIONS = 60
FALLS = 0.1  # barrier after a step: of 93 models .03 misses one, .3 takes 1.1 times the factorisations
HELD = 1e-9  # of the largest stiffness: springs on what nothing else holds


def path_from(
    flow: Flow,
    x0: Array,
    weights: Array,
    barrier: Barrier,
    seed: int,
    power: float = 1.0,
    share: Array | float = 1.0,
    measured: Callable[[LimitProblem, Array, float], Measures] = by_compliance,
) -> Path:
    """Return the path from stresses x0; rho0 makes it start with a load factor of `power` on elastic joints.

    Parameters
    ----------
    flow : Flow
        The limit problem and its flow rule.
    x0 : Array, shape (s,)
        Stresses under the permanent loads, dimensionless.
    weights : Array, shape (s,)
        Compliance W of the joints.
    barrier : Barrier
        How compliance and barrier fade.
    seed : int
        Of the weights of the products, all one for seed 0, else drawn by the names of the interfaces: another
        seed is another path.
    power : float
        Unit of the barrier's size and of the first load factor, dimensionless.
    share : Array, shape (R,)
        Of the barrier, in each row: of rows that stand for several more than one.
    measured : callable
        What gives the measures of the path, of its problem, rho0 W and power.
    """
    p, layout = flow.problem, Layout(flow)
    C = layout.compatibility
    lu = _elastic(layout, np.swapaxes(C, 1, 2) @ (layout.per_interface(1.0 / weights)[:, :, None] * C))
    # -K u + a live = 0 and live.u = 1: a is one over the elastic work of the unit live load
    rho0 = float(lu.solve(np.append(np.zeros(p.C.shape[1]), 1.0))[-1]) / power
    logarithms = np.zeros(p.cones.degree)
    if seed:
        logarithms = _drawn(p, seed)
    logarithms[~layout.sliding] += np.log(barrier.opening)
    products = share * np.exp(logarithms)[p.cones.member] * p.cones.identity
    elastic = rho0 * weights
    own = measured(p, elastic, power)
    return Path(flow, layout, barrier, products, elastic, x0, np.zeros_like(x0), own)


def _drawn(problem: LimitProblem, seed: int) -> Array:
    """Logarithms of weights of rows and cones, by the names of interfaces, whichever block comes first."""
    names = (f"{seed} {sorted(name.split('|'))}".encode() for name in problem.interfaces)
    digests = b"".join(blake2b(name, digest_size=8).digest() for name in names)
    own = (np.frombuffer(digests, "<u8") / 2.0**64)[problem.member_interface]
    place = positions(problem.member_interface)
    return np.asarray(SPREAD * (2.0 * own - 1.0) + AMONG_ROWS * (2.0 * ((own + GOLDEN * place) % 1.0) - 1.0))


def _elastic(layout: Layout, stiffness: Array) -> Factors:
    """Factors of the elastic step; weak springs hold what slides on joints without friction."""
    for held in (0.0, HELD * float(stiffness.max())):
        try:
            return layout.factors(stiffness + held * np.eye(stiffness.shape[2]))
        except RuntimeError:  # SuperLU: singular
            continue
        except np.linalg.LinAlgError:
            raise SolveError(
                "the loads have sizes that numbers of 64 bits do not hold side by side, or nothing acts on "
                "some blocks: no elastic step"
            ) from None
    raise SolveError("the live load moves blocks that no joint holds: every solution has the load factor 0")


def centred(path: Path, theta: float = 1.0, until: float | None = None) -> tuple[Point | None, int]:
    """Return the first point of the path, None if Newton's method finds none, and the factorisations used.

    Or that at `until`, where compliance stays: steps lower the barrier once products are positive.
    """
    p, cones, last = path.flow.problem, path.cones, theta if until is None else until
    rows = p.F @ path.x0 + p.g
    unit = path.measures.slack
    s = rows + unit * np.maximum(0.0, INSIDE - cones.margin(rows / unit))[cones.member] * cones.identity
    z = Point(path.x0, np.zeros(p.C.shape[1]), 0.0, s, quotient(cones, s, path.target(theta)), theta)
    for k in range(ITERATIONS):
        left = residuals(path, z)
        off = distance(path, z, left) if k else np.inf
        if off <= 1.0 and z.theta <= last:
            return z, k
        aim = max(FALLS * z.theta, last) if off < np.inf else z.theta
        products = (1.0 - aim / z.theta) * z.y  # L(s)^-1 times s o y less its target
        (step,) = Newton(path, z).solve(replace(left, multiplier=products))
        z = moved(path, z, 1.0, replace(step, theta=aim - z.theta))
    return None, ITERATIONS
