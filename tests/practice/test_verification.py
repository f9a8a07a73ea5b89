"""Verification of a facade of one block by closed forms; misuse."""

from dataclasses import replace

import numpy as np
import pytest
from facades import ARM, FC, FLOOR, SITE, WEIGHT, G, H, T
from stones import model_of, pair

import limitblocks as lb
from limitblocks.evidence.ending import Status
from limitblocks.mechanics import Load
from limitblocks.practice import Floor, FloorMode, Spectrum, capacity_curve, reinforced, tie, verification

PUSH = lb.mass_proportional((1, 0, 0))


def test_facade_of_one_block(facade, answer, curve):
    """e*, a0*, d0*, T_SLV and the ratio at .25 g, S 1.2, q 2, each from its formula."""
    found = verification(facade, answer, SITE, q=2.0, curve=curve, confidence=FC, collapse_demand=SITE)
    own = WEIGHT * T * H
    P, delta = np.array([own, FLOOR]), np.array([H / 2, H])  # per unit rotation
    alpha = (own * T / 2 + FLOOR * ARM) / (P @ delta)
    e = (P @ delta) ** 2 / (P @ delta**2) / P.sum()
    a0 = alpha * G / (e * FC)
    d0 = H * np.sin(np.arctan(alpha)) * (P @ delta**2) / (H * P @ delta)
    period = 1.68 * np.pi * np.sqrt(0.4 * d0 / (0.6 * a0))
    expected = {"alpha0": 0.0907692, "e*": 0.9037433, "a0*": 0.7298419, "d0*": 0.2955306, "T_SLV": 2.742208}
    formulas = {"alpha0": alpha, "e*": e, "a0*": a0, "d0*": d0, "T_SLV": period}
    for symbol, value in expected.items():
        assert formulas[symbol] == pytest.approx(value, abs=6e-7)
        assert found[symbol] == pytest.approx(formulas[symbol], rel=1e-7)
    assert found["M*"] == pytest.approx(e * P.sum() / G, rel=1e-7)
    assert found.checks[0].ratio == pytest.approx(0.495985, abs=6e-7)
    assert not found.checks[0].satisfied
    assert found.moving == ("wall",)
    given = {
        "a_g": 0.25 * G,
        "S": 1.2,
        "F0": 2.5,
        "T_C": 0.5,
        "T_D": 2.6,
        "q": 2.0,
        "FC": FC,
        "a_g_SLC": 0.25 * G,
    }
    assert {symbol: found[symbol] for symbol in given} == pytest.approx(given)
    assert len({one.symbol for one in found.quantities}) == len(found.quantities)
    flat = SITE.a_g * SITE.S * SITE.F0 * SITE.T_C * SITE.T_D / (2 * np.pi) ** 2  # beyond T_D
    wanted = flat * np.sqrt(10 / (5 + 8))
    assert found["S_De_SLV"] == pytest.approx(wanted, rel=1e-9)
    assert found["d*/S_De_SLV"] == pytest.approx(0.4 * d0 / wanted, rel=1e-7)
    assert found.checks[1].ratio == pytest.approx(found["a_g,SLV,d"] / SITE.a_g)
    assert found["S_De_SLC"] == pytest.approx(flat * np.sqrt(10 / (5 + 10)), rel=1e-9)
    assert found["T_SLC"] == pytest.approx(1.56 * np.pi * np.sqrt(0.6 * d0 / (0.4 * a0)), rel=1e-7)
    assert [one.name for one in found.checks] == ["linear, SLV", "non-linear, SLV", "non-linear, SLC"]
    assert str(found).startswith(f"a0* = {a0:.4g} m/s2; linear, SLV: 0.496 not satisfied; non-linear, SLV: ")


def test_what_is_not_satisfied_is_not_told_as_one(facade, answer):
    """The demand is proportional to a_g: at 1 / .9997 of the capacity it was "1.000 not satisfied"."""
    ratio = verification(facade, answer, SITE, q=2.0, confidence=FC).checks[0].ratio
    site = replace(SITE, a_g=SITE.a_g * ratio / 0.9997)
    found = verification(facade, answer, site, q=2.0, confidence=FC)
    assert found.checks[0].ratio == pytest.approx(0.9997)
    assert "linear, SLV: 0.999 not satisfied" in str(found)


