"""Loads that go with blocks as they move: added masses, forces, and the prestress of ties."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from limitblocks.arrays import Array
from limitblocks.geometry import Interface
from limitblocks.mechanics import Load
from limitblocks.mechanics.loads.forces import AddedMass, PointForce
from limitblocks.mechanics.loads.load import Term, Vector
from limitblocks.model import Model
from limitblocks.practice.elements import Element

Pulls = dict[tuple[str, Vector], tuple[Array, PointForce]]


def carried_load(load: Load, at: Callable[[str, Array], Array], pulls: Pulls) -> Load:
    """Return the load on moved blocks: `at` says where their points are, `pulls` what of prestress."""
    terms: list[tuple[float, Term]] = []
    for factor, term in load.terms:
        if isinstance(term, PointForce) and (term.block, term.at) in pulls:
            pull, after = pulls[term.block, term.at]
            share = float(pull @ term.force) / float(pull @ pull)  # a partial factor may be in either
            if np.allclose(share * pull, term.force):
                terms.append((factor * share, after))
                continue
        if isinstance(term, AddedMass | PointForce):
            x, y, z = at(term.block, np.array(term.at)).tolist()
            terms.append((factor, replace(term, at=(x, y, z))))
        else:
            terms.append((factor, term))
    return Load(tuple(terms))


def prestress(own: Interface, model: Model) -> list[PointForce]:
    """Return the forces of the prestress of a tie, which are among the dead loads of a structure with it."""
    free = {block.name for block in model.free_blocks}
    found = (term for _, term in Element(own).loads(free).terms)
    return [term for term in found if isinstance(term, PointForce)]
