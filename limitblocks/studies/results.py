"""Results of studies: load factors against directions, places and parameters."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from limitblocks.arrays import Array
from limitblocks.errors import SolveError
from limitblocks.shown import many
from limitblocks.studies.pool import Result
from limitblocks.studies.rows import Rows, in_short

FLOWS = {"bounds": "associated", "nonassociated": "non-associated"}  # of which a load factor is


FALLS = "NoEquilibrium"
#: Columns of the answers of a study, whatever its analysis.
ANSWER = ("load_factor", "lower", "upper", "frictionless", "associated", "worst_residual", "error", "remarks")
NO_MODEL = ("ModelError", "GeometryError", "ValueError")  # of the maker, or of what it gives


def unanswered(load_factors: Array, errors: Sequence[str]) -> str:
    """Return in words how many are unlimited, fall, are no model or have no answer, with why the first is."""
    fallen, refused = (np.array([error.startswith(kind) for error in errors]) for kind in (FALLS, NO_MODEL))
    lost, unlimited = np.isnan(load_factors) & ~fallen & ~refused, int(np.isinf(load_factors).sum())
    words = [f"{unlimited} unlimited"] if unlimited else []
    words += [f"{fallen.sum()} that fall ({errors[int(fallen.argmax())]})"] if fallen.any() else []
    words += [f"{refused.sum()} without a model ({errors[int(refused.argmax())]})"] if refused.any() else []
    words += [f"{lost.sum()} without an answer ({errors[int(lost.argmax())]})"] if lost.any() else []
    return "".join(f"; {word}" for word in words)


@dataclass(frozen=True, eq=False, repr=False)
class Study(Rows):
    """Load factors of many analyses, in the order asked for.

    Attributes
    ----------
    analysis : str
        "bounds" or "nonassociated".
    load_factors : Array, shape (n,)
        Static bound or non-associated load factor; infinite where the load is unlimited, NaN where there is
        no answer.
    results : tuple of (Bounds or Nonassociated or None), length n
        Full results; where an analysis did not converge its best state, which `load_factors` leaves out.
    errors : tuple of str, length n
        Class and message of the error of each analysis, empty where there is none.
    """

    analysis: str
    load_factors: Array
    results: tuple[Result | None, ...]
    errors: tuple[str, ...]

    @property
    def least(self) -> int:
        """Number of the row of least load factor; rows that fall under the dead loads alone have none.

        Raises
        ------
        SolveError
            If no row has a load factor.
        """
        if not np.isfinite(self.load_factors).any():
            raise SolveError(f"no analysis of the study gave a load factor: {self.errors[0]}")
        return int(np.nanargmin(self.load_factors))

    def rows(self) -> list[dict[str, Any]]:
        """Return a row for each analysis, plain numbers and text."""
        answers = zip(self.load_factors.tolist(), self.results, self.errors, strict=True)
        return [self._key(k) | _answer(*answer, self.analysis) for k, answer in enumerate(answers)]

    def to_dict(self) -> dict[str, Any]:
        """Return the study as plain numbers, lists and text."""
        return {"analysis": "study", "study": type(self).__name__, "of": self.analysis, "rows": self.rows()}

    def __str__(self) -> str:
        lost = unanswered(self.load_factors, self.errors)
        if not np.isfinite(self.load_factors).any():
            return f"{many(len(self.errors), 'analysis', 'analyses')}, no load factor{lost}"
        units = {name: f" {unit}" for name, unit in self.units.items()}
        here = self._key(self.least).items()
        where = ", ".join(f"{name} {in_short(value)}{units.get(name, '')}" for name, value in here)
        least, result = self.load_factors[self.least], self.results[self.least]
        made = f"{many(len(self.errors), 'analysis', 'analyses')}, {FLOWS[self.analysis]}"
        said = f"; there: {'; '.join(result.remarks)}" if result and result.remarks else ""
        return f"{made}: least load factor {least:.6g} at {where}{self._elsewhere}{lost}{said}"

    @property
    def _elsewhere(self) -> str:
        """What is known where no analysis was asked for."""
        return ""

    def _key(self, k: int) -> dict[str, Any]:
        return {"row": k}


@dataclass(frozen=True, eq=False, repr=False)
class Directions(Study):
    """Load factor against the direction of the live load.

    Attributes
    ----------
    directions : Array, shape (n, 3)
        Unit vectors.
    convex : bool
        Whether what the structure carries along all directions is a convex set: that of a live load which
        is linear in its direction, where the flow is associated.
    """

    directions: Array
    convex: bool = False
    units: ClassVar[dict[str, str]] = {"angle": "rad"}

    @property
    def between(self) -> float:
        """Static load factor that no direction in plan between two neighbours is below; NaN if unknown.

        Stress states of both add up to one of each point of the chord between them in the polar curve. It is
        unknown where that is not `convex`, or no two neighbours are less than 180 degrees apart.
        """
        plan = np.flatnonzero(self.directions[:, 2] == 0.0)
        if not self.convex or not len(plan) or np.isnan(self.load_factors[plan]).any():
            return float("nan")
        order = plan[np.argsort(self.angles[plan])]
        way = np.diff(self.angles[order], append=self.angles[order[0]] + 2 * np.pi)
        with np.errstate(divide="ignore", invalid="ignore"):
            r = 1.0 / self.load_factors[order]
            s = np.roll(r, -1)
            inside = (r > s * np.cos(way)) & (s > r * np.cos(way))  # the foot of the origin on the chord
            chord = np.sin(way) / np.sqrt(r**2 + s**2 - 2.0 * r * s * np.cos(way))
            least = np.where(inside, chord, 1.0 / np.maximum(r, s))[way < np.pi - 1e-9]
        return float(least.min()) if len(least) else float("nan")

    @property
    def angles(self) -> Array:
        """Angle in plan from +X towards +Y, rad, in [0, 2 pi); NaN where vertical; shape (n,)."""
        x, y, _ = self.directions.T
        angles = np.mod(np.arctan2(y, x), 2 * np.pi)
        return np.where(np.hypot(x, y) > 1e-9, angles, np.nan)

    def to_dict(self) -> dict[str, Any]:
        """Return the study as plain numbers, lists and text."""
        return super().to_dict() | {"between": self.between}

    @property
    def _elsewhere(self) -> str:
        if np.isnan(self.between):
            return "; other directions may have less"
        return f"; {self.between:.6g} or more between neighbouring directions"

    def _key(self, k: int) -> dict[str, Any]:
        x, y, z = self.directions[k].tolist()
        return {"angle": float(self.angles[k]), "x": x, "y": y, "z": z}


@dataclass(frozen=True, eq=False, repr=False)
class MovingLoad(Study):
    """Load factor against the place of a load.

    Attributes
    ----------
    positions : Array, shape (n, 2)
        Places (x, y) in plan, m.
    """

    positions: Array
    units: ClassVar[dict[str, str]] = {"x": "m", "y": "m"}

    @property
    def worst_position(self) -> tuple[float, float]:
        """Place (x, y) of least load factor, m."""
        x, y = self.positions[self.least].tolist()
        return x, y

    @property
    def _elsewhere(self) -> str:
        return "; other places may have less"

    def _key(self, k: int) -> dict[str, Any]:
        x, y = self.positions[k].tolist()
        return {"x": x, "y": y}


@dataclass(frozen=True, eq=False, repr=False)
class Sweep(Study):
    """Load factor against a parameter.

    Attributes
    ----------
    parameter : str
        Its name.
    values : tuple, length n
        Its values.
    """

    parameter: str
    values: tuple[Any, ...]

    def _key(self, k: int) -> dict[str, Any]:
        value = self.values[k]
        value = value.item() if isinstance(value, np.generic) else value
        return {self.parameter: value if isinstance(value, str | int | float) else str(value)}


def _answer(load_factor: float, result: Result | None, error: str, analysis: str) -> dict[str, Any]:
    """The columns that all rows of one analysis have."""
    names = ("lower", "upper") if analysis == "bounds" else ("frictionless", "associated")
    beside = {name: np.nan if error else float(getattr(result, name)) for name in names}
    worst = np.nan if error or result is None else result.residuals.worst.value
    remarks = "" if error or result is None else "; ".join(result.remarks)
    words = {"error": error, "remarks": remarks}
    return {"load_factor": load_factor} | beside | {"worst_residual": worst} | words