def test_the_default_control_is_above_the_toe(facade, answer, curve):
    """d0* = .2955306 m; negative control: the corner behind it moves T (1 - cos) farther."""
    whole = capacity_curve(facade, steps=3)
    found = verification(facade, answer, SITE, q=2.0, confidence=FC, curve=whole)
    assert whole.control.point[0] == T / 2
    assert found["d0*"] == pytest.approx(0.2955306, abs=6e-7)
    inner = capacity_curve(facade, control=("wall", (-T / 2, 0, H)), steps=3)
    behind = verification(facade, answer, SITE, q=2.0, confidence=FC, curve=inner)["d0*"]
    more = T * (1 - np.cos(np.arctan(found["alpha0"])))
    assert behind / found["d0*"] == pytest.approx(1 + more / whole.zero, rel=1e-6)


def test_each_mass_and_each_sum(facade, answer):
    """Turning about the toe: horizontal displacements go as heights, vertical ones as arms to the toe."""
    found = verification(facade, answer, SITE, q=2.0, confidence=FC)
    own = WEIGHT * T * H
    wall, floor = found.masses
    assert (wall.name, floor.name) == ("wall", "mass on wall")
    assert (wall.weight, floor.weight) == pytest.approx((own, FLOOR))
    assert (wall.horizontal, floor.horizontal) == pytest.approx((0.5, 1.0))
    assert (wall.vertical, floor.vertical) == pytest.approx((T / 2 / H, ARM / H))
    assert found["sum P"] == pytest.approx(own + FLOOR)
    assert found["sum P dx"] == pytest.approx(own / 2 + FLOOR)
    assert found["sum P dx^2"] == pytest.approx(own / 4 + FLOOR)
    assert found["sum P dy"] == pytest.approx(own * T / 2 / H + FLOOR * ARM / H)
    assert found["alpha0"] == pytest.approx(found["sum P dy"] / found["sum P dx"], rel=1e-7)  # [C8.7.1.1]


def test_ground_accelerations_of_the_linear_checks(facade, answer):
    """C8.7.1.2.1.5 and .7: a_Z = a_g S at the ground, q times as much at SLV; SLD of its own spectrum."""
    damage = Spectrum(a_g=0.05 * G, S=1.2, F0=2.5, T_C=0.5)
    found = verification(facade, answer, SITE, q=2.0, confidence=FC, damage_demand=damage)
    assert found["a_g,SLD"] == pytest.approx(found["a0*"] / 1.2)
    assert found["a_g,SLV"] == pytest.approx(2 * found["a0*"] / 1.2)
    assert found["zeta_E"] == pytest.approx(0.495985, abs=6e-7)
    check = found.checks[1]
    assert (check.name, check.satisfied) == ("linear, SLD", True)
    assert (check.capacity, check.demand) == pytest.approx((found["a0*"], 0.05 * G * 1.2))


def test_damping_in_per_cent_is_refused(facade, answer, curve):
    with pytest.raises(lb.ModelError, match=r"damping at SLV is 8\.0, expected .* <= 0\.3"):
        verification(facade, answer, SITE, q=2.0, curve=curve, damping=(8.0, 10.0))


def test_confidence_of_joints_without_compressive_strength(facade, answer):
    """C8.7.1.2.1.3 asks the factor of LC1 where crushing is left out."""
    assert verification(facade, answer, SITE, q=2.0).remarks == ()
    (said,) = verification(facade, answer, SITE, q=2.0, confidence=1.2).remarks
    assert said.startswith("FC 1.2 with joints without compressive strength")


def test_what_a_file_says_is_checked_before_it_is_verified(facade, answer, curve, tmp_path):
    """Five times the load factor in a file would have satisfied a check that fails."""
    found = verification(facade, answer, SITE, q=2.0)
    read = lb.read_result(answer.save(tmp_path / "answer.json"), facade)
    assert verification(facade, read, SITE, q=2.0).quantities == found.quantities
    with pytest.raises(lb.errors.CheckFailed, match="equilibrium"):
        verification(facade, replace(read, load_factor=5.0 * read.load_factor), SITE, q=2.0)
    stopped = replace(answer, status=Status.OUT_OF_STEPS)
    with pytest.raises(lb.ModelError, match="is no solution: not converged"):
        verification(facade, stopped, SITE, q=2.0)
    kept = lb.read_result(curve.save(tmp_path / "curve.json"), facade)
    (said,) = verification(facade, answer, SITE, q=2.0, curve=kept).remarks
    assert said == "the capacity curve is as a file says, not computed here"


