"""Steps of a load path, judged by what they say."""

from __future__ import annotations

from scipy.sparse.linalg import lsmr

from limitblocks.evidence.load_path_result import LoadPath
from limitblocks.evidence.residuals import Residual, static_residuals
from limitblocks.model import Model

_ROUNDING = 1e-15  # to which inner forces that give the stress resultants are found


def steps_residual(model: Model, path: LoadPath) -> Residual:
    """How far the steps of a load path are from equilibrium at their load factors; the worst of them."""
    problem, found = model.problem, []
    for k, step in enumerate(path.steps):
        resultants = step.stress_resultants.ravel() / problem.units.resultants
        # inner forces are any: equilibrium is that of the resultants
        x = lsmr(problem.resultants, resultants, atol=_ROUNDING, btol=_ROUNDING, conlim=0.0)[0]
        off = static_residuals(problem, step.load_factor * problem.units.live, x)[0]
        found.append(Residual("steps", off.value, f"a step: {off.meaning}", f"step {k}, {off.where}"))
    return max(found, key=lambda one: one.value)
