"""Does it stand under its dead loads: blocks of which one can say so by hand."""

from dataclasses import replace

import numpy as np
import pytest
from stones import model_of

import limitblocks as lb
from limitblocks.analysis import stability as answers
from limitblocks.analysis.falling import falling
from limitblocks.analysis.unstressed import arising, joint_compliance
from limitblocks.errors import SolverFailure
from limitblocks.evidence.residuals import Residual, Residuals
from limitblocks.evidence.stability_result import arising_residuals, mechanism_residuals
from limitblocks.practice import reinforced, tie
from limitblocks.problem import ASSOCIATED, Flow, State
from limitblocks.structures.convex import hull

GAMMA = 20e3
JOINTS = [lb.OrdunaLourenco, lb.PointContact]


def model(blocks, supports, joint, live=(1, 0, 0)):
    return model_of(blocks, supports, joint, live)


def prism(name, section, unit_weight=None, move=lambda corners: corners):
    """A body of depth 1 along y above a polygon in x and z."""
    return hull(name, move(np.array([(x, y, z) for y in (-0.5, 0.5) for x, z in section])), unit_weight)


def on_a_slope(joint, tangent, unit_weight=GAMMA, move=lambda corners: corners):
    along, normal = np.array([(1, tangent), (-tangent, 1)]) / np.hypot(1, tangent)

    def rectangle(length, low, high):
        corners = (-length, low), (length, low), (length, high), (-length, high)
        return [x * along + z * normal for x, z in corners]

    stone = prism("stone", rectangle(1, 0.0, 0.3), unit_weight, move)
    return model([prism("plane", rectangle(3, -1.0, 0.0), None, move), stone], ["plane"], joint)


def under_water(s, joint):
    """A wall of width s and height 2 s under water of depth 1.6 s, which is about to push it along."""
    blocks = [
        lb.Block.box("ground", (8 * s, s, s), (0, 0, -0.5 * s)),
        lb.Block.box("wall", (s, s, 2 * s), (0, 0, s), GAMMA),
    ]
    water = lb.loads.pressure("wall", facing=(-1, 0, 0), unit_weight=9810.0, level=1.6 * s)
    own = model(blocks, ["ground"], joint)
    return replace(own, dead=own.dead + water)


@pytest.mark.parametrize("s", [1.0, 1.3, 1.7])
def test_margin_is_over_the_dead_force_whatever_the_size(s):
    """(mu W - V) / hypot(W, V): its moment about the centroid counts in the balance alone."""
    W, V = 2 * GAMMA, 9810.0 * 1.6**2 / 2
    found = lb.stability(under_water(s, lb.OrdunaLourenco(0.4)))
    assert found.margin == pytest.approx((0.4 * W - V) / np.hypot(W, V), rel=1e-9)


@pytest.mark.parametrize("crushing_share", [1e-8, 0.05, 0.2])
@pytest.mark.parametrize("unit_weight", [GAMMA, 0.7 * GAMMA])
def test_margin_of_a_joint_that_crushes(unit_weight, crushing_share):
    """s - N^2 / (A fc) of Eq. (39), s = N - 2 M / b, over N: 1 - 2 e / b - N / (A fc), whatever the unit."""
    blocks = [
        lb.Block.box("ground", (4, 4, 1), (0, 0, -0.5)),
        lb.Block.box("stone", (1, 1, 1), (0, 0, 0.5), unit_weight),
    ]
    own = model(blocks, ["ground"], lb.OrdunaLourenco(2.5, unit_weight / crushing_share))
    leaning = replace(own, dead=own.dead + lb.loads.moment("stone", (0, 0.3 * unit_weight, 0)))
    assert lb.stability(leaning).margin == pytest.approx(0.4 - crushing_share, rel=1e-6)


def test_largest_margin_where_joints_that_crush_share_a_weight():
    """Beds of 1, .842 and 1 m2, fc 1 m2 = W: n - n^2 = m - m^2 / .842 of 2 n + m = 1 is .21 at n = .3."""
    W, middle = GAMMA, 0.16 / 0.19
    places = {"left": (1.0, -2.5), "middle": (middle, 0.0), "right": (1.0, 2.5)}
    blocks = [lb.Block.box(name, (bed, 1, 1), (x, 0, -0.5)) for name, (bed, x) in places.items()]
    blocks.append(lb.Block.box("slab", (6, 1, 1), (0, 0, 0.5), W / 6.0))
    own = model(blocks, [*places], lb.OrdunaLourenco(2.5, W))
    assert lb.stability(own).margin == pytest.approx(0.21, rel=1e-5)


