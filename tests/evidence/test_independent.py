"""The checker's verdicts against a recomputation in another form, on random falsified claims."""

import numpy as np
import pytest
from independent import joints_of, sizes
from true_claims import changed, state_of, true

import limitblocks as lb
from limitblocks.evidence.claim import claim_of

SAME = 30.0  # the two measure blocks by different sums: sizes agree within this
NAMES = ("equilibrium", "yield", "flow")
SOLVED = {}


def models():
    """Models of corner contacts with the direction of their mass-proportional live load, and true claims."""
    if not SOLVED:
        leaning = lb.structures.overhang(lb.PointContact(0.5), count=3, length=1.0, height=0.2, fraction=0.7)
        SOLVED["wall"] = (*true("points"), np.array([1.0, 0.5, 0.0]) / np.hypot(1.0, 0.5))
        SOLVED["overhang"] = (leaning, claim_of(leaning, lb.nonassociated(leaning)), np.array([1.0, 0, 0]))
    return SOLVED


def test_the_true_claims_pass_both():
    for model, claim, direction in models().values():
        assert lb.check_mcp(model, claim).passed
        assert max(sizes(model, claim, direction).values()) < 1e-9


def falsified(model, claim, seed):
    """One to three parts of the claim changed at random, by 1e-12 (no error) or 1e-6 to 1e-1."""
    rng = np.random.default_rng(seed)
    state, parts = state_of(model, claim), {}
    for part in rng.choice(["load_factor", "x", "u", "y"], rng.integers(1, 4), replace=False):
        value = getattr(state, part)
        size = rng.choice([1e-12, 10.0 ** rng.uniform(-6, -1)]) * np.abs(value).max()
        some = rng.uniform(size=np.shape(value)) < 0.2
        parts[part] = value + size * rng.normal(size=np.shape(value)) * (some if some.any() else 1.0)
    if rng.uniform() < 0.3:  # in balance all the same
        p = model.problem
        x = parts.get("x", state.x)
        off = p.dead + parts.get("load_factor", state.load_factor) * p.live - p.C.T @ x
        parts["x"] = x + np.linalg.lstsq(p.C.T.toarray(), off, rcond=None)[0]
    return changed(model, claim, **parts)


@pytest.mark.parametrize("name", ["wall", "overhang"])
@pytest.mark.parametrize("seed", range(20))
def test_verdicts_agree(name, seed):
    model, claim, direction = models()[name]
    false = falsified(model, claim, seed)
    check = lb.check_mcp(model, false)
    expected = sizes(model, false, direction)
    for residual in NAMES:
        found, other = check.residuals[residual], expected[residual]
        assert (found > check.tolerance) == (other > check.tolerance), residual
        if max(found, other) > check.tolerance:
            assert 1 / SAME < found / other < SAME, residual


def test_falsified_claims_fail_in_every_way():
    """The draws above are not all alike."""
    model, claim, direction = models()["wall"]
    found = [sizes(model, falsified(model, claim, seed), direction) for seed in range(20)]
    for residual in NAMES:
        failed = sum(each[residual] > 1e-8 for each in found)
        assert 3 <= failed <= 17, residual


@pytest.mark.parametrize("name", ["wall", "overhang"])
def test_open_corners_carry_nothing_and_sliding_ones_all_their_friction(name):
    """What complementarity means at a corner, on the true claims."""
    joints = joints_of(*models()[name][:2])
    noise = 1e-8 * max(np.abs(j.forces).max() * max(j.sliding.max(), j.opening.max()) for j in joints)
    for joint in joints:
        for (V1, V2, N), opening, (t, z1, z2) in zip(joint.forces, joint.opening, joint.sliding, strict=True):
            assert abs(opening * N) < noise
            assert abs(z1 * V1 + z2 * V2 - joint.friction * N * t) < noise
