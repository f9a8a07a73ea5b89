"""The value of a parameter at which a structure begins to stand or to fall."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import optimize

from limitblocks.analysis.stability import remarked_margin
from limitblocks.arrays import real
from limitblocks.errors import ModelError, SolverFailure, refuse_no_function
from limitblocks.evidence.residuals import TOLERANCE
from limitblocks.mechanics.loads.load import number
from limitblocks.model import Model, checked_model
from limitblocks.shown import kept, many
from limitblocks.studies.rows import Rows

#: Width of the bracket over the interval searched, unless a tolerance is given.
RELATIVE = 1e-6
_MOST = 100  # evaluations
Trial = Callable[[float], None]


@dataclass(frozen=True, repr=False)
class Threshold(Rows):
    """Bracket of the value of a parameter at which the loads just stand.

    Attributes
    ----------
    parameter : str
        Its name.
    stands, falls : float
        Ends of the bracket, at most `tolerance` apart: values for which the loads stand and fall.
    tolerance : float
        Largest width of the bracket, in the unit of the parameter.
    load_factor : float
        Of the live load that acts beside the dead loads.
    trials : tuple of (float, float)
        Every value tried with its margin, as in :class:`limitblocks.results.Stability`; down to -1e-8, the
        tolerance of all residuals, it counts as standing.
    remarks : tuple of str
        What to know of the stresses at the safe end.
    """

    parameter: str
    stands: float
    falls: float
    tolerance: float
    load_factor: float
    trials: tuple[tuple[float, float], ...]
    remarks: tuple[str, ...] = ()

    @property
    def value(self) -> float:
        """The safe end of the bracket, where the loads stand."""
        return self.stands

    @property
    def bracket(self) -> tuple[float, float]:
        """Both ends, in ascending order."""
        return min(self.stands, self.falls), max(self.stands, self.falls)

    def __str__(self) -> str:
        beside = f" with load factor {self.load_factor:g}" if self.load_factor else ""
        size, width = max(map(abs, self.bracket)), abs(self.falls - self.stands)
        digits = max(6, int(np.ceil(np.log10(size / width))) + 2)  # two of the width: the ends are told apart
        said = (
            f"{self.parameter} {self.stands:.{digits}g} stands, {self.falls:.{digits}g} falls{beside} "
            f"({many(len(self.trials), 'trial')})"
        )
        return "; ".join((said, *self.remarks))

    def rows(self) -> list[dict[str, Any]]:
        """Return a row for each trial, in ascending order."""
        return [
            {self.parameter: value, "margin": margin, "stands": margin >= -TOLERANCE}
            for value, margin in sorted(self.trials)
        ]

    def to_dict(self) -> dict[str, Any]:
        """Return the result as plain numbers, lists and text."""
        names = ("parameter", "value", "bracket", "tolerance", "load_factor", "remarks")
        kind = {"analysis": "study", "study": type(self).__name__}
        return kind | kept(self, *names) | {"rows": self.rows()}


def minimum(
    maker: Callable[[float], Model],
    low: float,
    high: float,
    *,
    parameter: str = "value",
    load_factor: float = 0.0,
    tolerance: float | None = None,
    progress: Trial | None = None,
) -> Threshold:
    """Return the least value of a parameter for which the loads stand, such as the thickness of an arch.

    The structure of `low` falls and that of `high` stands; in between there is one change. Brent's method
    (scipy.optimize.brentq) finds where the margin, as in :class:`limitblocks.results.Stability`, passes zero,
    and trials on both sides of it close the bracket. The dead loads are those of the model; with a load
    factor its live load acts, too. The flow is associated: for sliding without dilatancy,
    standing in this sense is necessary, not sufficient.

    Parameters
    ----------
    maker : callable
        Gives the model of a value.
    low, high : float
        Interval to search.
    parameter : str
        Name of the parameter, in messages and tables.
    load_factor : float
        Of the live load, which has to be carried beside the dead loads.
    tolerance : float, optional
        Largest width of the bracket; 1e-6 of the interval unless given.
    progress : callable, optional
        Called with each value before it is tried.

    Raises
    ------
    ModelError
        If low is not less than high, the structure stands at `low` or falls at `high`, or `maker` cannot
        make a model of a value.
    SolverFailure
        If a margin is not found, or the bracket does not close.
    """
    return _Search(maker, parameter, load_factor, progress).between(low, high, False, tolerance)


def maximum(
    maker: Callable[[float], Model],
    low: float,
    high: float,
    *,
    parameter: str = "value",
    load_factor: float = 0.0,
    tolerance: float | None = None,
    progress: Trial | None = None,
) -> Threshold:
    """Return the largest value of a parameter for which the loads stand, such as a height or a span.

    As :func:`minimum`, with the same parameters and errors, but the structure of `low` stands and that of
    `high` falls.
    """
    return _Search(maker, parameter, load_factor, progress).between(low, high, True, tolerance)


class _Search:
    """Margins of the values tried so far."""

    def __init__(
        self, maker: Callable[[float], Model], parameter: str, load_factor: float, progress: Trial | None
    ) -> None:
        refuse_no_function(maker)
        self.maker, self.parameter = maker, parameter
        self.load_factor = number(load_factor, "load factor", "")
        self.progress = progress
        self.trials: dict[float, float] = {}
        self.remarks: dict[float, tuple[str, ...]] = {}

    def margin(self, value: float) -> float:
        """Margin of a value above what counts as standing: zero or more where the loads stand."""
        value = float(value)
        if value not in self.trials:
            if self.progress is not None:
                self.progress(value)
            try:
                found = remarked_margin(checked_model(self.maker(value)), self.load_factor)
                self.trials[value], self.remarks[value] = found
            except (ModelError, SolverFailure) as error:
                faults = error.problems if isinstance(error, ModelError) else (str(error),)
                raise type(error)(*(f"{self.parameter} = {value:g}: {fault}" for fault in faults)) from None
        return self.trials[value] + TOLERANCE

    def between(self, low: float, high: float, low_stands: bool, tolerance: float | None) -> Threshold:
        """Close the bracket between a value that stands and one that falls."""
        if not -np.inf < real(low) < real(high) < np.inf:
            raise ModelError(f"low is {low!r} and high is {high!r}, expected two finite numbers, low < high")
        width = RELATIVE * (high - low) if tolerance is None else tolerance
        if not real(width) > 4 * np.finfo(float).eps * max(abs(low), abs(high)):
            raise ModelError(f"tolerance is {tolerance!r}, expected a width above rounding errors")
        for end, value, stands in (("low", low, low_stands), ("high", high, not low_stands)):
            if (self.margin(value) >= 0.0) is not stands:
                was, wanted = ("stand", "falls") if not stands else ("fall", "stands")
                raise ModelError(
                    f"at {end}, {self.parameter} = {value:g}, the loads {was}; expected a value at which "
                    f"the structure {wanted}"
                )
        self._close(low, high, width)
        standing = [value for value in self.trials if self.margin(value) >= 0.0]
        falling = [value for value in self.trials if self.margin(value) < 0.0]
        ends = (max(standing), min(falling)) if low_stands else (min(standing), max(falling))
        if (ends[1] < ends[0]) is low_stands:
            raise SolverFailure(
                f"{self.parameter}: standing and falling change more than once in the interval"
            )
        trials, remarks = tuple(self.trials.items()), self.remarks[ends[0]]
        return Threshold(self.parameter, *ends, width, self.load_factor, trials, remarks)

    def _close(self, low: float, high: float, width: float) -> None:
        """Try values until one that stands and one that falls are no more than `width` apart."""
        root = float(optimize.brentq(self.margin, low, high, xtol=width / 4, maxiter=_MOST))
        for value in (root - width / 2, root + width / 2):
            self.margin(min(max(value, low), high))
        for _ in range(_MOST):  # only where the margin jumps or is flat
            a, b = self._bracket(low, high)
            if b - a <= width:
                return
            self.margin((a + b) / 2)
        raise SolverFailure(f"{self.parameter}: the bracket does not close to {width:g}")

    def _bracket(self, low: float, high: float) -> tuple[float, float]:
        """Neighbouring trials of which one stands and one falls, those at `low` and `high` at worst."""
        tried = sorted(self.trials)
        side = [self.margin(value) >= 0.0 for value in tried]
        changes = [k for k in range(len(tried) - 1) if side[k] != side[k + 1]]
        return (tried[changes[0]], tried[changes[0] + 1]) if changes else (low, high)
