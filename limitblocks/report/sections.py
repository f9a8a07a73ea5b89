"""What a report says of each kind of result, in the same few fields."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

from limitblocks.analysis.bounds import TOLERANCE, Bounds
from limitblocks.arrays import Array
from limitblocks.errors import LimitBlocksError
from limitblocks.model import Model


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
    headline : str
        The load factor, large.
    values : tuple of (str, str, str)
        Quantity, value, and where it comes from.
    checks : tuple of Check
        Residuals.
    tolerance : float
        Largest residual accepted.
    rates : Array, shape (n, 6)
        Displacement rates of the mechanism to draw.
    warnings : tuple of str
        What is no error but may not be meant.
    """

    title: str
    meaning: str
    headline: str
    values: tuple[tuple[str, str, str], ...]
    checks: tuple[Check, ...]
    tolerance: float
    rates: Array
    warnings: tuple[str, ...] = ()


def section(model: Model, result: Any) -> Section:
    """Return what a report says of `result`.

    Raises
    ------
    LimitBlocksError
        The result is of a kind unknown to reports, or belongs to another model.
    """
    make = _SECTIONS.get(type(result))
    if make is None:
        known = ", ".join(sorted(kind.__name__ for kind in _SECTIONS))
        raise LimitBlocksError(f"a report cannot show {type(result).__name__}; expected a result: {known}")
    if result.digest != model.digest:
        kind = type(result).__name__
        raise LimitBlocksError(f"this {kind} belongs to another model; give the model it is a result of")
    return make(result)


def _bounds(bounds: Bounds) -> Section:
    static, kinematic = bounds.solvers
    loose = f"the tolerance {bounds.tolerance:.1e} is looser than the usual {TOLERANCE:.1e}"
    return Section(
        title="Associated bounds",
        meaning=(
            "If sliding and twisting dilated the joints by the friction angle (associated flow), the "
            "structure would collapse at a load factor between the static value, of stresses in equilibrium "
            "within the yield surface, and the kinematic value, of a mechanism. Each is solved by itself; "
            "where they agree, both are proven for the yield surface below. Real joints dilate less: their "
            "load factor is at most this one and can be smaller."
        ),
        headline=f"{bounds.lower:#.4g}",
        values=(
            ("Static load factor", f"{bounds.lower:#.7g}", f"lower bound, {static}"),
            ("Kinematic load factor", f"{bounds.upper:#.7g}", f"upper bound, {kinematic}"),
            ("Gap", f"{bounds.gap:.1e}", "difference over the larger of the two"),
        ),
        checks=tuple(
            Check(entry.name, entry.value, entry.meaning, entry.value <= bounds.tolerance)
            for entry in bounds.residuals.entries
        ),
        tolerance=bounds.tolerance,
        rates=bounds.displacement_rates,
        warnings=(loose,) if bounds.tolerance > TOLERANCE else (),
    )


_SECTIONS: dict[type, Callable[[Any], Section]] = {Bounds: _bounds}
