"""What of a load factor the barrier of its path bears: an estimate, and the answer without it."""

from dataclasses import replace

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.analysis.nonassociated import each_way
from limitblocks.analysis.nonassociated import without_barrier as fading
from limitblocks.analysis.nonassociated.means import Means
from limitblocks.analysis.nonassociated.path_equations import Barrier
from limitblocks.analysis.nonassociated.path_record import off_load_path
from limitblocks.analysis.nonassociated.permanent import permanent_state
from limitblocks.analysis.nonassociated.start import bracket, load_scale, own_units
from limitblocks.analysis.nonassociated.stretch import Stretch
from limitblocks.analysis.nonassociated.without_barrier import borne
from limitblocks.problem import Flow
from tests.analysis.paths import follow
from tests.analysis.test_permanent_state import BESIDE, FRICTION, between

PRESSED, EARLY = "presses joints together", "compliance fades before the barrier"


def followed(model, barrier=None):
    """The first path alone: its load factor, and what its barrier is said to bear of it."""
    enclosing = bracket(model)
    flow = Flow(own_units(model, enclosing), softening=1e-3)
    problem, walks = flow.problem, []
    power = load_scale(problem, enclosing.associated) / len(problem.blocks)
    means = Means(barrier or Barrier(), 1, 300)
    x0 = permanent_state(flow, problem.compliance)
    state, (info,) = follow(
        flow,
        x0,
        problem.compliance,
        means=[means],
        power=power,
        further=lambda walk: walks.append(walk) or walk,
    )
    assert info.closed
    with np.errstate(all="ignore"):
        return state.load_factor / problem.units.live, borne(*walks[0].compliant)


def said(found):
    """Share of the load factor that `how` says the barrier bears."""
    return float(found.how.partition("about ")[2].partition(" %")[0]) / 100.0


@pytest.mark.parametrize("joint", BESIDE, ids=repr)
@pytest.mark.parametrize("neighbours", [None, 2.0, 5.0])
def test_joints_that_only_a_barrier_presses_resist_nothing(neighbours, joint):
    """The cube between stones slides at the friction of its base; the barrier had held it at .32 to .41."""
    found = lb.nonassociated(between(neighbours, joint))
    assert found.how.endswith("barrier faded first")
    assert found.load_factor == pytest.approx(FRICTION, rel=5e-3)
    assert not any(PRESSED in remark for remark in found.remarks)


@pytest.mark.parametrize("joint", BESIDE, ids=repr)
@pytest.mark.parametrize("neighbours", [2.0, 5.0])
def test_the_share_of_the_barrier_is_what_the_load_factor_has_too_much(neighbours, joint):
    """To first order; it falls with the root of the size."""
    model = between(neighbours, joint)
    load_factor, share = followed(model)
    assert share == pytest.approx(1.0 - FRICTION / load_factor, rel=0.03)
    smaller, rest = followed(model, Barrier(size=2e-4))
    assert rest == pytest.approx(1.0 - FRICTION / smaller, rel=0.03)
    assert rest == pytest.approx(share / 10.0, rel=0.25)


def test_where_loads_press_all_joints_the_barrier_bears_nothing():
    blocks = [
        lb.Block.box("ground", (4.0, 2.0, 0.2), (0.0, 0.0, -0.1)),
        lb.Block.box("stone", (1.0, 1.0, 1.0), (0.0, 0.0, 0.5), 20e3),
    ]
    joints = lb.find_interfaces(blocks, lb.OrdunaLourenco(FRICTION))
    model = lb.Model(blocks, ["ground"], joints, lb.self_weight(), lb.mass_proportional((1.0, 0.0, 0.0)))
    load_factor, share = followed(model)
    assert load_factor == pytest.approx(FRICTION, rel=1e-9)
    assert abs(share) < 1e-4
    assert "barrier faded" not in lb.nonassociated(model).how


def test_a_barrier_that_does_not_fade_is_told(monkeypatch):
    """The state is a solution all the same."""
    model = between(5.0, BESIDE[2])
    lb.bounds(model)
    assert permanent_state(Flow(own_units(model, bracket(model))), model.problem.compliance) is not None
    monkeypatch.setattr(Stretch, "go", lambda walk: "lost")
    found = lb.nonassociated(model)
    assert lb.check_mcp(model, found).passed
    assert said(found) == pytest.approx(1.0 - FRICTION / found.load_factor, rel=0.1)
    assert said(found) > 0.05
    assert any(PRESSED in remark for remark in found.remarks)


