"""Supports that move along a direction: the least reaction they must give, and the mechanism that follows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from limitblocks.analysis.bounds import bounds
from limitblocks.analysis.nonassociated.loop import nonassociated
from limitblocks.arrays import Array
from limitblocks.errors import NotConverged, UnlimitedLoad
from limitblocks.evidence.associated import Bounds
from limitblocks.evidence.results import Nonassociated
from limitblocks.model import Model
from limitblocks.practice.settling import Settling, settling
from limitblocks.shown import Result, kept

JAMMED = (
    "settlement of {}: with dilatancy its reaction has no limit: the structure jams against this motion "
    "or stones between what settles and another support press against both, however hard; check the "
    "direction, that in which the ground moves, such as 0,0,-1 for one that sinks, and what else holds "
    "those stones"
)
BOUNDED = (
    "the load here is the pull of what settles; with dilatancy its least reaction is {:.6g} to {:.6g} N, and "
    "without_dilatancy=False, on the command line --associated, gives that alone"
)
OFF = 1e-6  # of the motion along the line: more than rounding


@dataclass(frozen=True, eq=False, repr=False)
class Settlement(Result):
    """Least reaction of supports that settle: the ground gives way until the structure follows it.

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
        SHA-256 of the model that was given, whose supports do not move yet.
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
            f"of the load factor of the settling, higher where the reaction is smaller: {one}" for one in said
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
        least = f"least reaction of {self.settling.named}: {self.lower:.6g} to {self.upper:.6g} N"
        real = "" if self.nonassociated is None else f", {self.nonassociated:.6g} N without dilatancy"
        return self._line(f"{least} (associated){real}", *self.remarks)


def settlement(
    model: Model, support: str | Sequence[str], direction: Sequence[float], *, without_dilatancy: bool = True
) -> Settlement:
    """Return the least reaction of a support that moves along `direction`, under the dead loads.

    The ground moves away without turning; the structure needs less and less of its reaction until, at the
    least one, it follows as a mechanism. Its cracks are the joints that move. With the direction reversed the
    support is pushed into the structure: the reaction found is minus the greatest one. Several supports, such
    as the stones that a pier stands on, move as one body; the reaction is that of all of them together.

    Parameters
    ----------
    model : Model
        Its live load is not used.
    support : str or sequence of str
        Name of the support that moves, or names of those that do.
    direction : sequence of float
        Of the motion, such as (0, 0, -1); any length.
    without_dilatancy : bool
        Whether the reaction without dilatancy is found as well.

    Returns
    -------
    Settlement
        Reactions are components against the direction, N, with the pressure of water in the joints of the
        supports that move; their own weight is left out.

    Raises
    ------
    ModelError
        If `support` is not a support, or none stays.
    NoEquilibrium
        If the dead loads cannot stand.
    UnlimitedLoad
        If the reaction can change without limit: blocks jam against the motion, or are propped between this
        support and another.
    SolverFailure, NotConverged
        As :func:`~limitblocks.bounds` and :func:`~limitblocks.nonassociated`.

    Notes
    -----
    The support is a free block that a guide holds, and rigid guides join others to it; the load factor of its
    live load along the direction is greatest where its reaction is least. Static theorem: Eqs (56)-(57) with
    the reaction as the unknown load.
    """
    own = settling(model, support, direction)
    try:
        pair = bounds(own.model)
    except UnlimitedLoad as error:
        raise UnlimitedLoad(JAMMED.format(own.named)) from error
    _refuse_off_its_line(own, pair.displacement_rates)
    lower, upper = own.reaction(pair.upper), own.reaction(pair.lower)
    try:
        result = nonassociated(own.model) if without_dilatancy else None
    except NotConverged as error:
        error.add_note(BOUNDED.format(lower, upper))
        raise
    if result:
        _refuse_off_its_line(own, result.displacement_rates)
    return Settlement(
        settling=own,
        lower=lower,
        upper=upper,
        nonassociated=own.reaction(result.load_factor) if result else None,
        bounds=pair,
        result=result,
        digest=model.digest,
    )


def _refuse_off_its_line(own: Settling, rates: Array) -> None:
    """UnlimitedLoad if a guide yields: its strength, not of the structure, limits what nothing else does."""
    places = {block.name: k for k, block in enumerate(own.model.blocks)}
    along = float(rates[places[own.supports[0]], :3] @ own.direction)
    off = rates[[places[name] for name in own.supports]] - np.append(along * own.direction, np.zeros(3))
    off[:, 3:] *= np.array([own.model.blocks[places[name]].size for name in own.supports])[:, None]
    if np.abs(off).max() > OFF * abs(along):
        raise UnlimitedLoad(JAMMED.format(own.named))
