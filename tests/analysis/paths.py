"""Where a tracked path starts."""

from limitblocks.analysis.nonassociated.least_norm import least_state
from limitblocks.problem import Flow


def start(model, **rule):
    """Flow, stresses under the permanent loads and compliance of a model: what `track` takes."""
    problem = model.problem
    return Flow(problem, **rule), least_state(problem, problem.compliance).x, problem.compliance
