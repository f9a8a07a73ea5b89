"""A support that moves along a direction: the least reaction it must give, and the mechanism that follows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from limitblocks.analysis.bounds import bounds
from limitblocks.analysis.nonassociated.loop import nonassociated
from limitblocks.arrays import Array, read_only
from limitblocks.errors import ModelError, UnlimitedLoad
from limitblocks.evidence.associated import Bounds
from limitblocks.evidence.results import Nonassociated
from limitblocks.geometry import Interface
from limitblocks.geometry.polygon import axes_of
from limitblocks.joints import Guide
from limitblocks.mechanics import Load
from limitblocks.mechanics.loads import JointPressure, force
from limitblocks.mechanics.loads.load import unit_vector
from limitblocks.model import Model, checked_model
from limitblocks.practice.backfill import fill_at_rest
from limitblocks.practice.elements import CORNERS, Element
from limitblocks.practice.freed import as_before, other_supports, pressed
from limitblocks.shown import Result, kept

JAMMED = (
    "settlement of {!r}: with dilatancy its reaction has no limit: the structure jams against this motion "
    "or stones between this support and another press against both, however hard; check the direction, "
    "that in which the ground moves, such as 0,0,-1 for one that sinks, and what else holds those stones"
)
OFF = 1e-6  # of the motion along the line: more than rounding
RIGID = 1e3  # strength of the guide over the weight of the structure


@dataclass(frozen=True, eq=False)
class Settling:
    """A model whose support is a block that can move along one direction, pulled away by the live load.

    Attributes
    ----------
    model : Model
        The structure: dead loads with the reaction `held` on the support, live load `unit` along the
        direction.
    support : str
        Name of the support.
    direction : Array, shape (3,)
        Unit vector of its motion.
    held : float
        Reaction against the direction that an admissible state of the permanent loads needs, N.
    unit : float
        Live load at load factor one, N.
    """

    model: Model
    support: str
    direction: Array
    held: float
    unit: float

    def reaction(self, load_factor: float) -> float:
        """Return the reaction against the direction, N, at a `load_factor` of the settling model."""
        return self.held - load_factor * self.unit

    def to_dict(self) -> dict[str, Any]:
        """Return the model and its motion as numbers and text."""
        return kept(self, "support", "direction", "held", "unit", "model")


@dataclass(frozen=True, eq=False, repr=False)
class Settlement(Result):
    """Least reaction of a support that settles: the ground gives way until the structure follows it.

    Attributes
    ----------
    settling : Settling
        The model that was analysed.
    lower, upper : float
        ``lower <= least reaction <= upper`` for associated flow, N: of a mechanism that follows the support
        and of a stress state. No stress state within the yield surface has a smaller reaction.
    nonassociated : float or None
        Reaction at which the structure follows without dilatancy, from the permanent loads, N; None where it
        was not asked for.
    bounds : Bounds
        Evidence of the first two; a result of ``settling.model``.
    result : Nonassociated or None
        Evidence of the third; its mechanism is the crack pattern.
    digest : str
        SHA-256 of the model that was given, whose support does not move yet.
    """

    settling: Settling
    lower: float
    upper: float
    nonassociated: float | None
    bounds: Bounds
    result: Nonassociated | None
    digest: str

    @property
    def remarks(self) -> tuple[str, ...]:
        """What to know of the answers that the reactions are of."""
        said = dict.fromkeys(self.bounds.remarks + (self.result.remarks if self.result else ()))
        return tuple(
            f"of settling.model, whose load factor is higher where the reaction is smaller: {one}"
            for one in said
        )

    def rows(self) -> list[dict[str, Any]]:
        """Return a row for each reaction."""
        found = {"associated, mechanism": self.lower, "associated, stress state": self.upper}
        found |= {} if self.nonassociated is None else {"without dilatancy": self.nonassociated}
        return [{"answer": name, "least_reaction": value} for name, value in found.items()]

    def to_dict(self) -> dict[str, Any]:
        """Return the reactions and both results as numbers and text."""
        names = ("settling", "lower", "upper", "nonassociated", "bounds", "result", "digest")
        return {"analysis": "settlement"} | kept(self, *names)

    def __str__(self) -> str:
        least = f"least reaction of {self.settling.support!r}: {self.lower:.6g} to {self.upper:.6g} N"
        real = "" if self.nonassociated is None else f", {self.nonassociated:.6g} N without dilatancy"
        return self._line(f"{least} (associated){real}", *self.remarks)


def settlement(
    model: Model, support: str, direction: Sequence[float], *, without_dilatancy: bool = True
) -> Settlement:
    """Return the least reaction of a support that moves along `direction`, under the dead loads.

    The ground moves away without turning; the structure needs less and less of its reaction until, at the
    least one, it follows as a mechanism. Its cracks are the joints that move. With the direction reversed the
    support is pushed into the structure: the reaction found is minus the greatest one.

    Parameters
    ----------
    model : Model
        Its live load is not used.
    support : str
        Name of the support that moves.
    direction : sequence of float
        Of its motion, such as (0, 0, -1); any length.
    without_dilatancy : bool
        Whether the reaction without dilatancy is found as well.

    Returns
    -------
    Settlement
        Reactions are components against the direction, N, with the pressure of water in the joints of the
        support; the weight of the support itself is left out.

    Raises
    ------
    ModelError
        If `support` is not a support, or the only one.
    NoEquilibrium
        If the dead loads cannot stand.
    UnlimitedLoad
        If the reaction can change without limit: blocks jam against the motion, or are propped between this
        support and another.
    SolverFailure, NotConverged
        As :func:`~limitblocks.bounds` and :func:`~limitblocks.nonassociated`.

    Notes
    -----
    The support is a free block that a guide holds; the load factor of its live load along the direction is
    greatest where its reaction is least. Static theorem: Eqs (56)-(57) with the reaction as the unknown load.
    """
    own = settling(model, support, direction)
    try:
        pair = bounds(own.model)
    except UnlimitedLoad as error:
        raise UnlimitedLoad(JAMMED.format(support)) from error
    result = nonassociated(own.model) if without_dilatancy else None
    if any(_leaves_its_line(own, answer.displacement_rates) for answer in (pair, result) if answer):
        raise UnlimitedLoad(JAMMED.format(support))
    return Settlement(
        settling=own,
        lower=own.reaction(pair.upper),
        upper=own.reaction(pair.lower),
        nonassociated=own.reaction(result.load_factor) if result else None,
        bounds=pair,
        result=result,
        digest=model.digest,
    )


def _leaves_its_line(own: Settling, rates: Array) -> bool:
    """True if the guide yields: its strength, not of the structure, limits what nothing else does."""
    names = [block.name for block in own.model.blocks]
    k = names.index(own.support)
    along = float(rates[k, :3] @ own.direction)
    off = np.append(rates[k, :3] - along * own.direction, own.model.blocks[k].size * rates[k, 3:])
    return bool(np.abs(off).max() > OFF * abs(along))


def settling(model: Model, support: str, direction: Sequence[float]) -> Settling:
    """Return the model in which `support` can move along `direction` only; see :func:`settlement`.

    Raises
    ------
    ModelError
        If `support` is none or the only one, the direction is zero, or there are no dead loads.
    """
    checked_model(model)
    d = np.array(unit_vector(direction, f"settlement of {support!r}: direction"))
    others = other_supports(model, support)
    block = next(block for block in model.blocks if block.name == support)
    model = fill_at_rest(model, support)
    weight = float(np.linalg.norm(model.dead.on(model.free_blocks)[:, :3], axis=1).sum())
    if not weight > 0.0:
        raise ModelError("settlement: the dead loads are zero; there is no reaction to lose")
    pulled = sum((Element(own).loads({support}) for own in model.interfaces), Load())
    water = Load(tuple(one for one in model.dead.terms if isinstance(one[1], JointPressure)))
    at = (pulled + water).on([block])[0, :3]
    held = float((pressed(model, support) + at) @ d)
    guide = Interface(
        others[0],
        support,
        block.centroid,
        read_only(axes_of(d)[[2, 0, 1]]),  # s1 along the motion
        read_only(block.size * CORNERS),
        Guide(RIGID * weight / block.size**2),
    )
    weightless = replace(block, unit_weight=0.0)
    reaction = force(support, (-held * d).tolist(), block.centroid.tolist())
    freed = replace(
        model,
        blocks=tuple(weightless if one is block else one for one in model.blocks),
        supports=tuple(others),
        interfaces=(*model.interfaces, guide),
        dead=model.dead + pulled + reaction,
        live=force(support, (weight * d).tolist(), block.centroid.tolist()),
    )
    on_support = (pulled + water + reaction).on([block])[0]
    return Settling(as_before(model, freed, support, on_support), support, read_only(d), held, weight)
