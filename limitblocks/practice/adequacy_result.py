"""Result of a load factor with partial factors."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, isfinite
from typing import Any

from limitblocks.evidence.associated import Bounds
from limitblocks.evidence.results import Nonassociated
from limitblocks.model import Model
from limitblocks.practice.partial_factors import PartialFactors
from limitblocks.shown import Result, compared, kept


@dataclass(frozen=True)
class DesignValue:
    """A characteristic value, the partial factor, and the design value; `unit` in SI, "" of a number.

    `where` says what it is of; `symbol` and `factor` are the names of the value and of its factor.
    """

    symbol: str
    where: str
    characteristic: float
    factor: str
    design: float
    unit: str


@dataclass(frozen=True, eq=False, repr=False)
class Adequacy(Result):
    """The load factor with partial factors, beside the characteristic one of the same flow rule.

    Attributes
    ----------
    factors : PartialFactors
    values : tuple of DesignValue
        Everything that was factored.
    characteristic : Bounds or None
        Associated load factor of the model as given; None where it is without limit.
    model : Model
        The design model: its loads and joints have their design values.
    bounds : Bounds or None
        Of the design model, associated; None where it is without limit.
    result : Nonassociated or None
        Of the design model, without dilatancy; None where it was not asked for.
    characteristic_result : Nonassociated or None
        Of the model as given, without dilatancy; None where it was not asked for or there is no answer.
    digest : str
        SHA-256 of the model that was given.
    """

    factors: PartialFactors
    values: tuple[DesignValue, ...]
    characteristic: Bounds | None
    model: Model
    bounds: Bounds | None
    result: Nonassociated | None
    characteristic_result: Nonassociated | None
    digest: str

    @property
    def factor(self) -> float:
        """Adequacy factor, on the design live loads: without dilatancy where that was asked for."""
        return _factor(self.result, self.bounds)

    @property
    def characteristic_factor(self) -> float:
        """Load factor of the model as given: without dilatancy where that has an answer; may be infinite."""
        return _factor(self.characteristic_result, self.characteristic)

    @property
    def satisfied(self) -> bool:
        """Whether it is at least one: E_d <= R_d, EN 1990 Eq. (6.8), for the loads and factors given."""
        return self.factor >= 1.0

    @property
    def remarks(self) -> tuple[str, ...]:
        """What to ask of the factors, and to know of the answer that the adequacy factor is of."""
        strengths = self.values[2:]  # after both loads
        raised = dict.fromkeys(one.factor for one in strengths if one.design > one.characteristic)
        factors = {name: self.factors.value(name) for name in raised}
        asked = (f"{name} is {k:g}, and raises what it divides: {1 / k:.3g}?" for name, k in factors.items())
        return *asked, *self.answer.remarks

    @property
    def answer(self) -> Nonassociated | Bounds:
        """The result that the factor is of."""
        found = self.result or self.bounds
        assert found is not None  # one of them is made
        return found

    def rows(self) -> list[dict[str, Any]]:
        """Return a row for each value that was factored."""
        return [dict(vars(value)) for value in self.values]

    def to_dict(self) -> dict[str, Any]:
        """Return factors, values and results as numbers and text."""
        return {
            "analysis": "adequacy",
            **kept(self, "digest", "factors", "values"),
            "adequacy_factor": self.factor,
            **kept(self, "satisfied", "model", "characteristic", "bounds", "result"),
            **kept(self, "characteristic_result"),
        }

    def __str__(self) -> str:
        least = "at least one" if self.satisfied else "LESS than one"
        size = self.characteristic_factor
        number = f"{size:.6g}" if isfinite(size) else "without limit"
        given = f"{number}, {_flow(self.characteristic_result)}"
        found = f"adequacy factor {compared(self.factor, '.6g')} ({_flow(self.result)}), {least}"
        return self._line(found, f"characteristic load factor {given}", *self.remarks)


def _factor(result: Nonassociated | None, pair: Bounds | None) -> float:
    if result:
        return float(result.load_factor)
    return float(pair.lower) if pair else inf


def _flow(result: Nonassociated | None) -> str:
    return "without dilatancy" if result else "associated"
