"""The load path: its first state by hand, every state admissible, its end, and its stiffness."""

from dataclasses import replace

import numpy as np
import pytest
from stones import imbalance

import limitblocks as lb
from limitblocks import structures

MU = 0.65
JOINTS = [lb.OrdunaLourenco(MU), lb.PointContact(MU)]


@pytest.fixture(scope="module", params=JOINTS, ids=lambda joint: type(joint).__name__)
def joint(request):
    return request.param


@pytest.fixture(scope="module")
def walked(joint):
    model = structures.wall(joint, length=1.2, courses=4)
    return model, lb.load_path(model)


def last_block(model):
    return len(model.blocks) - 1


def test_a_column_starts_with_the_weight_above_each_joint(joint):
    """N = -(weight above), centred; no shear, moment or torsion: equilibrium determines the column."""
    count = 4
    model = structures.column(joint, count=count, width=0.6, height=0.25)
    weight = model.free_blocks[0].weight
    first = lb.load_path(model).steps[0]
    assert first.kind == "permanent loads"
    assert first.load_factor == 0.0
    assert not first.displacements.any()
    top = {block.name: block.centroid[2] for block in model.blocks}
    for interface, Q in zip(model.interfaces, first.stress_resultants, strict=True):
        above = sum(z > interface.centroid[2] for z in top.values())
        assert Q[2] == pytest.approx(-above * weight, rel=1e-6)
        assert np.abs(Q[[0, 1, 3, 4, 5]]).max() <= 1e-6 * weight
    assert sorted(first.stress_resultants[:, 2] / weight) == pytest.approx([-4, -3, -2, -1])


def test_every_step_is_admissible_and_the_last_is_a_solution(walked):
    model, path = walked
    for step in path.steps:
        assert set(step.residuals) == {"equilibrium", "yield"}
        assert max(step.residuals.values()) <= 1e-6
        assert step.load_factor <= path.collapse.associated + 1e-6
    assert lb.check_mcp(model, path.collapse).worst.value <= 1e-6
    assert path.steps[-1].load_factor == path.load_factor == path.collapse.load_factor
    np.testing.assert_array_equal(path.steps[-1].stress_resultants, path.collapse.stress_resultants)
    assert path.peak == max(step.load_factor for step in path.steps)


def test_every_step_balances_the_loads_by_hand(walked):
    model, path = walked
    weight = np.mean([block.weight for block in model.free_blocks])
    for step in path.steps:
        assert np.abs(imbalance(model, step.load_factor, step.stress_resultants)).max() <= 1e-6 * weight


def test_the_live_load_goes_on_working(walked):
    """Each step prescribes a positive work of the live load; under +X the top moves along +X."""
    model, path = walked
    live = model.live.on(model.free_blocks)
    work = [np.sum(live * step.displacements[model.free]) for step in path.steps if step.kind == "step"]
    assert (np.diff(work) > 0.0).all()
    moved, load_factors = path.curve(last_block(model), 0)
    assert (np.diff(moved) >= 0.0).all()
    assert moved[-1] > 0.0
    assert load_factors.tolist() == [step.load_factor for step in path.steps]
    assert not any(step.displacements[~model.free].any() for step in path.steps)


def test_table(walked):
    model, path = walked
    table = path.rows()
    assert [row["step"] for row in table] == list(range(len(path.steps)))
    assert list(table[0]) == ["step", "kind", "load_factor", "equilibrium", "yield", "newly_active"]
    names = {f"{i.block_i}|{i.block_j}" for i in model.interfaces}
    pairs = [pair for row in table for pair in row["newly_active"]]
    assert pairs
    assert {name for name, _ in pairs} <= names
    assert {mode for _, mode in pairs} <= set(model.problem.row_mode)


@pytest.mark.parametrize("ratio", [10.0])
def test_the_size_of_the_stiffness_scales_the_displacements_only(joint, ratio):
    model = structures.wall(joint, length=0.8, courses=3)
    soft = lb.load_path(model, stiffness=(1e9, ratio * 1e9))
    hard = lb.load_path(model, stiffness={joint: (1e10, ratio * 1e10)})
    assert hard.load_factor == pytest.approx(soft.load_factor, rel=1e-5)
    for stiff, yielding in zip(hard.steps[:5], soft.steps[:5], strict=True):  # later rounding adds up
        assert stiff.load_factor == pytest.approx(yielding.load_factor, abs=1e-6)
        size = np.abs(yielding.displacements).max()
        np.testing.assert_allclose(10 * stiff.displacements, yielding.displacements, atol=1e-5 * size)


