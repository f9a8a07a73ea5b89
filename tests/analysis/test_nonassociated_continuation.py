"""Starting elsewhere than from the permanent loads: any state, another dilatancy."""

from dataclasses import replace

import numpy as np
import pytest
from stones import jammed

import limitblocks as lb
from limitblocks import structures
from limitblocks.analysis.nonassociated.means import Means
from limitblocks.analysis.nonassociated.path_equations import Barrier

MU = 0.6
KINDS = [lb.OrdunaLourenco, lb.PointContact]


def facade(kind, direction):
    door = [(1.2, 0.0, 0.8, 1.2)]
    return structures.facade(
        kind(MU), length=3.2, courses=5, return_length=1.6, openings=door, direction=direction
    )


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("direction", [(0, 1, 0), (1, 1, 0)], ids=["out", "diagonal"])
def test_associated_flow_gives_the_associated_value_in_space(kind, direction):
    model = facade(kind, direction)
    found, bounds = lb.nonassociated(model, dilatancy=MU), lb.bounds(model)
    assert found.residuals.worst.value <= 1e-6
    assert found.load_factor == pytest.approx(bounds.upper, abs=1e-6)
    assert found.load_factor == pytest.approx(bounds.lower, abs=1e-6)


@pytest.mark.parametrize(("number", "kind"), [(2, KINDS[0]), (3, KINDS[1]), (4, KINDS[0])])
def test_followed_from_the_associated_flow_the_answer_moves_in_small_steps(kind, number):
    """Each dilatancy starts from the answer of the one before: no step above 3 % of the associated value."""
    model = structures.ferris_tin_loi_wall(number, kind(0.65))
    found, factors = None, []
    for share in np.linspace(1.0, 0.0, 11):
        found = lb.nonassociated(model, dilatancy=0.65 * share, start=found)
        assert lb.check_mcp(model, found).worst.value <= 1e-6
        factors.append(found.load_factor)
    assert factors[0] == pytest.approx(lb.bounds(model).upper, abs=1e-6)
    assert np.abs(np.diff(factors)).max() <= 0.03 * factors[0]
    assert max(factors) <= factors[0] + 1e-6


def test_no_answer_can_be_continuous_at_zero_dilatancy_where_blocks_jam():
    """A block between floor and ceiling slides at a finite load; the least dilatancy jams it for good.

    Sliding by s would lift the block by s tan(psi) > 0 into a rigid ceiling: no mechanism exists, while the
    ceiling force balances any live load. So there is no solution at any dilatancy above zero.
    """
    joint = lb.PointContact(friction=0.3)
    model = jammed(joint)
    assert np.isfinite(lb.nonassociated(model).load_factor)
    with pytest.raises(lb.errors.UnlimitedLoad):
        lb.nonassociated(model, dilatancy=0.3)
    with pytest.raises(lb.NotConverged):
        lb.nonassociated(model, dilatancy=1e-3, means=[Means(Barrier(), 0, 60)])


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("analysis", [lb.nonassociated, lb.load_path])
def test_any_admissible_state_is_a_start(kind, analysis):
    """The associated state, as bounds or as bare stresses: of a rocking block it is the solution."""
    model = structures.block(kind(MU), width=0.4, height=1.0)
    bounds = lb.bounds(model)
    for start in (bounds, bounds.generalised_stresses, bounds.generalised_stresses.tolist()):
        assert analysis(model, start=start).load_factor == pytest.approx(0.4, abs=1e-6)


def test_resultants_of_each_interface_are_a_start_in_the_order_of_the_interfaces():
    """Generalised stresses stand joint by joint: here base and top before the one between them."""
    model = structures.column(lb.OrdunaLourenco(MU), count=3, width=0.6, height=0.5)
    other = replace(model.interfaces[1], joint=lb.OrdunaLourenco(MU + 0.2))
    model = replace(model, interfaces=(model.interfaces[0], other, model.interfaces[2]))
    bounds = lb.bounds(model)
    assert lb.nonassociated(model, start=bounds.stress_resultants).load_factor == pytest.approx(0.4, abs=1e-6)
    by_joint = bounds.stress_resultants[[0, 2, 1]].ravel()
    assert bounds.generalised_stresses == pytest.approx(by_joint, rel=1e-9, abs=1e-6)
    with pytest.raises(lb.ModelError, match="start is no state of this model"):
        lb.nonassociated(model, start=bounds.stress_resultants.ravel())
    points = structures.block(lb.PointContact(MU), width=0.4, height=1.0)
    with pytest.raises(lb.ModelError, match="do not determine the inner forces"):
        lb.nonassociated(points, start=lb.bounds(points).stress_resultants)


@pytest.mark.parametrize("kind", KINDS)
def test_a_start_that_is_no_state_is_refused(kind):
    model = structures.block(kind(MU), width=0.4, height=1.0)
    stresses = lb.bounds(model).generalised_stresses
    with pytest.raises(lb.ModelError, match="start is no state of this model: equilibrium residual"):
        lb.nonassociated(model, start=1.01 * stresses)
    with pytest.raises(lb.ModelError, match=f"start has {len(stresses) - 1} numbers; the {len(stresses)} "):
        lb.nonassociated(model, start=stresses[:-1])
    with pytest.raises(
        lb.ModelError, match=r"start has 18 numbers; .*, or stress resultants of shape \(1, 6\)"
    ):
        lb.nonassociated(model, start=np.zeros((3, 6)))
    with pytest.raises(lb.ModelError, match="finite"):
        lb.nonassociated(model, start=np.where(stresses == stresses.max(), np.nan, stresses))


def test_a_start_without_dilatancy_is_not_taken_for_the_associated_answer():
    model = structures.ferris_tin_loi_wall(4, lb.PointContact(0.65))
    found = lb.nonassociated(model, dilatancy=0.65, start=lb.nonassociated(model))
    assert found.load_factor == pytest.approx(lb.bounds(model).upper, abs=1e-6)


@pytest.mark.parametrize("analysis", [lb.nonassociated, lb.load_path])
@pytest.mark.parametrize(
    ("made", "kind"),
    [
        (lb.load_path, "LoadPath"),
        (lb.stability, "Stability"),
        (lambda model: lb.bounds(model).to_dict(), "dict"),
        (lambda model: lb.bounds(model).generalised_stresses + 1e3j, "ndarray"),
        (lambda _: "result.json", "str"),
        (lambda _: [[1, 2], [3]], "list"),
    ],
)
def test_a_start_of_another_kind_is_refused(analysis, made, kind):
    model = structures.block(lb.OrdunaLourenco(MU), width=0.4, height=1.0)
    with pytest.raises(
        lb.ModelError, match=f"start is a {kind}, expected a result of nonassociated or bounds"
    ):
        analysis(model, start=made(model))
