"""The least reinforcement that reaches a required load factor: convex for associated flow, then checked."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from limitblocks.analysis.bounds import bounds
from limitblocks.analysis.least import least_loads, least_stresses
from limitblocks.analysis.nonassociated.loop import nonassociated
from limitblocks.arrays import Array, as_typed, read_only
from limitblocks.errors import ModelError, SolverFailure, sequence_of
from limitblocks.evidence.associated import Bounds
from limitblocks.evidence.results import Nonassociated
from limitblocks.geometry.distance import distance
from limitblocks.geometry.polygon import areas
from limitblocks.joints import Backfill, Tie
from limitblocks.mechanics import Load
from limitblocks.mechanics.loads import added_mass
from limitblocks.mechanics.loads.forces import AddedMass, MassProportional
from limitblocks.mechanics.loads.load import Vector, number, of, vector
from limitblocks.model import Model, checked_model
from limitblocks.practice.elements import Element, with_elements
from limitblocks.problem import LimitProblem
from limitblocks.shown import Result, coordinates, kept, many

AMPLE = 1e-6  # more than the least, so that a checked answer reaches what is required
NONE = 1e-6  # of the largest: what is less is left out
ROUNDED = 1e-9  # of the mean load of a block: less is the rounding of a program that needs nothing


@dataclass(frozen=True, eq=False, repr=False)
class Repair(Result):
    """The least reinforcement for associated flow, and what it brings without dilatancy.

    Attributes
    ----------
    amounts : Array, shape (k,)
        Tie forces or added weights of the k candidates, N; zero where one is not needed.
    total : float
        Their sum, N.
    model : Model
        The structure with them.
    bounds : Bounds
        Of `model`: its static load factor is at least what was required, less 1e-5 of it.
    result : Nonassociated
        Of `model`, without dilatancy: may be less.
    candidates : tuple of str
        What the amounts are of.
    required : float
        Load factor that was required.
    digest : str
        SHA-256 of the model that was given.
    """

    amounts: Array
    total: float
    model: Model
    bounds: Bounds
    result: Nonassociated
    candidates: tuple[str, ...]
    required: float
    digest: str

    def __post_init__(self) -> None:
        if len(self.amounts) != len(self.candidates):
            given = many(len(self.amounts), "amount")
            raise ModelError(f"{given} of {many(len(self.candidates), 'candidate')}")

    @property
    def remarks(self) -> tuple[str, ...]:
        """What to know of both answers of the structure with the reinforcement."""
        return tuple(dict.fromkeys(self.bounds.remarks + self.result.remarks))

    def rows(self) -> list[dict[str, Any]]:
        """Return a row for each candidate."""
        pairs = zip(self.candidates, self.amounts.tolist(), strict=True)
        return [{"candidate": name, "amount": amount} for name, amount in pairs]

    def to_dict(self) -> dict[str, Any]:
        """Return the amounts and both results as numbers and text."""
        names = ("digest", "required", "candidates", "amounts", "total", "model", "bounds", "result")
        return {"analysis": "repair"} | kept(self, *names)

    def __str__(self) -> str:
        return self._line(
            f"least reinforcement {self.total:.6g} N: load factor {self.bounds.lower:.6g} associated, "
            f"{self.result.load_factor:.6g} without dilatancy",
            *self.remarks,
        )


def least_ties(model: Model, candidates: Sequence[Element], load_factor: float) -> Repair:
    """Return the least sum of tie forces with which the structure reaches a load factor.

    Parameters
    ----------
    model : Model
        The structure without the ties. Of a design model the forces are design values: a tie is made for
        gamma_S times as much.
    candidates : sequence of Element
        Of :func:`~limitblocks.practice.tie`, without prestress; their strengths are the most each may get.
    load_factor : float
        Required of the live load, > 0.

    Returns
    -------
    Repair
        The forces for which ties must be made. The program is the static theorem, Eqs (56)-(57), with the
        load factor given and the sum of the tie forces as the objective; bounds of the tied structure
        prove it.

    Raises
    ------
    ModelError
        If there is no candidate, one has a prestress, or the ties cannot reach the load factor.
    """
    required = number(load_factor, "load factor", "", above=0.0)
    candidates = sequence_of("candidates", candidates, Element)
    if not candidates:
        raise ModelError("least_ties needs at least one tie to choose from")
    for one in candidates:
        if not isinstance(one.interface.joint, Tie) or isinstance(one.interface.joint, Backfill):
            raise ModelError(f"candidate {one.interface.name} is no tie or strip")
        if one.prestress:
            raise ModelError(
                f"candidate {one.interface.name} has a prestress of {one.prestress:.4g} N, expected none"
            )
    tied = with_elements(model, *candidates)
    problem = tied.problem
    known, owner = len(model.interfaces), problem.stress_interface  # in the order of the joints
    ties = owner >= known
    weights = np.where(ties, problem.stress_units, 0.0)
    try:
        forces = least_stresses(problem, required * problem.units.live, weights)
    except ModelError as error:
        raise ModelError(f"{error}; with their whole strengths it has {bounds(tied).upper:.6g}") from None
    amounts = _needed(np.bincount(owner, forces * weights).astype(np.float64)[known:], problem)
    kept = [_of_force(one, float(k)) for one, k in zip(candidates, amounts, strict=True) if k]
    kinds = tuple(
        f"{one.interface.name} at {coordinates(one.interface.centroid.tolist())} m" for one in candidates
    )
    return _repair(amounts, with_elements(model, *kept), required, kinds, model.digest)


def least_masses(model: Model, places: Sequence[tuple[str, Sequence[float]]], load_factor: float) -> Repair:
    """Return the least sum of added weights with which the structure reaches a load factor.

    Parameters
    ----------
    model : Model
        Its live load is mass-proportional: what is added is pushed, too. In the dead loads it counts as the
        weights of the blocks do, such as .9 of it where they have .9 times those.
    places : sequence of (str, sequence of float)
        Block and point (m, global axes) of each mass that may be added.
    load_factor : float
        Required of the live load, > 0.

    Raises
    ------
    ModelError
        If there is no place, one is far off its block, the live load is not mass-proportional, or no masses
        reach the load factor.
    """
    checked_model(model)
    required = number(load_factor, "load factor", "", above=0.0)
    pushes = [(factor, term) for factor, term in model.live.terms if isinstance(term, MassProportional)]
    if len(pushes) != 1 or pushes[0][0] != 1.0:
        given = f"it has {' and '.join(f'{factor:g} times it' for factor, _ in pushes) or 'none'}"
        raise ModelError(f"least_masses needs a live load with one mass-proportional term, once; {given}")
    if not (known := _places(places)):
        raise ModelError("least_masses needs at least one place")
    _refuse_away(model, known)
    direction = pushes[0][1].direction
    problem, free = model.problem, model.free_blocks
    ones = [added_mass(block, at, weight=1.0) for block, at in known]
    columns = [
        (_weighing(model, one) + required * of(replace(one, direction=direction))).on(free).ravel()
        / problem.units.loads
        for one in ones
    ]
    found = least_loads(problem, required * problem.units.live, np.stack(columns, axis=1))
    amounts = _needed(found, problem)
    made = amounts * (1.0 + AMPLE)
    heaps = [replace(one, weight=float(a)) for one, a in zip(ones, made, strict=True) if a > 0.0]
    added = replace(
        model,
        dead=sum((_weighing(model, heap) for heap in heaps), model.dead),
        live=model.live + of(*(replace(heap, direction=direction) for heap in heaps)),
    )
    kinds = tuple(f"weight on {block} at {coordinates(at)} m" for block, at in known)
    return _repair(amounts, added, required, kinds, model.digest)


def _weighing(model: Model, mass: AddedMass) -> Load:
    """The dead load of a mass, as of the weights of the blocks; its weight where these are given by hand."""
    weights = [(factor, term) for factor, term in model.dead.terms if isinstance(term, MassProportional)]
    own = (factor * of(replace(mass, direction=term.direction)) for factor, term in weights)
    return sum(own, Load()) if weights else of(mass)


def _places(given: Any) -> list[tuple[str, Vector]]:
    """The block and the point of each place; ModelError names what is given instead."""
    try:
        return [(str(block), vector(at, f"place on block {block!r}: at")) for block, at in given]
    except (TypeError, ValueError):
        said = "expected a block and a point each, such as [('wall', (0.5, 0.0, 5.0))]"
        raise ModelError(f"places are {as_typed(given)}, {said}") from None


def _refuse_away(model: Model, places: list[tuple[str, Vector]]) -> None:
    """ModelError for a place farther off its block than the block is long: what rests on it is nearer."""
    blocks = {block.name: block for block in model.blocks}
    for name, at in places:
        if name in blocks and (away := distance(blocks[name], np.array(at))) > blocks[name].size:
            raise ModelError(
                f"place {coordinates(at)} is {away:.3g} m off block {name!r}, expected in or on it"
            )


def _needed(amounts: Array, problem: LimitProblem) -> Array:
    """Amounts, N, without what is rounding."""
    rounding = ROUNDED * float(problem.units.block_force.mean())
    return np.where(amounts > max(NONE * amounts.max(), rounding), amounts, 0.0)


def _of_force(element: Element, force: float) -> Element:
    """The tie with a strength for this force."""
    own, joint = element.interface, element.interface.joint
    assert isinstance(joint, Tie)  # checked above
    strength = force * (1.0 + AMPLE) / float(areas(own.polygon))
    return Element(replace(own, joint=replace(joint, strength=strength)))


def _repair(amounts: Array, model: Model, required: float, kinds: tuple[str, ...], digest: str) -> Repair:
    pair = bounds(model)
    if not pair.lower >= required * (1.0 - 10.0 * AMPLE):
        raise SolverFailure(
            f"the reinforcement found reaches {pair.lower:.6g} only, required was {required:.6g}"
        )
    total = float(amounts.sum())
    return Repair(read_only(amounts), total, model, pair, nonassociated(model), kinds, required, digest)
