"""Steps of a load path, judged by what they say."""

from __future__ import annotations

from scipy.sparse.linalg import lsmr

from limitblocks.errors import ModelError, sequence_of
from limitblocks.evidence.claim import real_array, real_number
from limitblocks.evidence.load_path_result import LoadPath, PathStep
from limitblocks.evidence.residuals import Residual, static_residuals
from limitblocks.model import Model

#: What of a load path no residual judges.
UNJUDGED = "of the steps equilibrium was judged, not yield or displacements, nor the trace of the path"
_ROUNDING = 1e-15  # to which inner forces that give the stress resultants are found


def steps_residual(model: Model, path: LoadPath) -> Residual:
    """How far the steps of a load path are from equilibrium at their load factors; the worst of them."""
    problem, found, shape = model.problem, [], (len(model.interfaces), 6)
    for k, step in enumerate(sequence_of("steps", path.steps, PathStep)):
        load_factor = real_number(f"step {k}: load_factor", step.load_factor)
        given = real_array(f"step {k}: stress_resultants", step.stress_resultants, shape)
        resultants = given.ravel() / problem.units.resultants
        # inner forces are any: equilibrium is that of the resultants
        x = lsmr(problem.resultants, resultants, atol=_ROUNDING, btol=_ROUNDING, conlim=0.0)[0]
        off = static_residuals(problem, load_factor * problem.units.live, x)[0]
        found.append(Residual("steps", off.value, f"a step: {off.meaning}", f"step {k}, {off.where}"))
    if not found:
        raise ModelError(
            "the load path has no steps, expected those from the permanent loads to its collapse"
        )
    return max(found, key=lambda one: one.value)
