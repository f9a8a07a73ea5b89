"""Ties, dowels, partial factors and repairs in space against another program."""

import numpy as np
import pytest
from corner_forces import CornerForces
from stones import model_of

import limitblocks as lb
from limitblocks.practice import PartialFactors, adequacy, dowel, least_masses, least_ties, reinforced, tie

PUSH = (1.0, 0.4, 0.0)


def tower():
    """Three stones, turned and shifted, on the ground."""
    stones = [lb.Block.box("ground", (4, 4, 0.4), (0, 0, -0.2))]
    for k, (turn, shift) in enumerate(((0.0, 0.0), (0.3, 0.05), (-0.2, 0.02))):
        c, s = np.cos(turn), np.sin(turn)
        outline = np.array([(0.5, -0.3), (0.5, 0.3), (-0.5, 0.3), (-0.5, -0.3)]) @ [(c, s), (-s, c)] + shift
        stones.append(lb.Block.prism(f"stone {k}", outline, (0.8 * k, 0.8 * k + 0.8), 20e3, along="z"))
    return model_of(stones, ["ground"], lb.PointContact(0.6), PUSH)


def rods(seed, model, most):
    """Anchors in two of the blocks, the most that the tie carries, a prestress: three of them."""
    random = np.random.default_rng(seed)
    free, weight = model.free_blocks, sum(block.weight for block in model.free_blocks)
    for _ in range(3):
        block = free[random.integers(len(free))]
        at = random.dirichlet(np.ones(len(block.vertices))) @ block.vertices
        foot = at + random.uniform([-4, -2, -2], [-1, 2, 0.5])
        strength = most * weight * random.uniform(0.2, 1)
        yield block.name, at, model.supports[0], foot, strength, 0.1 * strength * random.integers(2)


def made(block_i, at_i, block_j, at_j, most, prestress=0.0):
    """The tie as several bars, of which the anchors hold less than their sections."""
    return tie(block_i, at_i, block_j, at_j, area=1e-4, strength=most / 1e-4, pull_out=most, number_of=2,
               prestress=prestress)  # fmt: skip


@pytest.mark.parametrize("seed", range(4))
def test_ties_and_a_dowel_in_space_with_partial_factors(seed):
    model = tower()
    own = [*rods(seed, model, 0.2)]
    factors = PartialFactors(1.2, 1.5, 1.1, 1.25, 1.15)
    joint = model.interfaces[seed % 3]
    shear = 0.02 * sum(block.weight for block in model.free_blocks)
    held = reinforced(
        model, *(made(*one) for one in own), dowel(joint, joint.centroid, diameter=0.02, capacity=shear)
    )
    program = CornerForces(model, PUSH, divisor=factors.gamma_phi)
    for *ends, most, prestress in own:
        program.tie(*ends, most / factors.gamma_S, factors.gamma_G * prestress)
    program.dowel(joint, joint.centroid, shear / factors.gamma_S)
    program.dead *= factors.gamma_G
    program.live *= factors.gamma_Q
    found = adequacy(held, factors, without_dilatancy=False).bounds
    assert [found.lower, found.upper] == pytest.approx([program.load_factor()] * 2, rel=1e-6)


def test_least_ties_and_masses_in_space():
    model = tower()
    required = 1.2 * lb.bounds(model).lower
    own = [one[:5] for one in rods(7, model, 0.5)]
    program = CornerForces(model, PUSH)
    for *ends, most in own:
        program.tie(*ends, most, cost=1.0)
    found = least_ties(model, [made(*one) for one in own], required)
    assert found.total == pytest.approx(program.least(required), rel=1e-6)
    program = CornerForces(model, PUSH)
    at, push = model.free_blocks[0].centroid - [0.2, 0, 0.3], np.array(PUSH) / np.linalg.norm(PUSH)
    down = np.array([0.0, 0.0, -1.0]) + required * push
    program.column(program.on("stone 0", np.concatenate([down, np.cross(at, down)])), 0.0, np.inf, 1.0)
    heaped = least_masses(model, [("stone 0", at)], required)
    assert heaped.total == pytest.approx(program.least(required), rel=1e-6)
