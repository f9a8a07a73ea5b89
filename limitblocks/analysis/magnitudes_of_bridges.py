"""Slips in the magnitude of what bridges have: axles, passive pressure, levels of road and fill."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from limitblocks.analysis.magnitudes_of_fills import of_earth_pressure
from limitblocks.mechanics.loads.fills import Fill
from limitblocks.model import Model
from limitblocks.shown import coordinate

#: Axle load, N, below which it may be in kN: a bicycle has 500.
_LIGHT = 1e3
#: Distance, m, of neighbouring axles beyond which it may be in mm: bogies of a wagon are 25 m apart.
_APART = 50.0
#: Levels, m, that are nearer are the same: a message shows no more.
_SAME = 1e-3


def of_passive(coefficient: float) -> list[str]:
    """Return the question for a coefficient of passive earth pressure: Rankine's is one or more."""
    if coefficient < 1.0:
        return [f"coefficient of passive pressure is {coefficient:g}, below 1: that of active pressure?"]
    return of_earth_pressure(coefficient)


def of_axles(axles: Sequence[float], distances: Sequence[float]) -> list[str]:
    """Return the questions for the axle loads of a vehicle, N, and for their distances, m."""
    asked = []
    if (heaviest := max(axles)) < _LIGHT:
        asked.append(f"the heaviest axle is {heaviest:g} N: kN? {heaviest:g} kN = {1e3 * heaviest:g} N")
    apart = [abs(b - a) for a, b in pairwise(sorted(distances))]
    if apart and (least := min(apart)) > _APART:
        asked.append(
            f"the axles are {least:g} m or more apart: millimetres? {least:g} mm = {least / 1e3:g} m"
        )
    return asked


def of_level(model: Model, level: float, what: str) -> list[str]:
    """Return the question for the level, m, of a road or fill where that of a model ends elsewhere."""
    levels = {term.level for _, term in model.dead.terms if isinstance(term, Fill)}
    return [
        f"the {what} is at {coordinate(level)} m, the fill of the model ends at {coordinate(own)} m: meant?"
        for own in sorted(levels)
        if abs(own - level) > _SAME
    ]
