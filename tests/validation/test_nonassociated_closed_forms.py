"""Closed forms without dilatancy beside those of docs/validation.md: a block, leaves, and a jammed block."""

import numpy as np
import pytest
from stones import jammed

import limitblocks as lb
from cases.closed_forms import leaves
from limitblocks import structures
from limitblocks.analysis.nonassociated.start import bracket

CLOSE = 1e-5  # residuals of 1e-6 allow the load factor an error a few times as large


@pytest.fixture(params=[lb.OrdunaLourenco, lb.PointContact], ids=lambda kind: kind.__name__)
def joint_type(request):
    return request.param


@pytest.mark.parametrize("share", [0.0, 0.3, 0.7, 1.0])
def test_a_block_slides_at_the_same_load_whatever_the_dilatancy(joint_type, share):
    """With dilatancy d it does the work -W d ds lifting; the load factor is statics alone: mu."""
    model = structures.block(joint_type(0.3), width=1.0, height=0.5)
    result = lb.nonassociated(model, dilatancy=share * 0.3)
    assert result.load_factor == pytest.approx(0.3, rel=CLOSE)
    along, up = result.displacement_rates[1, [0, 2]]
    assert up == pytest.approx(share * 0.3 * along, abs=1e-5 * along)


def test_a_block_pushed_obliquely_with_the_octagon_around_the_circle():
    """Its nearest side is that at 45 degrees; docs/validation.md has a direction near another one."""
    push = {"direction": (np.cos(0.7), np.sin(0.7), 0)}
    octagon = structures.block(lb.OrdunaLourenco(0.3, slip="paper"), width=1.0, height=0.5, **push)
    found = lb.nonassociated(octagon)
    assert found.load_factor == pytest.approx(0.3 / np.cos(0.7 - np.pi / 4), rel=CLOSE)


def test_two_leaves_with_a_rough_joint_rock_between_the_two(joint_type):
    """At least one by one, b / H; at most the associated value, itself below the monolithic 2 b / H."""
    b, height = 0.12, 2.4
    model = leaves(joint_type(0.6), joint_type(0.6))
    result = lb.nonassociated(model)
    assert b / height * (1 - CLOSE) <= result.load_factor <= result.associated < 2 * b / height
    assert lb.check_mcp(model, result).passed


@pytest.mark.parametrize("friction", [0.3, 0.6])
@pytest.mark.parametrize("analysis", [lb.nonassociated, lambda model: lb.load_path(model).collapse])
def test_a_jammed_block_gets_one_checked_answer_of_infinitely_many(joint_type, friction, analysis):
    """Every value >= mu is a solution; the path takes one, and the bracket says that nothing bounds it."""
    model = jammed(joint_type(friction))
    result = analysis(model)
    assert friction * (1 - CLOSE) <= result.load_factor < np.inf
    assert result.associated == np.inf
    assert lb.check_mcp(model, result).worst.value <= 1e-6


def test_a_jammed_block_with_dilatancy_has_no_mechanism_and_says_so(joint_type):
    """It would have to lift as it slides: no solution exists, and none is claimed."""
    model = jammed(joint_type(0.3))
    with pytest.raises(lb.NotConverged, match="no solution within") as caught:
        lb.nonassociated(
            model, dilatancy=0.15, means=[lb.settings.Means(lb.settings.Barrier(), seed=0, budget=40)]
        )
    assert caught.value.result.residuals["flow"] > 1e-3
    assert caught.value.result.associated == np.inf


@pytest.mark.parametrize("joint", [lb.OrdunaLourenco, lb.PointContact])
@pytest.mark.parametrize("mu", [0.2, 0.5, 0.7])
def test_nothing_holds_the_jammed_block_without_friction(joint, mu):
    enclosing = bracket(jammed(joint(mu)))
    assert (enclosing.frictionless, enclosing.associated) == (0.0, np.inf)  # no rounding is told as a load


@pytest.mark.parametrize("ceiling_force", [0.0, 2.0])
def test_the_solutions_of_the_jammed_block_are_many(ceiling_force):
    """By hand: a ceiling force P (over W) leaves W + P below; the block slides at mu (1 + 2 P)."""
    mu, joint = 0.3, lb.OrdunaLourenco(0.3)
    model = jammed(joint)
    weight = model.free_blocks[0].weight
    load_factor = mu * (1 + 2 * ceiling_force)
    Q = []
    for interface in model.interfaces:
        below = "floor" in (interface.block_i, interface.block_j)
        pressure = (1 + ceiling_force if below else ceiling_force) * weight
        friction = mu * pressure
        at = interface.centroid - model.free_blocks[0].centroid
        force = np.array([-friction, 0.0, pressure if below else -pressure])  # on the block
        sign = 1.0 if interface.block_i == "block" else -1.0  # +Q acts on block i
        # the centroid of pressure is free: put the moment that balances the push into the floor joint
        unbalanced = -0.5 * mu * weight if below else 0.0
        own = np.array([0.0, unbalanced, 0.0])
        Q.append(np.concatenate([interface.axes @ (sign * force), interface.axes @ (sign * own)]))
        assert at[2] == pytest.approx(-0.5 if below else 0.5)
    rates = np.zeros((3, 6))
    rates[[b.name for b in model.blocks].index("block"), 0] = 1.0 / weight
    claim = lb.results.Claim(load_factor, np.array(Q), displacement_rates=rates)
    assert lb.check_mcp(model, claim).worst.value <= 1e-9
