"""The lower end of the bracket: the inequality that its proof rests on, and where Table 5 breaks it.

With Q0 a state without shear within yield, and dq the flow at a state Q at yield, Q0.dq <= Q.dq: then no
solution lies below the load factor of Q0; docs/nonassociated.md, "The bracket".
"""

from types import SimpleNamespace

import numpy as np
import pytest
from stones import model_of

import limitblocks as lb
from limitblocks import structures
from limitblocks.analysis.nonassociated import without_shear
from limitblocks.problem import Flow, Turning

MU = 0.5
JOINTS = [
    lb.OrdunaLourenco(MU),
    lb.OrdunaLourenco(MU, slip="paper"),
    lb.OrdunaLourenco(MU, slip="inner", sides=3),
    lb.OrdunaLourenco(MU, compressive_strength=1e5),
    lb.OrdunaLourenco(MU, cohesion=5e3, tensile_strength=5e3),
    lb.joints.ExactTorsion(MU, fineness=2, side="inner"),
    lb.joints.ExactTorsion(MU, fineness=2, side="outer"),
    lb.PointContact(MU),
    lb.PointContact(MU, cone="inner", sides=5),
]
STATES = 200
SQUARE = [(1, 1), (-1, 1), (-1, -1), (1, -1)]
PENTAGON = [(2.0, 0.0), (1.0, 1.2), (-0.8, 1.0), (-1.0, -0.7), (0.6, -1.4)]


def problem_of(joint, polygon):
    base = lb.Block.prism("base", polygon, (-0.2, 0.0), along="z")
    blocks = [base, lb.Block.prism("stone", polygon, (0.0, 1.0), 20e3, along="z")]
    return model_of(blocks, ["base"], joint).problem


def pressing(problem):
    """Which generalised stresses are normal forces."""
    return problem.resultants.toarray()[2] > 0.0


def unsheared(problem, random, count):
    """States of N, M1, M2 (or normal forces of points) alone within hinging, N <= 0, and one of them in K."""
    normal = ~problem.resultants.toarray()[[0, 1, 5]].any(axis=0)
    middle = np.where(pressing(problem), -1.0, 0.0)
    held = problem.F @ middle + problem.g
    for drawn in random.normal(size=(count, len(middle))) * normal:
        d = drawn - middle * (drawn @ middle) / (middle @ middle)  # N stays
        away = problem.cones.longest(held, problem.F @ d)
        yield middle + min(away, 1e3) * random.uniform() * d


def flowing(problem, random, count):
    """States at yield, each with multipliers that its yield functions allow to flow."""
    inside = np.where(pressing(problem), -1.0, 0.0)
    held = problem.F @ inside + problem.g
    sizes = [min(1.0, problem.cones.longest(held, problem.F @ e)) for e in np.eye(len(inside))]
    for d in random.uniform(-1, 1, (count, len(inside))) * sizes:
        away = problem.cones.longest(held, problem.F @ d)
        if np.isinf(away):  # more compression, mostly
            continue
        x = inside + away * d
        s = problem.F @ x + problem.g
        y = np.zeros_like(s)
        for k in np.flatnonzero(problem.cones.margin(s) < 1e-9):
            rows = problem.cones.member == k
            y[rows] = np.where(np.arange(rows.sum()) == 0, s[rows], -s[rows]) if rows.sum() > 1 else 1.0
        yield x, y / np.abs(y).max()


def powers(joint, polygon, share=0.0, turning=Turning.CENTROID):
    """Q.dq - Q0.dq of many pairs of states, over what the sizes of Q and dq would make of it."""
    random = np.random.default_rng(0)
    problem = problem_of(joint, polygon)
    flow = Flow(problem, share * MU, turning)
    smooth = np.array(list(unsheared(problem, random, STATES)))
    values = []
    for x, y in flowing(problem, random, STATES):
        dq = -flow.matrix(x).T @ y
        size = np.linalg.norm(x) * np.linalg.norm(dq)
        values.append((x @ dq - smooth @ dq) / size)
    return np.concatenate(values)


@pytest.mark.parametrize("joint", JOINTS, ids=repr)
@pytest.mark.parametrize("polygon", [SQUARE, PENTAGON], ids=["square", "pentagon"])
@pytest.mark.parametrize("share", [0.0, 0.4, 1.0])
def test_no_flow_takes_more_power_from_a_state_without_shear(joint, polygon, share):
    assert powers(joint, polygon, share).min() >= -1e-9


def test_table_5_does():
    """Without it the lower end has no proof; the flow says so."""
    joint = JOINTS[0]
    assert powers(joint, SQUARE, turning=Turning.PRESSURE).min() < -1e-3
    problem = problem_of(joint, SQUARE)
    assert not Flow(problem, 0.0, Turning.PRESSURE).dissipative
    assert not Flow(problem, MU / 2, Turning.PRESSURE).dissipative
    assert Flow(problem, MU, Turning.PRESSURE).dissipative  # associated
    assert Flow(problem, 0.0).dissipative
    assert Flow(problem_of(lb.PointContact(MU), SQUARE), 0.0, Turning.PRESSURE).dissipative  # nothing turns


