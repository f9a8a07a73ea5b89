"""The paths of the non-associated flow, in the plane of planar problems.

Sources: docs/planar.md; closed forms and the whole problem in the tests.
"""

from dataclasses import replace
from unittest import mock

import numpy as np
import pytest
from stones import block_off

import limitblocks as lb
from limitblocks import structures
from limitblocks.analysis.in_plane import in_plane
from limitblocks.analysis.nonassociated.in_the_plane import flow_in_plane
from limitblocks.analysis.nonassociated.least_norm import least_state
from limitblocks.analysis.nonassociated.start import load_scale
from limitblocks.evidence.residuals import mcp_residuals
from limitblocks.problem import ASSOCIATED, Flow
from limitblocks.problem.plane import Choice, Planar
from tests.analysis.paths import follow

PAPER = lb.OrdunaLourenco(0.65, slip="paper")
JOINTS = {
    "octagon": PAPER,
    "points": lb.PointContact(0.65),
    "both": lb.OrdunaLourenco(0.65, compressive_strength=2e5, cohesion=1e3, tensile_strength=5e2),
}


def wall(joint, courses=3):
    return structures.wall(joint, length=1.6, courses=courses)


def pair_of_answers(analysis, model, **options):
    """What an analysis finds with the plane, and without."""
    planar = analysis(replace(model), **options)
    with mock.patch("limitblocks.analysis.in_plane.mirror_of", return_value=None):
        return planar, analysis(replace(model), **options)


def arch(joint):
    return structures.arch(joint, radius=5.0, thickness=1.0, voussoirs=9)


def portal(joint):
    return structures.portal(joint, span=1.6, pier_width=0.8, pier_blocks=3, depth=0.8)


def barrel(joint):
    return structures.arch(joint, radius=3.0, thickness=0.5, voussoirs=9, depth=4.0)


@pytest.mark.parametrize("build", [arch, portal, barrel], ids=lambda build: build.__name__)
@pytest.mark.parametrize("name", ["octagon", "points"])
def test_where_the_answer_is_unique_the_plane_has_that_of_the_whole(build, name):
    """Arches hinge and portals slide at one load factor, whatever the way."""
    planar, whole = pair_of_answers(lb.nonassociated, build(JOINTS[name]))
    assert planar.how.endswith(", in the plane")
    assert "plane" not in whole.how
    assert planar.load_factor == pytest.approx(whole.load_factor, rel=1e-8)
    assert planar.residuals.worst.value <= 1e-8


@pytest.mark.parametrize("name", ["octagon", "points", "both"])
def test_associated_flow_in_the_plane_has_the_load_factor_of_the_bounds(name):
    model = structures.ferris_tin_loi_wall(1, JOINTS[name])
    plane, weights = in_plane(model.problem, Choice.FLOWING), model.problem.compliance
    flow = Flow(plane.problem, ASSOCIATED)
    x0 = least_state(plane.problem, plane.compliance_of(weights)).x
    power = load_scale(plane.problem, lb.bounds(model).upper) / len(model.free_blocks)
    state, _ = follow(flow, x0, plane.compliance_of(weights), power=power)
    assert state.load_factor / plane.problem.units.live == pytest.approx(lb.bounds(model).upper, rel=1e-6)
    lifted = plane.lifted(state)
    assert mcp_residuals(Flow(model.problem, ASSOCIATED), lifted).worst.value <= 1e-8


@pytest.mark.parametrize("name", ["octagon", "points"])
def test_a_load_path_of_the_plane_is_that_of_the_whole(name):
    """Every row with its barrier: the same equations, point by point as near as points are to the path."""
    model = structures.wall(JOINTS[name], length=0.8, courses=2)
    planar, whole = pair_of_answers(lb.load_path, model)
    assert planar.collapse.how == "increments of the load path, in the plane"
    assert planar.load_factor == pytest.approx(whole.load_factor, rel=1e-4)
    assert [step.kind for step in planar.steps] == [step.kind for step in whole.steps]
    for one, other in zip(planar.steps[1:-1], whole.steps[1:-1], strict=True):
        assert one.load_factor == pytest.approx(other.load_factor, rel=0.03)
        assert max(one.residuals.values()) <= 1e-8
        size = np.abs(other.displacements).max()
        assert np.abs(one.displacements - other.displacements).max() <= 0.1 * size
    assert lb.check_mcp(model, planar.collapse).passed


def test_opening_flows_though_friction_implies_it():
    """N <= 0 follows from |V| <= mu |N|, but opening not from slip without dilatancy."""
    problem = wall(JOINTS["points"]).problem
    few, flowing = (in_plane(problem, choice).problem for choice in (Choice.FEW, Choice.FLOWING))
    assert len(flowing.g) == len(few.g) / 2 * 3
    opens = flowing.G @ (flowing.resultants.T @ np.tile([0.0, 0.0, 1.0, 0.0, 0.0, 0.0], len(few.interfaces)))
    assert (np.abs(opens) > 0.1).sum() == (np.abs(opens) > 1e-12).sum() == len(flowing.g) / 3


def test_a_twist_under_bending_is_left_out_not_the_hinge():
    """Without torsion Eq. (30) is parallel to hinging; twisting without a twist would be no flow at all."""
    flowing = in_plane(wall(PAPER).problem, Choice.FLOWING).problem
    assert len(flowing.g) == 4 * len(flowing.interfaces)
    assert (abs(flowing.G).sum(axis=1) > 0.1).all()


def test_what_is_not_planar_has_no_path_in_the_plane():
    model = wall(PAPER, courses=2)
    top = model.free_blocks[-1]
    aside = lb.loads.force(top.name, (0.0, 1e-3 * top.weight, 0.0), top.centroid)
    for other in (replace(model, live=model.live + aside), block_off(model, 1e-3)):
        assert "plane" not in lb.nonassociated(other).how
    points = wall(JOINTS["points"], courses=2)
    uneven = np.arange(1.0, 1.0 + points.problem.C.shape[0])
    flow = Flow(points.problem)
    assert flow_in_plane(points, flow, uneven, None) is None
    assert flow_in_plane(points, flow, points.problem.compliance, None) is not None


@pytest.mark.parametrize("analysis", [lb.nonassociated, lb.load_path])
def test_a_lift_that_is_wrong_is_refused_and_the_whole_problem_solved(analysis, monkeypatch):
    lift = Planar.lifted

    def broken(plane, state):
        up = lift(plane, state)
        return replace(up, x=1.001 * up.x)

    model = structures.wall(PAPER, length=0.8, courses=2)
    lb.bounds(model)  # known from now on
    monkeypatch.setattr(Planar, "lifted", broken)
    found = analysis(model)
    found = getattr(found, "collapse", found)
    assert found.converged
    assert "plane" not in found.how
