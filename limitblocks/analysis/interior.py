"""Stresses strictly within yield that carry the dead loads: they ask for room, not for accuracy."""

from __future__ import annotations

import numpy as np

from limitblocks.analysis.direct import Programs
from limitblocks.analysis.forms import Stresses
from limitblocks.analysis.in_plane import in_plane
from limitblocks.analysis.programs import DIRECT
from limitblocks.analysis.scales import scaled
from limitblocks.analysis.splitting import Splitting
from limitblocks.arrays import Array, read_only
from limitblocks.evidence.residuals import TOLERANCE, Residuals, static_residuals
from limitblocks.known import known
from limitblocks.problem import LimitProblem

ROUGH = DIRECT.having({"tol_gap_abs": 1e-4, "tol_gap_rel": 1e-4, "tol_feas": 1e-4})


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
    for found in (splitting.stresses, lambda: farthest_within(splitting)):
        x, p = found(), splitting.p
        if x is None:
            continue
        x = p.stress * x if plane is None else np.asarray(plane.stresses @ (p.stress * x))
        with np.errstate(over="ignore", invalid="ignore"):  # friction 1e-300: nothing is within
            within = problem.cones.margin(problem.F @ x + problem.g).min(initial=np.inf) > 0.0
            if within and Residuals(static_residuals(problem, 0.0, x)).worst.value <= TOLERANCE:
                return read_only(x)
    return None


def farthest_within(splitting: Splitting) -> Array | None:
    """Return stresses about as far within yield as there are under the dead loads, (s,); None if none.

    By one program to 1e-4, brought into equilibrium as far as rounding lets it: residuals judge that. Where
    there is little room the splitting ends with a tenth of it or less, after hundreds of rounds
    (docs/solvers.md).
    """
    form = Stresses(splitting.p)
    v, _ = Programs(form).solved(form.within(splitting.p.dead), ROUGH)
    found = np.isfinite(v).all()
    return splitting.projection.onto(splitting.p.dead, v[1:]) if found else None