def test_a_slack_tie_is_half_its_strength_from_yield():
    """Of a tension between 0 and c no state is farther than c / 2 from both."""
    own = model([*under_water(1.0, lb.OrdunaLourenco(0.4)).blocks], ["ground"], lb.OrdunaLourenco(0.4))
    rod = tie("wall", (-0.5, 0, 1), "ground", (-3, 0, 1), area=1e-4, strength=1e7)
    assert lb.stability(reinforced(own, rod)).margin == pytest.approx(500.0 / (2 * GAMMA), rel=1e-9)


def between_walls(joint, degrees, unit_weight=GAMMA, move=lambda corners: corners):
    """A wedge of this half angle between walls; narrowing downwards, or upwards where it is negative."""
    low, high, out = 2.0, 2.0 + np.tan(np.radians(degrees)), 5.0
    blocks = [
        prism("left", [(-out, 0), (-low, 0), (-high, 1), (-out, 1)], None, move),
        prism("right", [(out, 0), (low, 0), (high, 1), (out, 1)], None, move),
        prism("stone", [(-low, 0), (low, 0), (high, 1), (-high, 1)], unit_weight, move),
    ]
    return model(blocks, ["left", "right"], joint)


def test_block_on_a_slope_stands_where_friction_exceeds_the_slope():
    """V <= mu N with V = W sin a and N = W cos a: the margin in weights is mu cos a - sin a."""
    mu = 0.5
    for tangent in (0.4, 0.49, 0.499, 0.501, 0.51, 0.7):
        found = lb.stability(on_a_slope(lb.OrdunaLourenco(mu), tangent))
        assert found.stands is (tangent < mu)
        assert found.kind is (lb.results.Standing.STANDS if tangent < mu else lb.results.Standing.FALLS)
        assert found.margin == pytest.approx((mu - tangent) / np.hypot(1, tangent), rel=1e-6)
        assert found.blocks == (() if tangent < mu else ("stone",))
        assert found.residuals.worst.value <= 1e-8


@pytest.mark.parametrize(("joint", "lowered"), [(lb.OrdunaLourenco, 1), (lb.PointContact, 4)])
def test_the_margin_of_a_joint_is_shared_by_its_points_and_pieces(joint, lowered):
    """Each of them is lowered: near the limit two pieces have half the margin, a point of four a quarter."""
    mu, tangent = 0.5, 0.49
    whole = on_a_slope(joint(mu), tangent)
    (own,) = whole.interfaces
    half = np.array([0.5, 1.0]) * own.polygon  # s1 is along the longest side
    pieces = [
        replace(own, centroid=own.centroid + off * own.axes[0], polygon=half)
        for off in (half[:, 0].max(), half[:, 0].min())
    ]
    margins = [lb.stability(one).margin for one in (whole, replace(whole, interfaces=pieces))]
    margin = (mu - tangent) / np.hypot(1, tangent) / lowered
    assert margins == pytest.approx([margin, margin / 2], rel=1e-6)


@pytest.mark.parametrize("joint", JOINTS)
def test_block_between_vertical_walls_stands_only_where_it_is_wedged(joint):
    """2 V = W, V <= mu N holds for a large N, which nothing brings about: the walls are parallel."""
    for mu in (0.0, 0.05, 0.5, 3.0):
        found = lb.stability(between_walls(joint(mu), 0.0))
        assert found.kind is (lb.results.Standing.SELF_STRESS if mu else lb.results.Standing.FALLS)
        assert not found.stands
        assert found.blocks == ("stone",)
        down = found.displacement_rates[2]
        assert down == pytest.approx([0, 0, -1, 0, 0, 0], abs=1e-6)  # the largest rate is 1 m
        assert (found.displacement_rates[:2] == 0.0).all()
        if mu:
            assert (2 * mu * -found.stress_resultants[:, 2] >= GAMMA * 4.0).all()  # N of what wedges it
            assert found.arising is None