def test_ctrl_c_while_the_barrier_fades_leaves_the_solution_there_is(monkeypatch):
    model = between(5.0, BESIDE[2])
    lb.bounds(model)
    assert permanent_state(Flow(own_units(model, bracket(model))), model.problem.compliance) is not None

    def pressed(walk):
        raise KeyboardInterrupt

    monkeypatch.setattr(Stretch, "go", pressed)
    found = lb.nonassociated(model)
    assert found.how.endswith("interrupted")
    assert found.load_factor > 1.05 * FRICTION
    assert any(PRESSED in remark for remark in found.remarks)


def test_rounds_close_the_rest_of_a_path_that_stops(monkeypatch):
    """Without the barrier it is plain what yields."""
    monkeypatch.setattr(fading, "BUDGET", 0)
    found = lb.nonassociated(between(5.0, BESIDE[0]))
    assert found.how.endswith("barrier faded first, closed by rounds")
    assert found.load_factor == pytest.approx(FRICTION, rel=5e-3)


def test_a_rest_without_solution_leaves_the_solution_there_is(monkeypatch):
    monkeypatch.setattr(fading, "BUDGET", 0)
    monkeypatch.setattr(fading, "Closing", lambda *_: lambda state: state)
    model = between(5.0, BESIDE[0])
    found = lb.nonassociated(model)
    assert said(found) == pytest.approx(1.0 - FRICTION / found.load_factor, rel=0.1)
    assert lb.check_mcp(model, found).passed


def test_a_barrier_that_fades_in_part_bears_the_less(monkeypatch):
    class Short(Stretch):
        def __init__(self, path, start, until):
            super().__init__(path, start, until, 9)

    model = between(5.0, BESIDE[0])
    lb.bounds(model)
    monkeypatch.setattr(fading, "Stretch", Short)
    found = lb.nonassociated(model)
    assert found.load_factor * (1.0 - said(found)) == pytest.approx(FRICTION, rel=0.02)
    assert found.load_factor < 0.95 * followed(model)[0]
    assert lb.check_mcp(model, found).passed
    assert any(PRESSED in remark for remark in found.remarks)


def test_most_of_what_holds_by_self_stress_alone_is_on_the_barrier():
    """Vertical joints between voussoirs: stresses that carry the dead loads exist, but do not arise."""
    arch = lb.structures.EXAMPLES["arch, vertical joints"](lb.PointContact(0.7))
    model = replace(arch, live=lb.mass_proportional((0.0, 1.0, 0.0)))
    assert not lb.stability(model).stands
    found = lb.nonassociated(model)
    assert 0.5 < said(found) <= 1.0
    for words in ("no stresses were found that arise", PRESSED):
        assert any(words in remark for remark in found.remarks)


@pytest.mark.parametrize("barrier", [Barrier(0.02, 2.0), Barrier(0.3)], ids=repr)
def test_barriers_that_are_not_those_of_loading_do_not_fade_first(barrier, monkeypatch):
    """Most are lost, after 200 factorisations."""

    def never(_):
        raise AssertionError("no load path")

    monkeypatch.setattr(each_way, "without_barrier", never)
    model = between(2.0, BESIDE[2])
    assert lb.nonassociated(model, means=[Means(barrier, 1, 300)]).converged
    with pytest.raises(AssertionError, match="no load path"):
        lb.nonassociated(model)


@pytest.mark.parametrize(
    ("how", "words"),
    [
        ("tracked path, barrier 0.02, power 2, seed 1, compliance faded first", EARLY),
        ("tracked path, small barrier, seed 1, about 6 % of the load factor on its barrier", PRESSED),
        (
            "small barrier, about 6 % of the load factor on its barrier, barrier faded first",
            "about 6 % of this load factor",
        ),
    ],
)
def test_paths_that_may_leave_the_load_path_are_remarked(how, words):
    (remark,) = off_load_path(how)
    assert words in remark


@pytest.mark.parametrize("friction", [0.3, 0.6])
def test_the_rest_of_a_path_without_barrier_ends_where_rounds_may_not(friction):
    """Along governs: pushed diagonally the lintel goes at the same push along, by the root of two."""
    joint = lb.OrdunaLourenco(friction, compressive_strength=0.3e6)
    directions = (1.0, 0.0, 0.0), (1.0, 1.0, 0.0)
    along, diagonal = (
        lb.nonassociated(lb.structures.eccentric_lintel(joint, eccentricity=0.1, direction=direction))
        for direction in directions
    )
    assert along.how.endswith(", barrier faded first")
    assert diagonal.how.endswith(", barrier faded first")
    assert diagonal.load_factor == pytest.approx(np.sqrt(2.0) * along.load_factor, rel=1e-6)
