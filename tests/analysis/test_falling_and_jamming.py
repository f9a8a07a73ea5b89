"""Structures that fall, or jam, whatever the live load: said in so many words, never as a load factor."""

from dataclasses import replace

import pytest

import limitblocks as lb
from limitblocks import structures
from limitblocks.analysis.nonassociated import loop

DOWN, UP = (0, 0, -1), (0, 0, 1)
ANALYSES = [lb.bounds, lb.nonassociated, lb.load_path]


def arch(thickness, direction):
    """The least thickness over radius is .107 (Milankovitch 1907)."""
    ring = structures.arch(lb.PointContact(0.5), radius=1.0, thickness=thickness, voussoirs=9)
    return replace(ring, live=lb.mass_proportional(direction))


@pytest.mark.parametrize("analysis", ANALYSES)
@pytest.mark.parametrize("direction", [DOWN, UP])
def test_what_cannot_stand_falls_though_some_load_factor_balances_it(analysis, direction):
    """At load factor -1 (down) or 1 (up) nothing weighs anything: a trivial solution, no collapse."""
    with pytest.raises(lb.errors.NoEquilibrium, match="cannot stand"):
        analysis(arch(0.05, direction))


def test_the_trivial_solution_of_what_falls_is_refused_by_the_checker():
    model = arch(0.05, DOWN)
    nothing = lb.results.Claim(
        -1.0,
        [[0.0] * 6 for _ in model.interfaces],
        generalised_stresses=[0.0] * model.problem.C.shape[0],
    )
    check = lb.check_mcp(model, nothing)
    assert check.residuals["equilibrium"] <= 1e-15
    assert check.residuals["standing"] > 1e-3
    assert not check.passed


def test_more_weight_does_not_end_what_stands():
    with pytest.raises(lb.errors.UnlimitedLoad, match="without limit"):
        lb.bounds(arch(0.25, DOWN))


def test_a_column_under_more_of_its_own_weight_is_refused_without_a_search(monkeypatch):
    """Normal forces alone carry it, so that no mechanism of any flow rule does positive work."""
    monkeypatch.setattr(loop, "first_to_solve", None)
    model = replace(structures.ferris_tin_loi_wall(1, lb.PointContact(0.6)), live=lb.mass_proportional(DOWN))
    with pytest.raises(lb.errors.UnlimitedLoad, match="normal forces alone balance it"):
        lb.nonassociated(model)


def test_lifted_blocks_part_where_their_weight_is_gone():
    """Upwards the live load takes the weight away: at load factor 1 the top block floats."""
    found = lb.bounds(arch(0.25, UP))
    assert found.lower == pytest.approx(1.0, rel=1e-6)
    assert found.upper == pytest.approx(1.0, rel=1e-6)


@pytest.mark.parametrize("friction", [1e3, 1e8])
@pytest.mark.parametrize("kind", [lb.PointContact, lb.OrdunaLourenco])
def test_a_block_that_cannot_slide_rocks(kind, friction):
    model = structures.block(kind(friction), width=0.5, height=1.0)
    assert lb.bounds(model).lower == pytest.approx(0.5, rel=1e-6)
    assert lb.nonassociated(model).load_factor == pytest.approx(0.5, rel=1e-6)