def test_fill_that_is_not_pushed_is_said(facade, answer):
    """Fill over the wall weighs in alpha0 and is none of the masses; the same as an added mass is one."""
    filled = replace(facade, dead=facade.dead + lb.loads.fill(15e3, H + 1.0))
    found = verification(filled, lb.nonassociated(filled), SITE, q=2.0)
    own = WEIGHT * T * H
    arms = own * T / 2 + FLOOR * ARM + 15e3 * T * T / 2
    assert found["alpha0"] == pytest.approx(arms / (own * H / 2 + FLOOR * H), rel=1e-6)
    assert found["sum P"] == pytest.approx(own + FLOOR)
    (said,) = found.remarks
    assert said.startswith("there is fill among the dead loads, whose mass is not pushed")
    assert verification(facade, answer, SITE, q=2.0).remarks == ()


def test_an_associated_load_factor_is_said_to_be_one(facade, answer):
    words = [q.formula for q in verification(facade, answer, SITE, q=2.0).quantities if q.symbol == "alpha0"]
    assert words == ["without dilatancy, this report"]
    found = verification(facade, lb.bounds(facade), SITE, q=2.0)
    assert next(q.formula for q in found.quantities if q.symbol == "alpha0") == "associated, this report"
    assert found.remarks[0].startswith(
        "alpha0 is associated: where joints slide, real friction may give less"
    )


def test_a_ground_acceleration_that_may_be_in_g_is_asked_about(facade, answer):
    """.25 g = 2.45 m/s2; .5 m/s2 is a calm site."""
    (said,) = verification(facade, answer, Spectrum(0.25, 1.2, 2.5, 0.5), q=2.0).remarks
    assert said == "a_g is 0.25 m/s2, 0.025 g: g? 0.25 g = 2.45 m/s2"
    assert verification(facade, answer, Spectrum(0.5, 1.2, 2.5, 0.5), q=2.0).remarks == ()


def test_a_ground_acceleration_that_may_be_in_m_s2_is_asked_about(facade, answer):
    """1.5 m/s2 = .153 g, given as 1.5 g; .6 g is a fierce site."""
    (said,) = verification(facade, answer, Spectrum(1.5 * 9.81, 1.2, 2.5, 0.5), q=2.0).remarks
    assert said == "a_g is 14.7 m/s2, 1.5 g: m/s2? 1.5 m/s2 = 0.153 g"
    assert verification(facade, answer, Spectrum(0.6 * 9.81, 1.2, 2.5, 0.5), q=2.0).remarks == ()


def test_limit_states_in_another_order_than_their_return_periods_are_asked_about(facade, answer, curve):
    """NTC 2018, 3.2.1: SLD, SLV and SLC are exceeded in 63, 10 and 5 % of the reference period."""
    low, high = (Spectrum(a * G, 1.2, 2.5, 0.5) for a in (0.1, 0.4))
    asked = verification(facade, answer, SITE, q=2.0, damage_demand=high, collapse_demand=low, curve=curve)
    assert asked.remarks == (
        "a_g at SLV is 2.45 m/s2, at SLD 3.92 m/s2, more: exchanged?",
        "a_g at SLC is 0.981 m/s2, at SLV 2.45 m/s2, more: exchanged?",
    )
    right = verification(facade, answer, SITE, q=2.0, damage_demand=low, collapse_demand=high, curve=curve)
    assert right.remarks == ()


def test_a_spectrum_of_slc_without_a_curve_is_no_check_in_silence(facade, answer):
    """.0908 g/(.9037 x 1.35) = .73 m/s2 is more than .02 g x 1.2/2: all that is checked is satisfied."""
    site = Spectrum(0.02 * G, 1.2, 2.5, 0.5)
    found = verification(facade, answer, site, q=2.0, confidence=FC, collapse_demand=site)
    assert [one.satisfied for one in found.checks] == [True]
    assert found.left_out == "no non-linear check at SLC: it needs a capacity curve"
    assert found.left_out in str(found)
    text = lb.report(facade, answer, found).text
    assert "not complete" in text
    assert not verification(facade, answer, site, q=2.0, confidence=FC).left_out


def test_scale_of_the_mechanism_does_not_matter(facade, answer):
    """Bounds and the answer without dilatancy have one mechanism here, in one scale or another."""
    found = verification(facade, answer, SITE, q=2.0, confidence=1.0)
    assert found["a0*"] == pytest.approx(answer.load_factor * G / found["e*"], rel=1e-12)
    assert 0.0 < found["e*"] <= 1.0


