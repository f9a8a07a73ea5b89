"""Result of the search for all certified load factors of a structure: the load-path answer and the ranges."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from limitblocks.errors import few
from limitblocks.evidence.range_answer import SHOWN, Origin, RangeAnswer
from limitblocks.problem import Turning
from limitblocks.shown import Result, kept


@dataclass(frozen=True)
class Wedging:
    """Whether a stress state without any load lies within yield: C^T x = 0, F x in K, x not zero.

    Attributes
    ----------
    wedged : bool
        Whether there is one. Then blocks can be wedged at will, and stresses under given loads have no limit;
        without one they have.
    interfaces : tuple of str
        Interfaces that it stresses.
    residual : float
        Its imbalance and violation of yield over its largest stress; of "no" what the program leaves, which
        is no proof.
    """

    wedged: bool
    interfaces: tuple[str, ...]
    residual: float

    def __str__(self) -> str:
        if not self.wedged:
            return "no self-stress within yield: stresses under given loads are limited"
        return f"self-stress within yield at {few(self.interfaces, SHOWN)}: it can be wedged"


@dataclass(frozen=True, eq=False)
class Extreme:
    """The least or the greatest load factor from zero up of all solutions, by a mixed-integer program.

    Attributes
    ----------
    answer : RangeAnswer, optional
        The best solution that the program or the search before it found, certified.
    bound : float
        What no solution within the limits below is beyond, as the program claims; infinite if none is known.
    proven : bool
        Whether both agree within 1e-4 of the bracket; with an infinite bound, whether every load factor above
        the answer is a solution.
    stress_limit : float
        Largest distance to yield admitted, over the sum of the dead loads; infinite where none was needed.
    multiplier_limit : float
        Largest dimensionless multiplier admitted, where the live load does unit work.
    seconds : float
        Wall time.
    """

    answer: RangeAnswer | None
    bound: float
    proven: bool
    stress_limit: float
    multiplier_limit: float
    seconds: float

    @property
    def load_factor(self) -> float:
        """Load factor of the answer, infinite where that of no solution is the greatest; NaN without one."""
        if self.proven and np.isinf(self.bound):
            return self.bound
        return self.answer.load_factor if self.answer else float("nan")

    @property
    def gap(self) -> float:
        """Distance between answer and bound."""
        return 0.0 if self.load_factor == self.bound else abs(self.load_factor - self.bound)

    def to_dict(self) -> dict[str, Any]:
        """Return the extreme as plain numbers, lists and text."""
        return kept(self, "answer", "bound", "gap", "proven", "stress_limit", "multiplier_limit", "seconds")

    def __str__(self) -> str:
        word = "proven" if self.proven else f"bound {self.bound:.6g}"
        found = "without limit" if np.isinf(self.load_factor) else f"{self.load_factor:.6g}"
        return f"{found} ({word})"


@dataclass(frozen=True, eq=False, repr=False)
class LoadFactorRange(Result):
    """Certified load factors of one structure, and how far they reach.

    Three things: the answer of the load path; what load paths reach from admissible states of the permanent
    loads, which is the uncertainty that construction, settlement and creep leave; and the least and the
    greatest of all solutions, which need not be reachable.

    Attributes
    ----------
    load_path : RangeAnswer, optional
        The answer of :func:`limitblocks.nonassociated`; none where it gave none.
    answers : tuple of RangeAnswer
        All distinct ones, each within the tolerance, by load factor.
    intervals : tuple of (float, float)
        Load factors that are all solutions: solutions of one mechanism form a convex set. The last ends at
        infinity where the load factor is unlimited.
    unlimited : bool
        Whether every load factor above an answer is one, too: stresses that balance the live load alone can
        be added to it.
    frictionless, associated : float
        The bracket, as in :class:`limitblocks.results.Nonassociated`.
    wedging : Wedging
        Whether it can be wedged.
    least : Extreme, optional
        By a mixed-integer program, where it was asked for.
    greatest : Extreme, optional
        Likewise.
    paths, mechanisms : (int, int)
        How many were tried, and how many ended at a certified answer.
    complete : bool
        Whether the search ended before the time limit.
    remarks : tuple of str
        What a reader should know.
    dilatancy, turning, tolerance, digest
        As in :class:`limitblocks.results.Nonassociated`.
    """

    load_path: RangeAnswer | None
    answers: tuple[RangeAnswer, ...]
    intervals: tuple[tuple[float, float], ...]
    unlimited: bool
    frictionless: float
    associated: float
    wedging: Wedging
    least: Extreme | None
    greatest: Extreme | None
    paths: tuple[int, int]
    mechanisms: tuple[int, int]
    complete: bool
    remarks: tuple[str, ...]
    dilatancy: float
    turning: Turning
    tolerance: float
    digest: str

    @property
    def reached(self) -> tuple[float, float]:
        """Least and greatest load factor that paths from permanent-load states reached, or NaN."""
        factors = [a.load_factor for a in self.answers if a.origin is not Origin.SEARCHED]
        return (min(factors), max(factors)) if factors else (float("nan"), float("nan"))

    @property
    def certified(self) -> tuple[float, float]:
        """Least and greatest certified load factor; infinite where it is unlimited."""
        values = [a.load_factor for a in self.answers]
        if not values:
            return float("nan"), float("nan")
        return min(values), float("inf") if self.unlimited else max(values)

    def rows(self) -> list[dict[str, Any]]:
        """Return a row for each answer."""
        keys = ("load_factor", "origin", "share", "thrust", "local", "moving")
        return [{key: one[key] for key in keys} for one in (a.to_dict() for a in self.answers)]

    def __contains__(self, load_factor: float) -> bool:
        """Whether a load factor lies within the certified intervals."""
        return any(low <= load_factor <= high for low, high in self.intervals)

    def __str__(self) -> str:
        start = f"{self.load_path.load_factor:.6g}" if self.load_path else "none"
        exact = f"; of all solutions from zero up {self.least} to {self.greatest}" if self.least else ""
        stopped = "" if self.complete else "; stopped early, by the time limit or by hand"
        return self._line(
            f"load factor {start} by the load path; {_span(self.reached)} reached from permanent-load "
            f"states; {_span(self.certified)} certified, reachable or not{exact}{stopped}",
            *self.remarks,
        )

    def to_dict(self) -> dict[str, Any]:
        """Return the result as plain numbers, lists and text."""
        return {
            "analysis": "range",
            "load_path": self.load_path.load_factor if self.load_path else None,
            "load_path_place": next((k for k, one in enumerate(self.answers) if one is self.load_path), None),
            **kept(self, "reached", "certified", "intervals", "unlimited", "frictionless", "associated"),
            **kept(self, "wedging", "least", "greatest", "answers", "paths", "mechanisms", "complete"),
            **kept(self, "remarks", "dilatancy", "turning", "tolerance", "digest"),
        }


def _span(pair: tuple[float, float]) -> str:
    low, high = pair
    return f"{low:.6g} to {high:.6g}" if low <= high else "nothing"
