"""Where a tracked path starts, several of them in turn, and a way to leave one."""

from limitblocks.analysis.nonassociated.least_norm import least_state
from limitblocks.analysis.nonassociated.means import MEANS
from limitblocks.analysis.nonassociated.path_equations import Point
from limitblocks.analysis.nonassociated.tracking import track
from limitblocks.problem import Flow


def start(model, **rule):
    """Flow, stresses under the permanent loads and compliance of a model: what `track` takes."""
    problem = model.problem
    return Flow(problem, **rule), least_state(problem, problem.compliance).x, problem.compliance


def follow(flow, x0, weights, *, means=MEANS, **options):
    """Follow paths until one is closed: its state, and how each went; else the state of least residual."""
    tried = []
    for one in means:
        tried.append(track(flow, x0, weights, **one._asdict(), **options))
        if tried[-1][1].closed:
            break
    state, _ = min(tried, key=lambda outcome: (not outcome[1].closed, outcome[1].residual))
    return state, tuple(info for _, info in tried)


def direction(random, z, size):
    """A move of a point of a path, at random but for the load factor."""
    x, u, s, y = (size * random.normal(size=v.shape) for v in (z.x, z.u, z.s, z.y))
    return Point(x, u, size, s, y, 0.0)