@pytest.mark.parametrize("joint", JOINTS)
@pytest.mark.parametrize("mu", [0.0, 0.1, 0.6, 2.0])
@pytest.mark.parametrize("degrees", [5, 20, 50])
def test_wedge_that_narrows_downwards_stands_for_any_friction(joint, mu, degrees):
    """Both walls turn its weight into N >= W / 2 / (sin w + mu cos w), the shear being at most mu N."""
    structure = between_walls(joint(mu), degrees)
    found = lb.stability(structure)
    assert found.stands
    w, weight = np.radians(degrees), GAMMA * (4.0 + np.tan(np.radians(degrees)))
    N = -found.arising[:, 2]
    V = np.hypot(*found.arising[:, :2].T)
    assert (mu * N - V >= -1e-6 * weight).all()
    assert N * np.sin(w) + V * np.cos(w) == pytest.approx([weight / 2] * 2, rel=1e-6)


@pytest.mark.parametrize("joint", JOINTS)
@pytest.mark.parametrize("mu", [0.1, 0.6, 1.5])
@pytest.mark.parametrize("degrees", [5, 20, 50])
def test_wedge_that_narrows_upwards_never_stands_by_itself(joint, mu, degrees):
    """2 (V cos w - N sin w) = W and V <= mu N: stresses exist where tan w < mu, and do not arise."""
    found = lb.stability(between_walls(joint(mu), -degrees))
    wedged = np.tan(np.radians(degrees)) < mu
    assert found.kind is (lb.results.Standing.SELF_STRESS if wedged else lb.results.Standing.FALLS)
    assert (found.margin > 0.0) is bool(wedged)
    assert found.blocks == ("stone",)
    assert found.residuals.worst.value <= 1e-8


def test_arches_stand_down_to_their_least_thickness():
    """Thickness over radius 0.1075 for radial joints (Milankovitch 1907); 27 voussoirs need little less."""
    for thickness, stands in ((1.5, True), (1.1, True), (1.05, False)):
        arch = lb.structures.arch(lb.PointContact(0.7), radius=10.0, thickness=thickness, voussoirs=27)
        found = lb.stability(arch)
        assert found.stands is stands
        assert (found.margin > 0.0) is stands
        assert bool(found.blocks) is not stands


@pytest.mark.parametrize("name", lb.structures.EXAMPLES)
def test_structures_of_the_library_stand_by_themselves(name):
    """But for the arch with vertical joints: its middle is a block between parallel walls."""
    found = lb.stability(lb.structures.EXAMPLES[name](lb.OrdunaLourenco(0.7)))
    assert found.stands is (name != "arch, vertical joints")


def stack(offsets, light=1.0, joint=None):
    """Boxes of 1 m on one another, each moved by its offset; the last is `light` times as heavy."""
    weights = [GAMMA] * (len(offsets) - 1) + [GAMMA * light]
    blocks = [lb.Block.box("ground", (20, 20, 1), (0, 0, -0.5))]
    blocks += [
        lb.Block.box(f"box {k + 1}", (1, 1, 1), (x, 0, k + 0.5), weight)
        for k, (x, weight) in enumerate(zip(offsets, weights, strict=True))
    ]
    return model(blocks, ["ground"], joint or lb.OrdunaLourenco(0.6))


@pytest.mark.parametrize("light", [1.0, 1e-3, 1e-6])
def test_overhang_falls_beyond_half_a_length_and_is_named(light):
    for offset, stands in ((0.49, True), (0.51, False)):
        found = lb.stability(stack([0.0, 0.0, offset], light))
        assert found.stands is stands
        assert found.blocks == (() if stands else ("box 3",))


def test_what_hangs_from_nothing_falls():
    """Joints carry no tension: the face above holds nothing."""
    ceiling = lb.Block.box("ceiling", (4, 4, 1), (0, 0, 1.5))
    blocks = [ceiling, lb.Block.box("stone", (1, 1, 1), (0, 0, 0.5), GAMMA)]
    found = lb.stability(model(blocks, ["ceiling"], lb.OrdunaLourenco(0.6)))
    assert (found.kind, found.blocks) == (lb.results.Standing.FALLS, ("stone",))
    assert (found.stress_resultants, found.arising) == (None, None)


def test_cohesion_holds_the_block_between_walls():
    """c A on each of two walls of 1 m2 against the weight: no homogeneity, so the loads themselves act."""
    weight = GAMMA * 4.0
    for share, stands in ((1.2, True), (0.8, False)):
        joint = lb.OrdunaLourenco(0.5, cohesion=share * weight / 2)
        assert lb.stability(between_walls(joint, 0.0)).stands is stands


