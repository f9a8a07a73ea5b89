"""A portal, and outcomes of its analyses that are known without solving."""

import json
from dataclasses import replace

import numpy as np
import portal
from typer.testing import CliRunner

import limitblocks as lb
from limitblocks.analysis.in_si import resultants_of
from limitblocks.analysis.stability import dead_load_state
from limitblocks.choices import Method
from limitblocks.cli import app
from limitblocks.evidence.ending import Status
from limitblocks.evidence.load_path_result import LoadPath, PathStep
from limitblocks.evidence.results import Iteration, Nonassociated
from limitblocks.problem import Turning

JAMMED = {"live": [{"type": "MassProportional", "direction": [0, 0, -1]}]}
PORTAL = portal.PORTAL | {"joints": {"dry": {"type": "PointContact", "friction": 0.2}}}


def run(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def solved(
    model,
    *,
    dilatancy=0.2,
    turning="centroid",
    method="path",
    tolerance=1e-8,
    backward_error=None,
    progress=None,
    status=Status.CONVERGED,
):
    """The associated solution: it satisfies Eqs (54)-(59) where the dilatancy is the friction."""
    bounds = lb.bounds(model)
    iteration = Iteration(bounds.lower, "step", 0.0, {"flow": 1e-9}, 1, 0)
    if progress:
        progress(iteration)
    names = ("stress_resultants", "generalised_stresses", "displacement_rates", "flow_multipliers")
    names += ("dead_load_stresses",)
    return Nonassociated(
        load_factor=bounds.upper,
        frictionless=np.nan,
        associated=bounds.upper,
        residuals=bounds.residuals,
        backward_error=lb.check_mcp(model, bounds).backward_error,
        status=status,
        how=f"by hand, {Method(method).value}",
        history=(iteration,),
        dilatancy=dilatancy,
        turning=Turning(turning),
        remarks=(),
        tolerance=tolerance,
        digest=model.digest,
        unclaimed="nobody asked",
        **{name: getattr(bounds, name) for name in names},
    )


def walked(model, **settings):
    end = solved(model, **settings)
    start = resultants_of(model.problem, dead_load_state(model.problem))
    first = PathStep(0.0, start, 0.0 * end.displacement_rates, (), {"yield": 0.0}, "step")
    last = PathStep(
        0.2,
        end.stress_resultants,
        1e3 * end.displacement_rates,
        (("[b]|left", "sliding"),),
        {"yield": 0.0},
        "step",
    )
    return LoadPath((first, last), end)


def stopped(model, **settings):
    best = solved(model, status=Status.OUT_OF_STEPS, **settings)
    raise lb.NotConverged("not converged: flow residual 1e-3", replace(best, load_factor=0.21))


def changed(file, **changes):
    document = json.loads(file.read_text())
    for key, change in changes.items():
        document[key] = change(document[key])
    file.write_text(json.dumps(document))
