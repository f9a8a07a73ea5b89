"""Loads that go with blocks as they move: added masses, forces, and the prestress of ties."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from limitblocks.arrays import Array
from limitblocks.geometry import Interface
from limitblocks.mechanics import Load
from limitblocks.mechanics.loads.forces import AddedMass, PointForce
from limitblocks.mechanics.loads.load import Term
from limitblocks.model import Model
from limitblocks.practice.elements import Element

Pulls = Sequence[tuple[PointForce, PointForce]]  # what ties pull with before and after


def carried_load(load: Load, at: Callable[[str, Array], Array], pulls: Pulls) -> Load:
    """Return the load on moved blocks: `at` says where their points are, `pulls` what of prestress."""
    terms: list[tuple[float, Term]] = []
    used: set[int] = set()
    for factor, term in load.terms:
        if isinstance(term, PointForce) and (found := _shares(term, pulls)):
            k = next((k for k in found if k not in used), min(found))  # ties on one line are in their order
            used.add(k)
            terms.append((factor * found[k], pulls[k][1]))
        elif isinstance(term, AddedMass | PointForce):
            x, y, z = at(term.block, np.array(term.at)).tolist()
            terms.append((factor, replace(term, at=(x, y, z))))
        else:
            terms.append((factor, term))
    return Load(tuple(terms))


def _shares(term: PointForce, pulls: Pulls) -> dict[int, float]:
    """Which pulls of ties a force may be, and its share of each, as of a partial factor."""
    found = {}
    for k, (pull, _) in enumerate(pulls):
        if (pull.block, pull.at) == (term.block, term.at):  # ties that cross may share their middle
            share = np.dot(pull.force, term.force) / np.dot(pull.force, pull.force)
            if np.allclose(share * np.array(pull.force), term.force):
                found[k] = float(share)
    return found


def prestress(own: Interface, model: Model) -> list[PointForce]:
    """Return the forces of the prestress of a tie, which are among the dead loads of a structure with it."""
    free = {block.name for block in model.free_blocks}
    found = (term for _, term in Element(own).loads(free).terms)
    return [term for term in found if isinstance(term, PointForce)]