def stone(joint):
    blocks = [
        lb.Block.box("base", (1, 1, 0.2), (0, 0, -0.1)),
        lb.Block.box("stone", (1, 1, 1), (0, 0, 0.5), 20e3),
    ]
    return model_of(blocks, ["base"], joint)


def test_the_lower_end_is_claimed_where_it_is_one():
    """A stone slides at its friction; without friction anything moves it."""
    model = stone(lb.OrdunaLourenco(MU))
    plain = lb.nonassociated(model)
    assert (plain.frictionless, plain.unclaimed) == (0.0, "")
    assert plain.load_factor == pytest.approx(MU)
    turned = lb.nonassociated(model, turning="centre of pressure")
    assert np.isnan(turned.frictionless)
    assert turned.unclaimed.startswith("with this turning a joint can give power")
    assert "at most 0.5 (associated)" in str(turned)
    assert "lower end not claimed: with this turning" in str(turned)
    assert turned.to_dict()["unclaimed"] == turned.unclaimed
    path = lb.load_path(model, turning="centre of pressure")
    assert path.collapse.unclaimed == turned.unclaimed
    points = lb.nonassociated(stone(lb.PointContact(MU)), turning="centre of pressure")
    assert (points.frictionless, points.unclaimed) == (0.0, "")


def test_glue_holds_a_stone_without_shear():
    """A stone below a ceiling, c A = 1.5 times its weight W: c A - mu W across, and none without shear.

    Without friction the glue would carry 1.5 W across, more than with it: that is no lower end.
    """
    joint = lb.OrdunaLourenco(MU, cohesion=30e3, tensile_strength=60e3)
    blocks = [
        lb.Block.box("ceiling", (1, 1, 0.2), (0, 0, 1.1)),
        lb.Block.box("stone", (1, 1, 1), (0, 0, 0.5), 20e3),
    ]
    model = model_of(blocks, ["ceiling"], joint)
    result = lb.nonassociated(model)
    assert result.load_factor == pytest.approx(1.5 - MU)
    assert result.frictionless == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("c", [0.0, 3e3])
def test_a_stone_tips_where_friction_ends_its_tension(c):
    """Tension ends at c / mu: W b / 2 + A (c / mu) b / 2 = a W h / 2; beyond it no hinge would open."""
    b, h = 1.0, 4.0
    joint = lb.OrdunaLourenco(MU, cohesion=c, tensile_strength=1e6)
    model = structures.block(joint, width=b, height=h)
    (stone,) = model.free_blocks
    expected = (1.0 + stone.volume / h * c / (MU * stone.weight)) * b / h
    assert lb.bounds(model).upper == pytest.approx(expected)
    assert lb.nonassociated(model).load_factor == pytest.approx(expected)


@pytest.mark.parametrize("joint", [lb.OrdunaLourenco(MU), lb.PointContact(MU)], ids=repr)
def test_a_ledge_resists_without_friction(joint):
    """A stone b = 1, h = 2 before a ledge t = 0.5: without shear W b / 2 = a W (h / 2 - t), a = 1."""
    blocks = [
        lb.Block.box("base", (2, 1, 0.2), (0, 0, -0.1)),
        lb.Block.box("ledge", (0.2, 1, 0.5), (0.6, 0, 0.25)),
        lb.Block.box("stone", (1, 1, 2), (0, 0, 1), 20e3),
    ]
    found = lb.nonassociated(model_of(blocks, ["base", "ledge"], joint))
    assert found.frictionless == pytest.approx(1.0, rel=1e-6)
    assert found.load_factor > 1.0


@pytest.mark.parametrize("spoilt", [0.0, 1e-5])
def test_a_stone_on_a_slope_has_no_lower_end(monkeypatch, spoilt):
    """A mechanism proves that the dead loads fall; without it the word of a solver does not."""
    solution = without_shear.solution

    def roughly(*given):
        found = solution(*given)
        assert str(found.status) == "PrimalInfeasible"
        z = np.array(found.z)
        return SimpleNamespace(status=found.status, x=found.x, z=z + spoilt * np.abs(z).max())

    monkeypatch.setattr(without_shear, "solution", roughly)
    angle = np.arctan(0.2)
    turn = np.array([(np.cos(angle), 0, np.sin(angle)), (0, 1, 0), (-np.sin(angle), 0, np.cos(angle))])
    model = stone(lb.OrdunaLourenco(MU))
    blocks = [block.moved(turn, (0, 0, 0)) for block in model.blocks]
    result = lb.nonassociated(model_of(blocks, ["base"], lb.OrdunaLourenco(MU), (0, 1, 0)))
    assert np.isnan(result.frictionless)
    said = (
        "the load factor without friction was not"
        if spoilt
        else "without friction the dead loads do not stand"
    )
    assert result.unclaimed.startswith(said)


def test_a_solver_that_runs_away_claims_no_lower_end(monkeypatch):
    """Near where the dead loads begin to fall Clarabel may end in numbers that are not finite."""
    solution = without_shear.solution

    def astray(*given):
        found = solution(*given)
        return SimpleNamespace(status="NumericalError", x=found.x, z=np.full(len(found.z), np.inf))

    monkeypatch.setattr(without_shear, "solution", astray)
    result = lb.nonassociated(stone(lb.OrdunaLourenco(MU)))
    assert np.isnan(result.frictionless)
    assert result.unclaimed.startswith("the load factor without friction was not")
