"""What a report shows of a result: a few fields that every kind of result fills."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from limitblocks.arrays import Array
from limitblocks.evidence.residuals import Residuals
from limitblocks.reports.curve import Curve
from limitblocks.reports.document import Part

#: Of drawings of a mechanism.
LEGEND = (("moving", "moving"), ("still", "standing still"), ("support", "support"), ("ghost", "before"))


class Design(NamedTuple):
    """A certified load factor to which loading leads: of what, what to know of it, and its dilatancy."""

    load_factor: float
    source: str
    remarks: tuple[str, ...] = ()
    dilatancy: float = 0.0


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
    judged : (Residuals, float), optional
        Recomputed residuals, and the largest accepted.
    rates : Array, shape (n, 6), optional
        Displacement rates of the mechanism to draw.
    warnings : tuple of str
        What is no error but may not be meant.
    parts : tuple of Part
        What follows: tables, sentences, drawings of this kind of result.
    curve : Curve, optional
        A plot to draw.
    designs : tuple of Design
        The least of a report is the load factor to design with.
    upper : float, optional
        An upper estimate of it.
    own : bool
        Whether its headline is at the head of a report that has no load factor to design with.
    judges : bool
        Whether its headline says something about safety.
    compared : tuple of (str, str, str)
        Name, value and meaning of load factors to be put side by side.
    """

    title: str
    meaning: str
    headline: str
    values: tuple[tuple[str, str, str], ...]
    judged: tuple[Residuals, float] | None = None
    rates: Array | None = None
    warnings: tuple[str, ...] = ()
    quantity: str = "load factor α"
    parts: tuple[Part, ...] = ()
    curve: Curve | None = None
    designs: tuple[Design, ...] = ()
    upper: float | None = None
    own: bool = False
    judges: bool = False
    compared: tuple[tuple[str, str, str], ...] = ()
