"""What holds for every structure: the examples touch exactly, overlap nowhere, and stand."""

import inspect
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

import limitblocks as lb
from limitblocks import structures

JOINT = lb.PointContact(0.7)
SYMMETRICAL = [
    "column", "portal", "arch", "arch, vertical joints", "arch, facets", "arch, fill", "segmental_arch",
    "pointed_arch", "elliptical_arch", "pavilion_vault", "dome_lunes",
]  # fmt: skip


@pytest.fixture(scope="module")
def models():
    return {name: build(JOINT) for name, build in structures.EXAMPLES.items()}


def test_every_function_has_an_example():
    functions = {name for name in structures.__all__ if inspect.isfunction(getattr(structures, name))}
    assert {name.split(",")[0] for name in structures.EXAMPLES} == functions


@pytest.mark.parametrize("name", structures.EXAMPLES)
def test_example_touches_exactly(models, name):
    """A hundred times the tolerance finds no more contacts, a hundredth of it no fewer."""
    model = models[name]
    if name.startswith("two_leaf"):
        return  # by design no joint between the leaves
    supports = set(model.supports)
    for gap, angle in ((1e-2, 5e-2), (1e-5, 1e-5)):
        interfaces = lb.find_interfaces(model.blocks, JOINT, gap=gap, angle=angle)
        assert Counter(i.name for i in interfaces if not {i.block_i, i.block_j} <= supports) == Counter(
            i.name for i in model.interfaces
        )


@pytest.mark.parametrize("name", structures.EXAMPLES)
def test_example_is_connected_and_whole(models, name):
    model = models[name]
    assert len({block.name for block in model.blocks}) == len(model.blocks)
    touched = {block for i in model.interfaces for block in (i.block_i, i.block_j)}
    assert touched == {block.name for block in model.blocks}
    assert all(block.unit_weight == 20e3 for block in model.free_blocks)
    assert len(model.free_blocks) <= 80


@pytest.mark.parametrize("name", structures.EXAMPLES)
def test_example_stands(models, name):
    assert lb.bounds(models[name]).lower > 0.05


@pytest.mark.parametrize("name", SYMMETRICAL)
def test_symmetrical_example_is_as_strong_to_the_left(models, name):
    model = models[name]
    live = model.live.on(model.free_blocks)
    assert live[:, 0].sum() > 0.0
    left = lb.loads.Load(
        tuple(
            (factor, replace(term, direction=tuple(-np.array(term.direction))))
            if hasattr(term, "direction")
            else (factor, replace(term, force=tuple(-np.array(term.force))))
            for factor, term in model.live.terms
        )
    )
    assert lb.bounds(replace(model, live=left)).lower == pytest.approx(lb.bounds(model).lower, rel=1e-5)


@pytest.mark.parametrize("name", ["groin_vault"])
def test_square_vault_is_as_strong_along_either_barrel(models, name):
    model = models[name]
    along_y = replace(model, live=lb.mass_proportional((0.0, 1.0, 0.0)))
    assert lb.bounds(along_y).lower == pytest.approx(lb.bounds(model).lower, rel=1e-5)