@pytest.mark.parametrize("light", [1.0, 1e-3, 1e-6])
def test_light_stone_that_only_wedging_holds_is_named_beside_heavy_ones(light):
    blocks = [
        lb.Block.box("ground", (20, 20, 1), (0, 0, -0.5)),
        lb.Block.box("heavy", (2, 2, 2), (0, 0, 1), GAMMA),
        lb.Block.box("wall 1", (1, 2, 3), (4.5, 0, 1.5)),
        lb.Block.box("wall 2", (1, 2, 3), (6.0, 0, 1.5)),
        lb.Block.box("light", (0.5, 0.5, 0.5), (5.25, 0, 1.0), GAMMA * light),
    ]
    found = lb.stability(model(blocks, ["ground", "wall 1", "wall 2"], lb.OrdunaLourenco(0.6)))
    assert (found.kind, found.blocks) == (lb.results.Standing.SELF_STRESS, ("light",))


FALSE = {
    "equilibrium": lambda z: replace(z, x=1.001 * z.x),
    "yield": lambda z: replace(z, x=-z.x),
    "flow": lambda z: replace(z, u=1.001 * z.u),
    "multipliers": lambda z: replace(z, y=z.y - 1e-3),
    "complementarity": lambda z: replace(z, y=z.y + 1e-3),
}


@pytest.mark.parametrize("name", FALSE)
def test_false_states_that_do_not_arise_are_refused_by_the_residual_that_names_it(name):
    problem = between_walls(lb.OrdunaLourenco(0.3), 20.0).problem
    weights = joint_compliance(problem)
    z = arising(Flow(problem), weights)
    state = State(0.0, z.x, z.u, z.y)
    flow = Flow(problem)
    assert Residuals(arising_residuals(flow, weights, state)).worst.value < 1e-8
    assert Residuals(arising_residuals(flow, weights, FALSE[name](state)))[f"arising {name}"] > 1e-5


@pytest.mark.parametrize("part", ["u", "y"])
def test_false_mechanism_is_refused(part):
    problem = on_a_slope(lb.OrdunaLourenco(0.5), 0.6).problem
    fall = falling(Flow(problem, ASSOCIATED), problem.dead)
    assert Residuals(mechanism_residuals(fall.flow, fall.loads, fall.state)).worst.value < 1e-8
    false = replace(fall.state, **{part: 1.001 * getattr(fall.state, part)})
    assert Residuals(mechanism_residuals(fall.flow, fall.loads, false))["mechanism flow"] > 1e-5
    sticky = on_a_slope(lb.OrdunaLourenco(0.5, cohesion=1e6), 0.6).problem  # takes up more than the loads do
    assert Residuals(mechanism_residuals(Flow(sticky, ASSOCIATED), sticky.dead, false)).worst.value == np.inf
    upwards = replace(fall.state, u=-fall.state.u, y=-fall.state.y)  # the loads do negative work
    assert Residuals(mechanism_residuals(fall.flow, fall.loads, upwards)).worst.value == np.inf


def turned(corners):
    """Turned about the vertical axis by 1 rad and moved."""
    turn = np.array([(np.cos(1), -np.sin(1), 0), (np.sin(1), np.cos(1), 0), (0, 0, 1)])
    return corners @ turn.T + (30.0, -20.0, 10.0)


@pytest.mark.parametrize(
    "make",
    [
        lambda **changes: on_a_slope(lb.OrdunaLourenco(0.5), 0.4, **changes),
        lambda **changes: on_a_slope(lb.PointContact(0.5), 0.6, **changes),
        lambda **changes: between_walls(lb.OrdunaLourenco(0.5), 20.0, **changes),
        lambda **changes: between_walls(lb.OrdunaLourenco(0.5), -20.0, **changes),
    ],
)
def test_answer_is_the_same_in_other_units_of_force_and_elsewhere(make):
    found = lb.stability(make())
    for other in (lb.stability(make(unit_weight=1e9 * GAMMA)), lb.stability(make(move=turned))):
        assert (other.kind, other.blocks) == (found.kind, found.blocks)
        assert other.margin == pytest.approx(found.margin, rel=1e-6)


def test_result_is_one_line_and_plain_data():
    found = lb.stability(between_walls(lb.OrdunaLourenco(0.5), 0.0))
    assert "\n" not in str(found)
    assert all(part in str(found) for part in ("only by self-stress", "stone would move", "margin"))
    written = found.to_dict()
    assert (written["analysis"], written["kind"], written["stands"]) == ("stability", "self-stress", False)
    assert written["arising"] is None
    assert written["blocks"] == ["stone"]
    assert np.array(written["displacement_rates"]).shape == (3, 6)