def test_without_a_stiffness_it_is_a_block_weight_per_length_cubed(joint):
    model = structures.wall(joint, length=0.8, courses=3)
    weight = np.mean([block.weight for block in model.free_blocks])
    length = np.mean([np.cbrt(block.volume) for block in model.free_blocks])
    unit = weight / length**3
    given, default = lb.load_path(model, stiffness=(unit, unit)), lb.load_path(model)
    assert given.load_factor == pytest.approx(default.load_factor, rel=1e-5)
    for one, other in zip(given.steps[:5], default.steps[:5], strict=True):
        size = np.abs(other.displacements).max()
        np.testing.assert_allclose(one.displacements, other.displacements, atol=1e-5 * size)


def test_a_block_on_elastic_joints_by_hand():
    """Base of area A = 1 m2: slip a W / (A k_s), tilt M / (I k_n) with M = a W h / 2 and I = A / 12.

    The paper's joint takes V1, N, M2 by themselves. Before any row flows the path is linear in a.
    """
    ks, kn, h = 2e8, 1e9, 0.2
    model = structures.block(lb.OrdunaLourenco(0.3), width=1.0, height=h, depth=1.0)
    path = lb.load_path(model, stiffness=(kn, ks), settings=lb.settings.Settings(first=0.2, growth=1.2))
    step = path.steps[1]
    assert not step.active
    push = step.load_factor * model.free_blocks[0].weight
    moved = step.displacements[[block.name for block in model.blocks].index("block 1")]
    slip, tilt = push / ks, push * h / 2 / (kn / 12)
    assert moved[4] == pytest.approx(tilt, rel=1e-4)
    assert moved[0] == pytest.approx(slip + tilt * h / 2, rel=1e-4)
    assert np.abs(moved[[1, 3, 5]]).max() <= 1e-6 * moved[0]
    assert path.load_factor == pytest.approx(0.3, rel=1e-5)


@pytest.mark.parametrize(
    "stiffness",
    [(0, 1e9), (1e9, -1.0), (np.nan, 1e9), (1e9, np.inf), (1e9,), (1e9, 1e9, 1e9), {}, {JOINTS[0]: (0, 1)}],
    ids=str,
)
def test_bad_stiffness_is_refused(stiffness):
    model = structures.block(JOINTS[0], width=1.0, height=0.5)
    with pytest.raises(lb.ModelError, match=r"expected \(normal, shear\) in N/m3, both positive"):
        lb.load_path(model, stiffness=stiffness)


def test_a_path_goes_on_from_a_result(walked):
    model, path = walked
    again = lb.load_path(model, start=path.collapse)
    assert again.steps[0].stress_resultants == pytest.approx(
        path.collapse.stress_resultants, abs=1e-9 * np.abs(path.collapse.stress_resultants).max()
    )
    assert again.load_factor == pytest.approx(path.load_factor, abs=1e-5)


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
def test_a_path_starts_at_the_load_factor_that_its_first_stresses_balance(joint, share):
    """A block of weight W under a push a W at its centroid: V = a W, M2 = a W h / 2, N = -W, up to a = b/h.

    It said load factor 0, and the check of the path failed by what the live load left unbalanced.
    """
    model = structures.column(joint, count=1, width=0.4, height=1.0)
    path = lb.load_path(model)
    assert path.load_factor == pytest.approx(0.4, rel=1e-9)
    dead, collapse = lb.stability(model).generalised_stresses, path.collapse.generalised_stresses
    begun = lb.load_path(model, start=dead + share * (collapse - dead))
    first = begun.steps[0]
    assert first.load_factor == pytest.approx(share * 0.4, abs=1e-9)
    assert first.kind == ("start" if share else "permanent loads")
    assert first.residuals["equilibrium"] <= 1e-8
    assert begun.trace[0, 2] == first.load_factor
    assert begun.peak == pytest.approx(0.4, rel=1e-9)
    assert lb.check_mcp(model, begun).passed


@pytest.mark.parametrize("budget", [100, 200])
def test_the_last_state_of_a_path_that_does_not_end_is_within_yield(budget):
    """The polish of a state far from collapse balances the loads, but a hundredth to a tenth beyond yield."""
    model = structures.EXAMPLES["corner"](lb.PointContact(0.7))
    model = replace(model, live=lb.mass_proportional((0.0, 1.0, 0.0)))
    path = lb.load_path(model, settings=lb.settings.Settings(budget=budget), throw=False)
    assert not path.collapse.converged
    for residuals in (*(step.residuals for step in path.steps), path.collapse.residuals):
        assert max(residuals["equilibrium"], residuals["yield"]) <= 1e-8
