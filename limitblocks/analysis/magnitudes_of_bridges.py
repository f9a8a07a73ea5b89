"""Slips in the magnitude of what bridges have: axles, passive pressure, levels of road and fill."""

from __future__ import annotations

from collections.abc import Sequence

from limitblocks.analysis.magnitudes_of_fills import of_earth_pressure
from limitblocks.mechanics.loads.fills import Fill
from limitblocks.model import Model
from limitblocks.shown import coordinate

#: Axle load, N, below which it may be in kN: a bicycle has 500.
_LIGHT = 1e3
#: Levels, m, that are nearer are the same: a message shows no more.
_SAME = 1e-3


def of_passive(coefficient: float) -> list[str]:
    """Return the question for a coefficient of passive earth pressure: Rankine's is one or more."""
    if coefficient < 1.0:
        return [f"coefficient of passive pressure is {coefficient:g}, below 1: that of active pressure?"]
    return of_earth_pressure(coefficient)


def of_axles(axles: Sequence[float]) -> list[str]:
    """Return the question for the axle loads of a vehicle, N."""
    if (heaviest := max(axles)) < _LIGHT:
        return [f"the heaviest axle is {heaviest:g} N: kN? {heaviest:g} kN = {1e3 * heaviest:g} N"]
    return []


def of_level(model: Model, level: float, what: str) -> list[str]:
    """Return the question for the level, m, of a road or fill where that of a model ends elsewhere."""
    levels = {term.level for _, term in model.dead.terms if isinstance(term, Fill)}
    return [
        f"the {what} is at {coordinate(level)} m, the fill of the model ends at {coordinate(own)} m: meant?"
        for own in sorted(levels)
        if abs(own - level) > _SAME
    ]
