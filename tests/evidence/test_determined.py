"""What the mechanism of a structure says of its stresses: hinges make an arch determinate."""

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.evidence.determined import determined
from limitblocks.problem import State

JOINTS = [lb.PointContact(0.7), lb.OrdunaLourenco(0.7)]


def told(model, result, **settings):
    """Whether N of each interface is determined."""
    p = model.problem
    rates = result.displacement_rates[model.free].ravel()
    state = p.dimensionless(State(1.0, result.generalised_stresses, rates, result.flow_multipliers))
    return determined(p, state.y, p.resultants[2::6], **settings)


@pytest.mark.parametrize("joint", JOINTS)
@pytest.mark.parametrize("analysis", [lb.bounds, lb.nonassociated])
def test_four_hinges_determine_an_arch_and_its_load_factor(joint, analysis):
    """Three redundant forces and the load factor, by four moments; what lifts off carries nothing."""
    arch = lb.structures.arch(joint, radius=5.0, thickness=1.0, voussoirs=11)
    assert told(arch, analysis(arch)).all()


@pytest.mark.parametrize("joint", JOINTS)
def test_a_stone_between_walls_may_be_wedged_more(joint):
    """Its sliding leaves no shear upwards, and the floor its weight; the walls may press it by any force."""
    stones = [
        lb.Block.box("left", (1, 1, 0.5), (-1, 0, 0)),
        lb.Block.box("right", (1, 1, 0.5), (1, 0, 0)),
        lb.Block.box("floor", (1, 1, 1), (0, 0, -0.75)),
        lb.Block.box("stone", (1, 1, 0.5), (0, 0, 0), 20e3),
    ]
    faces = [one for one in lb.find_interfaces(stones, joint) if "stone" in (one.block_i, one.block_j)]
    push = lb.mass_proportional((0, 1, 0))
    model = lb.Model(stones, ["left", "right", "floor"], faces, lb.self_weight(), push)
    found = told(model, lb.nonassociated(model))
    assert found.tolist() == [not {"left", "right"} & {one.block_i, one.block_j} for one in faces]


def test_no_functional_is_no_question():
    arch = lb.structures.arch(JOINTS[1], radius=5.0, thickness=1.0, voussoirs=5)
    p = arch.problem
    assert determined(p, np.zeros(len(p.g)), p.resultants[:0]).shape == (0,)
