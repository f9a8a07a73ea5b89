"""Stresses strictly within yield that carry the dead loads: they ask for room, not for accuracy."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from limitblocks.analysis.direct import Programs
from limitblocks.analysis.forms import Stresses
from limitblocks.analysis.in_plane import in_plane
from limitblocks.analysis.programs import DIRECT, Solver
from limitblocks.analysis.scales import scaled
from limitblocks.analysis.splitting import Splitting
from limitblocks.arrays import Array, Flags, read_only, tied
from limitblocks.evidence.residuals import TOLERANCE, Residuals, static_residuals
from limitblocks.evidence.rounding import EPS
from limitblocks.known import known
from limitblocks.problem import LimitProblem, in_units

ROUGH = DIRECT.having({"tol_gap_abs": 1e-4, "tol_gap_rel": 1e-4, "tol_feas": 1e-4})
HALF = 0.5  # of what is 0 or 1


def carried(problem: LimitProblem, splitting: Splitting | None = None) -> Array | None:
    """Return stresses strictly within yield that carry the dead loads, (s,); None where none were found.

    Parameters
    ----------
    problem : LimitProblem
        The whole problem.
    splitting : Splitting, optional
        Of the problem, reduced by its mirror if it has one, where it is at hand.
    """
    return known(problem, "stresses within yield", lambda: _carried(problem, splitting))


def _carried(problem: LimitProblem, splitting: Splitting | None) -> Array | None:
    plane = in_plane(problem)  # strictly within its rows is strictly within those that they imply
    splitting = splitting or Splitting(scaled(problem if plane is None else plane.problem))
    ways = (splitting.stresses, lambda: farthest_within(splitting), lambda: where_they_can(splitting))
    for found in ways:
        x, p = found(), splitting.p
        if x is None:
            continue
        x = p.stress * x if plane is None else np.asarray(plane.stresses @ (p.stress * x))
        with np.errstate(over="ignore", invalid="ignore"):  # friction 1e-300: nothing is within
            within = not (_without_room(problem, x) & ~_bare(problem, x)).any()
            if within and Residuals(static_residuals(problem, 0.0, x)).worst.value <= TOLERANCE:
                return read_only(x)
    return None


def farthest_within(splitting: Splitting, solver: Solver = ROUGH) -> Array | None:
    """Return stresses about as far within yield as there are under the dead loads, (s,); None if none.

    By one program to 1e-4, brought into equilibrium as far as rounding lets it: residuals judge that. Where
    there is little room the splitting ends with a tenth of it or less, after hundreds of rounds
    (docs/solvers.md).
    """
    form = Stresses(splitting.p)
    v, _ = Programs(form).solved(form.within(splitting.p.dead), solver)
    found = np.isfinite(v).all()
    return splitting.projection.onto(splitting.p.dead, v[1:]) if found else None


def where_they_can(splitting: Splitting) -> Array | None:
    """Return stresses within yield under the dead loads, none at joints where they cannot be strictly, (s,).

    As where stones without weight alone press: such joints carry nothing, exactly. None if none are found.
    """
    form, p = Stresses(splitting.p), splitting.p.problem
    v, _ = Programs(form).solved(form.carrying(), DIRECT)
    carry = np.asarray(1.0 * (v[1 : 1 + len(p.interfaces)] > HALF)[p.stress_interface], dtype=float)
    C, F = in_units(p.C, carry, np.ones_like(p.dead)), in_units(p.F, np.ones_like(p.g), carry)
    for matrix in (C, F):
        matrix.eliminate_zeros()
    x = farthest_within(Splitting(scaled(replace(p, C=C, F=F))), DIRECT)
    return None if x is None else carry * x


def opening_where_it_can(splitting: Splitting, amount: Array) -> tuple[Array, Array] | None:
    """Return rates and multipliers of a mechanism that opens joints by about `amount` (R,); None if none.

    By one program, where the splitting finds none in its rounds: strong joints have to crush, or stones are
    wedged. Those that are wedged between supports, or such stones, do not move, exactly.
    """
    p, form = splitting.p, Stresses(splitting.p)
    v, _ = Programs(form).solved(form.opening(amount), DIRECT)
    if not np.isfinite(v).all():
        return None
    m, n, ends = len(p.problem.interfaces), len(p.problem.blocks), p.problem.ends
    part = tied(np.where(ends < 0, n, ends)[~(v[:m] > HALF)], n + 1)  # the supports are the last one
    moving = part != part[n]
    moves = moving[ends].any(axis=1)[p.problem.row_interface]
    return v[m : m + 6 * n] * np.repeat(moving[:n], 6), v[m + 6 * n :] * moves


def carrying(problem: LimitProblem, x: Array) -> Flags:
    """Return whether each stress of x (s,) is one of a joint that carries anything, or has room for it."""
    bare = _bare(problem, x)
    if bare.any():
        bare &= _without_room(problem, x)
    return np.asarray(~bare[problem.stress_interface])


def _bare(problem: LimitProblem, x: Array) -> Flags:
    """Whether all stresses (s,) of each interface are zero, shape (m,)."""
    return np.asarray(np.bincount(problem.stress_interface, x != 0.0, len(problem.interfaces)) == 0)


def _without_room(problem: LimitProblem, x: Array) -> Flags:
    """Whether stresses (s,) are on yield, to rounding, or beyond it at each interface, shape (m,)."""
    rows = (problem.F @ x + problem.g) / scaled(problem).row
    outside = ~(problem.cones.margin(rows) > EPS)
    return np.asarray(np.bincount(problem.member_interface, outside, len(problem.interfaces)) > 0)
