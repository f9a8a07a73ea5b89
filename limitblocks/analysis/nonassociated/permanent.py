"""State of the permanent loads: what joints bear once the dead loads are put on unstressed blocks.

One implicit step of joints of compliance W, with the flow of the analysis:

    W x = C u + G^T y,   dead = C^T x,   F x + g in K,   y in K*,   (F x + g) o y = 0

(:mod:`limitblocks.analysis.unstressed`). Where joints that never yield bear the dead loads within yield, that
is what arises, y = 0. For associated flow, G = F, it is the state of least norm x^T W x.
Such a state leans on dilatancy: a stone between two heavy ones gives them part of its weight, for which they
have to be pressed apart, and then friction at its sides resists the live load as well.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from limitblocks.analysis.nonassociated.least_norm import least_state
from limitblocks.analysis.unstressed import at_once, elastic_displacements, in_rounds, joint_compliance
from limitblocks.arrays import Array
from limitblocks.evidence.residuals import Residuals, static_residuals
from limitblocks.evidence.stability_result import TOLERANCE as ARISEN
from limitblocks.evidence.stability_result import arising_residuals
from limitblocks.known import known
from limitblocks.problem import Flow, LimitProblem, State, Turning

DILATES = 1e-6  # of the elastic energy: from 1e-4 on where stresses change, up to 1e-10 elsewhere
ADMISSIBLE = 1e-8  # residual of equilibrium and yield


def permanent_state(flow: Flow, weights: Array) -> Array | None:
    """Return the stresses under the dead loads that joints of compliance `weights` bear, (s,).

    Where no path leads to any, as where nothing but self-stress holds a block, those of least norm; None
    where there are none either. What twists turns about the centroid. The same to the last digit whichever
    analysis asks first.
    """
    return _known(flow, weights)[0]


def arose(flow: Flow, weights: Array) -> bool:
    """Whether the stresses of `permanent_state` arise by themselves, or flow is associated."""
    return _known(flow, weights)[1]


def _known(flow: Flow, weights: Array) -> tuple[Array | None, bool]:
    ratios = np.round(weights / flow.problem.compliance, 9)
    flow = replace(flow, turning=Turning.CENTROID)
    kept = ("permanent state", ratios.tobytes(), flow.dilatancy)
    return known(flow.problem, kept, lambda: _found(flow, ratios * flow.problem.compliance))


def _found(flow: Flow, weights: Array) -> tuple[Array | None, bool]:
    """The stresses, and whether they arise by themselves."""
    p = flow.problem
    u = elastic_displacements(p, weights)
    elastic = p.C @ u / weights
    if _admissible(p, elastic):
        return elastic, True
    if not p.cones.second_order or flow.associated or not p.dead.any():  # planes cost little
        least = least_state(p, weights)
        if least is not None and not _dilates(flow, weights, least):
            return least.x, True
    found = at_once(flow, joint_compliance(p, weights, u))
    if found is not None and _admissible(p, found.x):
        return found.x, True
    found = least_state(p, weights)
    if found is None:
        return None, False
    own = joint_compliance(p, weights, u)
    for one in in_rounds(flow, own, found.x):
        if Residuals(arising_residuals(flow, own, one)).worst.value <= ARISEN and _admissible(p, one.x):
            return one.x, True
    return found.x, False


def _admissible(problem: LimitProblem, x: Array) -> bool:
    """Whether stresses balance the dead loads within yield."""
    return Residuals(static_residuals(problem, 0.0, x)).worst.value <= ADMISSIBLE


def _dilates(flow: Flow, weights: Array, least: State) -> bool:
    """Whether normal forces of the state of least norm work on the dilatancy that it has and flow has not."""
    other = flow.problem.F.T @ least.y - flow.strains(least.x, least.y)
    return bool(np.abs(least.x * other).sum() > DILATES * (least.x @ (weights * least.x)))