def test_mechanism_on_a_floor(facade, answer):
    floor = Floor((FloorMode(0.4, 1.3, 0.8),))
    found = verification(facade, answer, SITE, q=2.0, floor=floor)
    assert found.checks[0].demand == pytest.approx(floor.largest(SITE) / 2.0)
    given = {"T_1": 0.4, "gamma_1": 1.3, "psi_1(z)": 0.8, "xi_1": 0.05, "a_Z": floor.largest(SITE)}
    assert {symbol: found[symbol] for symbol in given} == pytest.approx(given)


def test_spectrum_without_q(facade, answer):
    with pytest.raises(
        lb.ModelError, match="q is missing: the check at SLV needs a behaviour factor"
    ) as caught:
        verification(facade, answer, SITE)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("other", [lb.mass_proportional((0, 0, 1)), lb.mass_proportional((0, 1, 0))])
def test_weights_along_several_directions(facade, other):
    model = replace(facade, live=0.5 * PUSH + 0.5 * other)
    with pytest.raises(lb.ModelError, match="expected one horizontal direction"):
        verification(model, lb.nonassociated(model), SITE, q=2.0)


@pytest.mark.parametrize("share", [0.5, -1.0])
def test_a_share_of_the_weights_is_no_acceleration_over_g(facade, share):
    """Half the weight has twice the load factor, and would have twice the acceleration."""
    half = replace(facade, live=share * facade.live)
    with pytest.raises(lb.ModelError, match=f"the weights times {share:g}; expected 1"):
        verification(half, lb.bounds(half), SITE, q=2.0)


def test_a_mass_that_weighs_is_pushed_too(facade):
    """Left out of the live load it stabilises, and the earthquake would pass it by."""
    block = facade.free_blocks[0]
    floor = lb.loads.added_mass(block.name, block.centroid.tolist(), weight=1e3)
    still = replace(facade, dead=lb.self_weight([floor]))
    with pytest.raises(lb.ModelError, match=f"lacks the mass added to {block.name} in the dead load"):
        verification(still, lb.bounds(still), SITE, q=2.0)
    direction = facade.live.terms[0][1].direction
    pushed = replace(still, live=lb.mass_proportional(direction, [floor]))
    blocks, mass = pushed.live.terms
    partly = replace(still, live=Load((blocks, (0.99, mass[1]))))
    with pytest.raises(lb.ModelError, match=f"the mass added to {block.name} in the dead load, or a part"):
        verification(partly, lb.bounds(partly), SITE, q=2.0)
    twice = replace(pushed, dead=lb.self_weight([floor, floor]))
    with pytest.raises(lb.ModelError, match=f"the mass added to {block.name} in the dead load, or a part"):
        verification(twice, lb.bounds(twice), SITE, q=2.0)
    alone = replace(still, live=Load((mass,)))
    with pytest.raises(lb.ModelError, match="the weights times 0; expected 1"):
        verification(alone, lb.bounds(alone), SITE, q=2.0)
    assert any(floor.block in one.name for one in verification(pushed, lb.bounds(pushed), SITE, q=2.0).masses)


def test_a_floor_given_as_a_force_has_no_mass_and_is_told():
    """W t / 2 + P t / 2 = alpha W h / 2, and as a mass alpha (W h / 2 + P h); prestress has none."""
    b, h, W, P = 1.0, 4.0, 80e3, 20e3  # m, N
    stones = [
        lb.Block.box("ground", (8, 4, 0.4), (0, 0, -0.2)),
        lb.Block.box("wall", (b, 1, h), (0, 0, h / 2), W / (b * h)),
    ]
    wall = model_of(stones, ["ground"], lb.PointContact(0.8))
    mass = lb.loads.added_mass("wall", (0, 0, h), weight=P)
    pushed = replace(wall, live=lb.mass_proportional((1, 0, 0), [mass]))
    yields, area = 100e3, 1e-3
    bar = tie("wall", (0, 0, 1), "ground", (0, 0, -1), area=area, strength=yields / area, prestress=P)
    loads = (
        lb.loads.force("wall", (0, 0, -P), (0, 0, h)),
        lb.loads.top_force((0, 0, -P), (0, 0)),
        lb.loads.line_load((0, 0, -P), (-0.5, 0), (0.5, 0)),
        lb.loads.pressure("wall", P / b, facing=(0, 0, 1)),
    )
    still, moved = (W + P) * b / (W * h), (W + P) * b / 2 / (W * h / 2 + P * h)
    models = [(replace(wall, dead=wall.dead + load), still, True) for load in loads]
    models += [(replace(pushed, dead=wall.dead + loads[0]), moved, False)]
    models += [(replace(pushed, dead=lb.self_weight([mass])), moved, False), (wall, b / h, False)]
    models += [(reinforced(wall, bar), (W + yields) * b / (W * h), False)]
    for model, alpha, told in models:
        found = verification(model, lb.nonassociated(model), SITE, q=2.0)
        assert found["alpha0"] == pytest.approx(alpha, rel=1e-6)
        assert [one for one in found.remarks if "mass is not pushed" in one] == [
            "forces among the dead loads press down with 20 kN, whose mass is not pushed; where it moves "
            "with the blocks, as of a floor, give it to both loads (limitblocks.loads.added_mass)"
        ] * told