def test_undecided_says_once_how_near_the_best_state_came(monkeypatch):
    tried = [(None, Residual("equilibrium", value, "", "a|b")) for value in (3e-5, 1e-7, 2e-6)]
    monkeypatch.setattr(answers, "_all_states", lambda *_: iter(tried))
    monkeypatch.setattr(answers, "falls", lambda *_: ())
    model = lb.structures.block(lb.PointContact(0.5), width=1.0, height=1.0)
    with pytest.raises(SolverFailure) as said:
        answers.dead_load_state(model.problem)
    best = "the best of 3 states has the equilibrium residual 1.0e-07 at a|b"
    assert str(said.value) == f"whether the dead loads stand is undecided: {best}"


@pytest.mark.parametrize(
    ("lost", "words"),
    [
        (
            f"{arising.__module__}.arising",
            "neither such that do nor blocks that slide through were found",
        ),
        (f"{answers.__name__}.falling", "blocks that nobody wedges move, but no mechanism of them was found"),
    ],
)
def test_stands_or_slides_in_doubt_says_what_was_not_found(lost, words, monkeypatch):
    monkeypatch.setattr(lost, lambda *_, **__: None)
    with pytest.raises(SolverFailure, match=f"exist, .* undecided: {words}; docs/stability.md has"):
        lb.stability(between_walls(lb.OrdunaLourenco(0.5), 0.0))


def vault_in_a_tower(joint):
    """A barrel vault on ledges inside a tower, which it thrusts against."""
    own = lb.structures.tower(joint, length=4.0, width=4.0, courses=10, block_height=0.8)
    vault = lb.structures.barrel_vault(
        joint, radius=1.3, thickness=0.2, length=3.2, courses=7, stones=4, embrace=np.pi
    )
    ledges = [
        lb.Block.box(f"ledge {x} {k}", (0.4, 3.2, 0.8), (x, 2.0, 0.4 + 0.8 * k), GAMMA)
        for x in (0.6, 3.4)
        for k in range(4)
    ]
    lifted = [
        replace(one, name=f"vault {one.name}", vertices=one.vertices + np.array([2.0, 0.4, 3.2]))
        for one in vault.free_blocks
    ]
    return model([*own.blocks, *ledges, *lifted], ["base"], joint)


def test_vault_in_a_tower_stands_on_ledges_that_fall_without_it():
    """The thrust of the vault has no support but the tower: steps that only lower the barrier are lost."""
    whole = vault_in_a_tower(lb.OrdunaLourenco(0.6))
    assert lb.stability(whole).stands
    tower = {one.name for one in whole.free_blocks if one.name.startswith(("front", "back", "left", "right"))}
    blocks = [one for one in whole.blocks if one.name not in tower]
    alone = lb.stability(model(blocks, ["base"], lb.OrdunaLourenco(0.6)))
    assert alone.kind is lb.results.Standing.FALLS


def test_which_joints_are_stiff_can_decide_whether_friction_holds():
    """Compliances times e^z: vertical joints of an arch hold in some trials, with more friction in all."""

    def stands(friction, seed):
        problem = lb.structures.EXAMPLES["arch, vertical joints"](lb.OrdunaLourenco(friction)).problem
        factor = np.exp(np.random.default_rng(seed).normal(size=len(problem.interfaces)))
        weights = joint_compliance(problem) * factor[problem.stress_interface]
        own = arising(Flow(problem), weights)
        return (
            own is not None and Residuals(arising_residuals(Flow(problem), weights, own)).worst.value < 1e-6
        )

    assert [stands(0.8, seed) for seed in range(4)] == [True, False, True, False]
    assert all(stands(1.2, seed) for seed in range(4))


@pytest.mark.parametrize("dead", [lb.loads.Load(), lb.self_weight() - lb.self_weight()])
@pytest.mark.filterwarnings("error")
def test_nothing_stands_under_no_load(dead):
    """The units of force are those of the dead loads: without any they were infinite, and numpy warned."""
    bonded = lb.structures.block(
        lb.OrdunaLourenco(0.6, cohesion=1e4, tensile_strength=5e3), width=1, height=1
    )
    with pytest.raises(lb.ModelError, match="no dead load acts on a free block"):
        lb.stability(replace(bonded, dead=dead))
