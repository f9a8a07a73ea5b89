"""Every residual is needed: with any one of them set to zero, false claims pass."""

from dataclasses import replace

import pytest
from attacks import ATTACKS

import limitblocks as lb
from limitblocks.evidence import check as checker

NAMES = (
    "equilibrium",
    "yield",
    "flow",
    "normalisation",
    "multipliers",
    "complementarity",
    "dissipation",
    "standing",
)
LEAST = 3


@pytest.fixture(scope="module")
def claims():
    """False claims, made once by the whole checker."""
    return {name: attack.make() for name, attack in ATTACKS.items()}


@pytest.fixture(autouse=True)
def _no_backward_error(claims, monkeypatch):
    """It takes nearly all of the time, and whether a check passes is not its business."""
    error = lb.check_mcp(*next(iter(claims.values()))).backward_error
    monkeypatch.setattr(checker, "backward_error", lambda *_: error)


def passing(claims):
    """Names of the false claims that pass."""
    return [name for name, claim in claims.items() if lb.check_mcp(*claim).passed]


def without(name, monkeypatch):
    """Set one residual of the checker to zero."""
    whole, standing = checker.mcp_residuals, checker._standing

    def spared(entry):
        return replace(entry, value=0.0) if entry.name == name else entry

    def mutilated(flow, state):
        return checker.Residuals(tuple(map(spared, whole(flow, state).entries)))

    monkeypatch.setattr(checker, "mcp_residuals", mutilated)
    monkeypatch.setattr(checker, "_standing", lambda *given: spared(standing(*given)))


def test_these_are_all_residuals_and_no_attack_passes(claims):
    model, claim = next(iter(claims.values()))
    assert tuple(lb.check_mcp(model, claim).residuals.to_dict()) == NAMES
    assert passing(claims) == []


@pytest.mark.parametrize("name", NAMES)
def test_without_one_residual_attacks_pass(name, claims, monkeypatch):
    expected = [word for word, attack in ATTACKS.items() if attack.names == {name}]
    without(name, monkeypatch)
    assert passing(claims) == expected
    assert len(expected) >= LEAST
