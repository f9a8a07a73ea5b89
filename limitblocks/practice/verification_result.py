"""A verification: its quantities in order, and the inequalities between them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from limitblocks.shown import Result

UNSEEN = (
    "Nothing is claimed beyond the inequalities named. The text of Circolare 7/2019 was not seen when this "
    "was written: its quantities follow worked examples, and numbers of single equations are not given."
)


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
    """

    symbol: str
    meaning: str
    formula: str
    value: float
    unit: str
    source: str


@dataclass(frozen=True)
class Inequality:
    """A check: capacity over demand, satisfied where it is at least one."""

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
    moving : tuple of str
        Blocks of the mechanism.
    digest : str
        SHA-256 of the model.
    """

    quantities: tuple[Quantity, ...]
    checks: tuple[Inequality, ...]
    moving: tuple[str, ...]
    digest: str

    def __getitem__(self, symbol: str) -> float:
        """Value of the quantity with a symbol; KeyError where there is none."""
        for quantity in self.quantities:
            if quantity.symbol == symbol:
                return quantity.value
        raise KeyError(symbol)

    def rows(self) -> list[dict[str, Any]]:
        """Return a row for each quantity."""
        keys = ("symbol", "meaning", "formula", "value", "unit", "source")
        return [{key: getattr(one, key) for key in keys} for one in self.quantities]

    def to_dict(self) -> dict[str, Any]:
        """Return all quantities and checks as numbers and text."""
        return {
            "analysis": "verification",
            "quantities": self.rows(),
            "checks": [
                {"name": one.name, "capacity": one.capacity, "demand": one.demand, "ratio": one.ratio,
                 "unit": one.unit, "satisfied": one.satisfied, "source": one.source}
                for one in self.checks
            ],
            "moving": list(self.moving),
            "model_digest": self.digest,
        }  # fmt: skip

    def __str__(self) -> str:
        checks = (
            f"{one.name}: {one.ratio:.3f} {'satisfied' if one.satisfied else 'not satisfied'}"
            for one in self.checks
        )
        return "; ".join((f"a0* = {self['a0*']:.4g} m/s2", *checks)) + self._as_read