def test_a_block_that_is_lifted_only_does_work():
    """A wedge without friction lifts a stone along a wall: alpha0 = W_stone slope / W_wedge, [C8.7.1.1]."""
    slope, W = 0.2, 20e3

    def prism(name, outline, unit_weight=None):
        return lb.Block.prism(name, outline, (0.0, 1.0), unit_weight=unit_weight, along="y")

    blocks = [
        prism("ground", [(-1, -0.5), (3, -0.5), (3, 0), (-1, 0)]),
        prism("stop", [(-0.5, 0), (0, 0), (0, 0.8), (-0.5, 0.8)]),
        prism("wall", [(2, 0.6), (2.5, 0.6), (2.5, 1.5), (2, 1.5)]),
        prism("wedge", [(0, 0), (2, 0), (2, 0.4), (0, 0.4 + 2 * slope)], W),
        prism("stone", [(1, 0.4 + slope), (2, 0.4), (2, 1.5), (1, 1.5)], W),
    ]
    contacts = lb.find_interfaces(blocks, lb.PointContact(0.0))
    loads = lb.self_weight(), lb.mass_proportional((1, 0, 0))
    model = lb.Model(blocks, ["ground", "stop", "wall"], contacts, *loads)
    found = verification(model, lb.bounds(model), SITE, q=2.0, confidence=FC)
    wedge, stone = W * 2 * (0.4 + slope), W * (1.1 - slope / 2)
    assert found["alpha0"] == pytest.approx(stone * slope / wedge, rel=1e-6)
    assert found.moving == ("wedge", "stone")
    assert found["sum P dy"] == pytest.approx(found["alpha0"] * found["sum P dx"], rel=1e-6)
    assert found["e*"] == pytest.approx(1.0)  # the wedge alone: its a0* is the least that the text can mean
    assert found["M*"] == pytest.approx(wedge / G)


def test_where_sliding_counts_alpha0_is_said_to_be_one_answer():
    """Docs of the range: of two stones .2 and .5 smooth, .6 between, from .33884 to .36709 solve."""
    two = pair(*map(lb.PointContact, (0.2, 0.5, 0.6)))
    found = lb.load_factor_range(two, paths=3, mechanisms=2)
    least = min((one.solution for one in found.answers), key=lambda one: one.load_factor)
    said = verification(two, least, SITE, q=2.0)
    assert said["alpha0"] == pytest.approx(0.35 - 0.6 * 0.3**2 / (4 + 2 * 0.6 * 0.7))
    associated = lb.bounds(two).upper
    assert said.remarks[0].startswith("alpha0 = 0.3388 is one answer, others may solve as well, up to")
    assert f"{associated:.4g} (associated)" in said.remarks[0]
    assert verification(two, lb.bounds(two), SITE, q=2.0).remarks[0].startswith("alpha0 is associated")


def test_what_rounding_leaves_of_prestress_is_no_force():
    """Ties that cross one another are all inner forces, whatever their pulls add up to."""
    stones = [
        lb.Block.box("ground", (8, 4, 0.4), (0, 0, -0.2)),
        lb.Block.box("wall", (1, 1, 4), (0, 0, 2), 20e3),
    ]
    wall = model_of(stones, ["ground"], lb.PointContact(0.8))
    ends = [((0.1 * k, 0.03 * k, 1.0 + k / 7), (0.3 / k, 0.1, -0.1 * k)) for k in (1, 2, 3)]
    bars = [
        tie("wall", head, "ground", foot, area=1e-3, strength=1e8, prestress=1e4 / k)
        for k, (head, foot) in zip((3, 7, 9), ends, strict=True)
    ]
    model = reinforced(wall, *bars)
    found = verification(model, lb.nonassociated(model), SITE, q=2.0)
    assert not [one for one in found.remarks if "mass is not pushed" in one]
