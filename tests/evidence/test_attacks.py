"""Falsified claims: each is refused, by the residuals that name it or a sentence; the true ones pass."""

import pytest
from attacks import ATTACKS
from true_claims import TRUE, true

import limitblocks as lb


def refused_by(model, claim):
    check = lb.check_mcp(model, claim)
    of_bounds = "gap" in {entry.name for entry in check.residuals.entries}
    assert check.tolerance == (1e-6 if of_bounds else 1e-8)
    return {entry.name for entry in check.residuals.above(check.tolerance)}


@pytest.mark.parametrize("name", TRUE)
def test_true_claims_pass(name):
    model, claim = true(name)
    assert refused_by(model, claim) == set()


@pytest.mark.parametrize("name", ATTACKS)
def test_a_false_claim_is_refused_by_its_residuals(name):
    model, claim = ATTACKS[name].make()
    assert refused_by(model, claim) == ATTACKS[name].names
    with pytest.raises(lb.errors.CheckFailed, match=min(ATTACKS[name].names)):
        lb.check_mcp(model, claim).require()
