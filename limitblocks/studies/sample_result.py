"""Result of a study over sampled parameters: quantiles, frequencies of modes, Sobol indices, tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from limitblocks.arrays import Array, real, reals
from limitblocks.errors import ModelError, SolveError
from limitblocks.evidence.residuals import OF_BOUNDS
from limitblocks.shown import counted, many
from limitblocks.studies.results import FLOWS, unanswered
from limitblocks.studies.rows import Rows, in_short

ANSWER = ("load_factor", "mode", "error", "remarks")  # columns beside the parameters
FEW = 19  # samples, below which the least of n has a share of more than 5 % below it, 1 / (n + 1)


@dataclass(frozen=True, eq=False, repr=False)
class SampledStudy(Rows):
    """Load factors of sampled parameters.

    Attributes
    ----------
    analysis : str
        "bounds" or "nonassociated".
    names : tuple of str, length k
        Parameters.
    values : Array, shape (rows, k)
        Their values.
    load_factors : Array, shape (rows,)
        Infinite where the load is unlimited, NaN where there is no answer.
    modes : tuple of str, length rows
        What the joints do in the mechanism, such as "hinge-slide".
    errors : tuple of str, length rows
        Class and message of the error of each analysis, empty where there is none.
    samples : int
        Independent samples: the first rows; more belong to Sobol indices.
    indices : bool
        Whether the rows suit Sobol indices.
    remarks : tuple of str, length rows
        What each analysis remarks on its answer, empty where it remarks nothing or nothing was kept.
    """

    analysis: str
    names: tuple[str, ...]
    values: Array
    load_factors: Array
    modes: tuple[str, ...]
    errors: tuple[str, ...]
    samples: int
    indices: bool
    remarks: tuple[str, ...] = ()

    @property
    def failures(self) -> int:
        """Number of rows without a load factor."""
        return int(np.isnan(self.load_factors).sum())

    def quantiles(self, shares: Sequence[float] = (0.05, 0.5, 0.95), failed: float | None = None) -> Array:
        """Return quantiles of the load factor over the independent samples that have one.

        One for each of `shares`, 0 to 1. The k-th least of n is the quantile k / (n + 1), the share that is
        below it on average; less than the first and more than the last there is not (Weibull 1939; Hyndman &
        Fan 1996, definition 6). A row whose dead loads fall counts as load factor zero; other failures are
        left out, or count as the load factor `failed`: with 0 each quantile is the least that it can be,
        with inf the largest. Between a load factor and an unlimited one the lower counts; between one and a
        failure that counts as inf there is no largest, and the quantile is inf.

        Raises
        ------
        ModelError
            If a share is no number from 0 to 1.
        SolveError
            If no row has a load factor.
        """
        try:
            asked = reals(shares)
        except (TypeError, ValueError):
            asked = np.array(np.nan)
        if not ((asked >= 0.0) & (asked <= 1.0)).all():
            raise ModelError(f"shares is {shares!r}, expected numbers from 0 to 1, such as 0.05 for 5 %")
        known = np.sort(self._known(failed))
        most = known[np.isfinite(known)].max(initial=0.0)
        place = np.clip(asked * (len(known) + 1) - 1.0, 0.0, len(known) - 1.0)
        between = np.interp(place, np.arange(len(known)), np.minimum(known, most))
        # a failure may have any finite load factor, of which the quantile has a share
        end = np.ceil(place) if failed == np.inf and np.isnan(self._known(np.nan)).any() else place
        return np.where(np.isinf(known[end.astype(int)]), np.inf, between)

    def probability_below(self, demand: float) -> float:
        """Return the share of independent samples whose load factor is below `demand`; falling ones are.

        Of those that have one or fall: with the others it is at least share (1 - f) and at most
        share (1 - f) + f, f the share of these others.

        Raises
        ------
        ModelError
            If the demand is no number.
        """
        if np.isnan(least := real(demand)):
            raise ModelError(f"demand is {demand!r}, expected a load factor")
        return float((self._known() < least).mean())

    def mode_frequencies(self) -> dict[str, float]:
        """Return the share of each mode among the independent samples that have one, most frequent first."""
        counts = counted(self.modes[: self.samples])
        return {mode: count / sum(counts.values()) for mode, count in counts.items()}

    def sobol(self) -> dict[str, tuple[float, float]]:
        """Return first-order and total Sobol index of each parameter (Saltelli et al. 2010; scipy.stats).

        Of one parameter both are 1: all variance is its own.

        Raises
        ------
        ModelError
            If the study was not sampled for indices.
        SolveError
            If a row has no finite load factor, or all are one but for the tolerance of bounds: the indices
            are shares of their variance.
        """
        from scipy.stats import sobol_indices

        if not self.indices:
            raise ModelError("the study was not sampled for Sobol indices; use study(..., indices=True)")
        f = self.load_factors.reshape(-1, self.samples)
        if not np.isfinite(f).all():
            raise SolveError("a sample has no load factor; Sobol indices need all of them")
        if np.ptp(f) <= OF_BOUNDS * np.abs(f).max():
            raise SolveError(
                f"all load factors are {f[0, 0]:.6g}: no parameter changes them, and there is no variance of "
                "which Sobol indices are shares"
            )
        if len(self.names) == 1:  # scipy needs two
            return {self.names[0]: (1.0, 1.0)}
        func: Mapping[str, Array] = {"f_A": f[0][None], "f_B": f[1][None], "f_AB": f[2:][:, None]}
        found = sobol_indices(func=func, n=self.samples)  # type: ignore[arg-type] # stubs ask for a plain dict
        pairs = zip(found.first_order.ravel().tolist(), found.total_order.ravel().tolist(), strict=True)
        return dict(zip(self.names, pairs, strict=True))

    def rows(self) -> list[dict[str, Any]]:
        """Return a row for each analysis, plain numbers and text."""
        remarks = self.remarks or ("",) * len(self.errors)
        columns = self.load_factors.tolist(), self.modes, self.errors, remarks
        names = (*self.names, *ANSWER)
        return [
            dict(zip(names, (*values, *answer), strict=True))
            for values, *answer in zip(self.values.tolist(), *columns, strict=True)
        ]

    def to_dict(self) -> dict[str, Any]:
        """Return the rows and what is asked of them most as numbers and text."""
        rows = [
            {key: None if isinstance(v, float) and not np.isfinite(v) else v for key, v in row.items()}
            for row in self.rows()
        ]
        kind = {"analysis": "study", "study": type(self).__name__, "of": self.analysis}
        return kind | {"parameters": list(self.names), "rows": rows}

    def __str__(self) -> str:
        failed = unanswered(self.load_factors, self.errors)
        said = f"{many(len(self.load_factors), 'analysis', 'analyses')} of {', '.join(self.names)}"
        try:
            low, middle, high = map(in_short, self.quantiles().tolist())
        except SolveError:
            return f"{said}, no load factor{failed}"
        few = len(self._known()) < FEW
        ends = f"{'least and largest' if few else '5 % to 95 %'} {low} to {high}"
        found = f"{FLOWS[self.analysis]} load factor {middle}, {ends}"
        return f"{said}: {found}{failed}{self._left_out}{self._remarked}"

    @property
    def _remarked(self) -> str:
        """How many answers have a remark, and the most frequent one."""
        counts = counted(self.remarks)
        return f"; {sum(counts.values())} with remarks, such as: {next(iter(counts))}" if counts else ""

    @property
    def _left_out(self) -> str:
        """What the quantiles can be where samples without an answer are left out of them."""
        if not np.isnan(self._known(np.nan)).any():
            return ""
        least, most = self.quantiles([0.05], failed=0.0)[0], self.quantiles([0.95], failed=np.inf)[0]
        limit = "may be unlimited" if most == np.inf else f"at most {most:.6g}"
        return (
            "; the quantiles leave these out, on whichever side they lie: with them 5 % is at least "
            f"{least:.6g}, 95 % {limit}"
        )

    def _known(self, failed: float | None = None) -> Array:
        own, errors = self.load_factors[: self.samples], self.errors[: self.samples]
        falls = np.array([error.startswith("NoEquilibrium") for error in errors])
        known = np.where(falls, 0.0, own)
        known = known[~np.isnan(known)] if failed is None else np.where(np.isnan(known), failed, known)
        if not len(known):
            raise SolveError(f"no analysis of the study gave a load factor: {self.errors[0]}")
        return np.asarray(known)
