"""A verification: its quantities in order, and the inequalities between them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

from limitblocks.errors import ModelError
from limitblocks.practice.moving_masses import MovingMass
from limitblocks.shown import Result, compared, kept

CLAIMED = (
    "The push is along the live load alone: along other directions, also between two that were verified, "
    "other mechanisms may be set off by less (limitblocks.studies.directions). "
    "Nothing is claimed beyond the inequalities named. Equations [C8.7.1.1] to [C8.7.1.12], [C7.2.5] to "
    "[C7.2.10] and [3.2.10] were checked against a transcription of the official text, not against the "
    "Gazzetta itself; M* is not in the text of 2019. Not looked at: the second criteria of C8.7.1.2.1.6 "
    "(ties or other links that break, beams that slip off) and C8.7.1.2.1.9 (time histories)."
)


#: Steps of a verification: the mechanism, the earthquake, the checks.
STEPS = ("activation", "demand", "linear", "SLV", "SLC")


@dataclass(frozen=True)
class Quantity:
    """A number of the verification, with how it comes about.

    Attributes
    ----------
    symbol, meaning, formula : str
        As an engineer reads them.
    value : float
    unit : str
        SI; "" of a pure number.
    source : str
        Section that names it.
    step : str
        "activation", "demand", "linear", "SLV" or "SLC".
    """

    symbol: str
    meaning: str
    formula: str
    value: float
    unit: str
    source: str
    step: str = ""


def steps(step: str, found: Iterable[Quantity]) -> list[Quantity]:
    """Return quantities as those of a step."""
    return [replace(one, step=step) for one in found]


@dataclass(frozen=True)
class Inequality:
    """A check by `name`: `capacity` over `demand`, both in `unit`, by the clause `source`; at least one."""

    name: str
    capacity: float
    demand: float
    unit: str
    source: str

    @property
    def ratio(self) -> float:
        """Capacity over demand."""
        return self.capacity / self.demand

    @property
    def satisfied(self) -> bool:
        """Whether the ratio is at least one."""
        return self.ratio >= 1.0


@dataclass(frozen=True, eq=False, repr=False)
class Verification(Result):
    """Quantities in the order in which they are found, and the inequalities between them.

    Attributes
    ----------
    quantities : tuple of Quantity
    checks : tuple of Inequality
    masses : tuple of MovingMass
        Weights of the mechanism with their virtual displacements.
    remarks : tuple of str
        What the text asks and the input does not follow.
    left_out : str
        Why non-linear checks, though asked for, were not made: no curve, no zero, or one mechanism of many.
    digest : str
        SHA-256 of the model.
    """

    quantities: tuple[Quantity, ...]
    checks: tuple[Inequality, ...]
    masses: tuple[MovingMass, ...]
    digest: str
    remarks: tuple[str, ...] = ()
    left_out: str = ""

    def __post_init__(self) -> None:
        if all(one.symbol != "a0*" for one in self.quantities):
            raise ModelError("a verification without a0*")

    @property
    def moving(self) -> tuple[str, ...]:
        """Blocks of the mechanism."""
        return tuple(dict.fromkeys(one.block for one in self.masses))

    def __getitem__(self, symbol: str) -> float:
        """Value of the quantity with a symbol; KeyError where there is none."""
        for quantity in self.quantities:
            if quantity.symbol == symbol:
                return quantity.value
        raise KeyError(symbol)

    def rows(self) -> list[dict[str, Any]]:
        """Return a row for each quantity."""
        keys = ("symbol", "meaning", "formula", "value", "unit", "source", "step")
        return [{key: getattr(one, key) for key in keys} for one in self.quantities]

    def to_dict(self) -> dict[str, Any]:
        """Return all quantities and checks as numbers and text."""
        return {
            "analysis": "verification",
            "quantities": self.rows(),
            "checks": [
                kept(one, "name", "capacity", "demand", "ratio", "unit", "satisfied", "source")
                for one in self.checks
            ],
            **kept(self, "moving", "masses", "left_out", "remarks", "digest"),
        }

    def __str__(self) -> str:
        checks = (
            f"{one.name}: {compared(one.ratio, '.3f')} {'satisfied' if one.satisfied else 'not satisfied'}"
            for one in self.checks
        )
        said = (f"a0* = {self['a0*']:.4g} m/s2", *checks, *(self.left_out,) * bool(self.left_out))
        return self._line(*said)


#: Why there are no non-linear checks where the proportions in which parts move are arbitrary.
MANY = (
    "no non-linear check: the mechanism is, or may be, one of many with this alpha0, and d0* would be that "
    "of an arbitrary mix of them; verify each part that moves in a model of its own"
)

#: Why there is no check at SLC where its spectrum is given by itself.
NO_CURVE = "no non-linear check at SLC: it needs a capacity curve"


def without_curve(found: Verification, ended: str) -> Verification:
    """Return a verification whose non-linear checks are left out, for a capacity curve that `ended` early."""
    said = f"no non-linear check: the capacity curve does not end at zero: {ended}"
    return replace(found, left_out=said)
