"""The worst position of a vehicle that moves along the deck of a bridge."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from limitblocks.analysis.bounds import bounds
from limitblocks.arrays import Array, read_only
from limitblocks.errors import ModelError, UnlimitedLoad, refuse_kind
from limitblocks.evidence.associated import Bounds
from limitblocks.joints.base import checked_count
from limitblocks.mechanics.loads.load import place
from limitblocks.model import Model
from limitblocks.practice.envelope import Found, line_of, search
from limitblocks.practice.partial_factors import live_factor
from limitblocks.practice.vehicles import Deck, Vehicle, axles
from limitblocks.shown import Result, coordinate, kept, many

STOPPED = "interrupted: a position that was not tried may be worse"


@dataclass(frozen=True, eq=False, repr=False)
class WorstPosition(Result):
    """Envelope of the load factor over the positions of a vehicle.

    Attributes
    ----------
    positions, load_factors : Array, shape (p,)
        X of the first axle, m, and the static load factor there, in the order tried; infinite where the
        load is unlimited.
    position : float
        Worst of them.
    bounds : Bounds
        There.
    model : Model
        There.
    vehicle : Vehicle
        Its axles times gamma_Q, where a design model was given.
    deck : Deck
    digest : str
        SHA-256 of the model that was given.
    complete : bool
        False where the user interrupted it: a position that was not tried may be worse.
    """

    positions: Array
    load_factors: Array
    position: float
    bounds: Bounds
    model: Model
    vehicle: Vehicle
    deck: Deck
    digest: str
    complete: bool = True

    def __post_init__(self) -> None:
        if len(self.positions) != len(self.load_factors):
            given = many(len(self.load_factors), "load factor")
            raise ModelError(f"{given} of {many(len(self.positions), 'position')}")

    def rows(self) -> list[dict[str, Any]]:
        """Return a row for each position, in their order along the deck."""
        pairs = sorted(zip(self.positions.tolist(), self.load_factors.tolist(), strict=True))
        return [{"position": place, "load_factor": factor} for place, factor in pairs]

    def to_dict(self) -> dict[str, Any]:
        """Return the envelope and the bounds at the worst position as numbers and text."""
        names = ("positions", "load_factors", "position", "bounds", "model", "vehicle", "deck", "complete")
        return {"analysis": "worst position"} | kept(self, "digest", *names)

    def __str__(self) -> str:
        acting = -float(self.model.live.on(self.model.free_blocks)[:, 2].sum())
        total = sum(self.vehicle.axles)
        gamma_Q = live_factor(self.model)
        of = f" of the axles times gamma_Q {gamma_Q:g}" * (gamma_Q != 1.0)
        beyond = f"; {acting / 1e3:.4g} of {total / 1e3:.4g} kN of axles stand on the blocks"
        beyond = beyond * (acting < total * (1.0 - 1e-6))
        return self._line(
            f"worst position x = {coordinate(self.position)} m of {len(self.positions)} tried: associated "
            f"load factor {self.bounds.lower:.6g}{of}{beyond}",
            *self.bounds.remarks,
            *(() if self.complete else (STOPPED,)),
        )


def worst_position(
    model: Model,
    vehicle: Vehicle,
    deck: Deck,
    between: tuple[float, float] | None = None,
    *,
    positions: int = 25,
    progress: Callable[[float, float], None] | None = None,
) -> WorstPosition:
    """Return the position of a vehicle at which the load factor is least, and the envelope on the way.

    Evenly spaced positions first. A mechanism found at one position is a bound on the load factor at all
    others. Between two positions one that was not met may carry less still: a part of the way is halved, that
    which may have the worst first, as long as the mechanisms found carry less there, or would if they fell as
    much as halving what it is a part of brought. Then places where an axle begins or ends at an edge, as long
    as they carry less than 5 % more there. At last the place where they carry least. Less by a
    thousandth is not looked for. That no position is worse is not proven, and where the load is unlimited at
    two neighbours nothing is looked for between them. After Ctrl-C: the worst of those tried.

    Parameters
    ----------
    model : Model
        Structure, its live load is replaced; in a design model, by the vehicle times gamma_Q.
    vehicle : Vehicle
        Moves from ``between[0]`` to ``between[1]``, X of its first axle, m.
    deck : Deck
        Where it runs.
    between : (float, float), optional
        m; unless given, wherever some axle stands on the free blocks.
    positions : int
        Evenly spaced positions to begin with, at least 3.
    progress : callable, optional
        Called with each position and its load factor.

    Raises
    ------
    ModelError
        If the interval is empty, or the vehicle brings the structure down nowhere.
    """
    refuse_kind(vehicle, Vehicle, "vehicle")
    refuse_kind(deck, Deck, "deck")
    checked_count("positions", positions, 3)
    deck = deck.on(model)
    vehicle = replace(vehicle, axles=tuple(live_factor(model) * load for load in vehicle.axles))
    low, high = _ends(model, vehicle, between, positions)
    tried: Found = {}

    def at(x: float) -> tuple[Bounds, Model] | None:
        tried[x] = found = _loaded(model, vehicle, deck, x)
        if progress:
            progress(x, float(found[0].lower) if found else np.inf)
        return found

    complete = True
    try:
        search(line_of(model, vehicle, deck), at, tried, (low, high), positions)
    except KeyboardInterrupt:
        if not any(tried.values()):
            raise
        complete = False
    if not any(tried.values()):
        where = f"with the first axle between {coordinate(low)} and {coordinate(high)} m"
        raise ModelError(
            f"{where} the vehicle stands off the structure, or any multiple of it only jams the blocks; "
            "check its place and the level of the road"
        )
    order = read_only(np.array(list(tried)))
    values = read_only(np.array([own[0].lower if own else np.inf for own in tried.values()]))
    worst = float(order[values.argmin()])
    found = tried[worst]
    assert found  # one is finite
    return WorstPosition(order, values, worst, *found, vehicle, deck, model.digest, complete)


def _ends(
    model: Model, vehicle: Vehicle, between: tuple[float, float] | None, positions: int
) -> tuple[float, float]:
    """First and last place of the first axle, as given or over the whole structure."""
    low, high = _whole(model, vehicle) if between is None else place(between, "between, X of the first axle,")
    if not low < high:
        raise ModelError(
            f"between {low:g} and {high:g} m in {positions} positions there is nothing to search"
        )
    return low, high


def _whole(model: Model, vehicle: Vehicle) -> tuple[float, float]:
    """Places of the first axle between which some axle stands on the structure."""
    x = np.concatenate([block.vertices[:, 0] for block in model.free_blocks])
    return float(x.min()) - max(vehicle.distances), float(x.max()) - min(vehicle.distances)


def _loaded(model: Model, vehicle: Vehicle, deck: Deck, x: float) -> tuple[Bounds, Model] | None:
    """Bounds with the vehicle there; None where it puts nothing on the structure, or any multiple stands."""
    live = axles(model, vehicle, deck, x)
    if not live.terms:
        return None
    loaded = replace(model, live=live)
    try:
        return bounds(loaded), loaded
    except UnlimitedLoad:
        return None
