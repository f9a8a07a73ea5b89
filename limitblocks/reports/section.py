"""What a report shows of a result: a few fields that every kind of result fills."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from limitblocks.arrays import Array
from limitblocks.reports.curve import Curve
from limitblocks.reports.document import Table


class Check(NamedTuple):
    """A recomputed residual and whether it is within the tolerance."""

    name: str
    value: float
    meaning: str
    passed: bool


@dataclass(frozen=True, eq=False)
class Section:
    """A result as a report shows it.

    Attributes
    ----------
    title, meaning : str
        Kind of result, and what it says, in a sentence.
    headline, quantity : str
        What counts, large, and what it is; mostly the load factor.
    values : tuple of (str, str, str)
        Quantity, value, and where it comes from.
    checks : tuple of Check
        Residuals.
    tolerance : float
        Largest residual accepted.
    rates : Array, shape (n, 6), optional
        Displacement rates of the mechanism to draw.
    warnings : tuple of str
        What is no error but may not be meant.
    steps : Table, optional
        One row a step.
    curve : Curve, optional
        A plot to draw.
    """

    title: str
    meaning: str
    headline: str
    values: tuple[tuple[str, str, str], ...]
    checks: tuple[Check, ...]
    tolerance: float
    rates: Array | None = None
    warnings: tuple[str, ...] = ()
    quantity: str = "load factor α"
    steps: Table | None = None
    curve: Curve | None = None
