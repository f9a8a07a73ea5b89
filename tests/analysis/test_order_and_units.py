"""Neither the order of blocks and interfaces nor units decide where a path ends."""

from dataclasses import replace

import numpy as np
import pytest

import limitblocks as lb
from limitblocks import structures

MODELS = {
    "portal": structures.portal(
        lb.OrdunaLourenco(0.6), span=1.6, pier_width=0.8, pier_blocks=3, depth=0.8, direction=(1, 1, 0)
    ),
    "corner": structures.corner(
        lb.OrdunaLourenco(0.6), length=2.4, return_length=2.4, courses=4, direction=(1, 0, 0)
    ),
}


def shuffled(model):
    random = np.random.default_rng(1)
    blocks, interfaces = (
        [parts[k] for k in random.permutation(len(parts))] for parts in (model.blocks, model.interfaces)
    )
    return replace(model, blocks=blocks, interfaces=interfaces)


def scaled(model, length):
    """The same weights on blocks `length` times as large."""
    blocks = [
        replace(one, vertices=length * one.vertices, unit_weight=(one.unit_weight or 0.0) / length**3)
        for one in model.blocks
    ]
    interfaces = [
        replace(one, centroid=length * one.centroid, polygon=length * one.polygon) for one in model.interfaces
    ]
    return replace(model, blocks=blocks, interfaces=interfaces, tolerances=None)


@pytest.mark.parametrize("name", MODELS)
@pytest.mark.parametrize("change", [shuffled, lambda model: scaled(model, 1e3)], ids=["order", "units"])
def test_the_answer_is_the_same(name, change):
    found, other = (
        lb.nonassociated(one, confirm=False).load_factor for one in (MODELS[name], change(MODELS[name]))
    )
    assert other == pytest.approx(found, rel=1e-5)  # where rounding closes the path in its interval
