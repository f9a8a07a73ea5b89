"""Units that a model file may state, and its numbers in SI."""

from __future__ import annotations

from fractions import Fraction
from typing import Any, Literal, Protocol, TypeVar

from limitblocks.errors import ModelError

Length = Literal["m", "cm", "mm", "in", "ft"]
Force = Literal["N", "kN", "MN", "kgf", "lbf", "kip"]

# as fractions, so that 2200 mm is the number 2.2 and not one beside it; NIST SP 811, Appendix B
_LBF = Fraction("0.45359237") * Fraction("9.80665")
METRES = {
    "m": Fraction(1),
    "cm": Fraction("0.01"),
    "mm": Fraction("0.001"),
    "in": Fraction("0.0254"),
    "ft": Fraction("0.3048"),
}
NEWTONS = {
    "N": Fraction(1),
    "kN": Fraction(1000),
    "MN": Fraction(10**6),
    "kgf": Fraction("9.80665"),
    "lbf": _LBF,
    "kip": 1000 * _LBF,
}

#: Powers of force and length in every number of a model file, by its key; (0, 0) has no unit.
DIMENSIONS: dict[str, tuple[int, int]] = {
    **dict.fromkeys(
        (
            "size",
            "at",
            "vertices",
            "centroid",
            "polygon",
            "level",
            "beyond",
            "start",
            "end",
            "length",
            "outline",
            "between",
        ),
        (0, 1),
    ),
    **dict.fromkeys(("force", "weight"), (1, 0)),
    "moment": (1, 1),
    "force_per_length": (1, -1),
    **dict.fromkeys(
        ("pressure", "compressive_strength", "cohesion", "tensile_strength", "strength", "prestress"), (1, -2)
    ),
    "unit_weight": (1, -3),
    **dict.fromkeys(("axes", "faces", "direction", "facing", "towards", "factor", "coefficient"), (0, 0)),
    **dict.fromkeys(
        (
            "friction",
            "sides",
            "fineness",
            "points",
            "gap",
            "angle",
            "width",
            "accuracy",
            "schema_version",
            "gamma_Q",
        ),
        (0, 0),
    ),
}


class _Units(Protocol):
    length: Length
    force: Force


class _InUnits(Protocol):
    """A document that says its units, as a model file does."""

    @property
    def units(self) -> _Units: ...


Document = TypeVar("Document", bound=_InUnits)


def in_si(document: Document) -> Document:
    """Return the document with all its numbers in m and N.

    Raises
    ------
    ModelError
        If a key with numbers has no known unit, or a number leaves the range.
    """
    units = document.units
    if (units.length, units.force) == ("m", "N"):
        return document
    converted: Document = _part(document, METRES[units.length], NEWTONS[units.force])
    return converted


def _part(value: Any, metre: Fraction, newton: Fraction) -> Any:
    """A part of the document, and all within it, converted."""
    if isinstance(value, list):
        return [_part(part, metre, newton) for part in value]
    if isinstance(value, dict):
        return {key: _part(part, metre, newton) for key, part in value.items()}
    if not hasattr(type(value), "model_fields"):
        return value
    changes = {}
    for key in type(value).model_fields:
        part = getattr(value, key)
        changes[key] = _numbers(part, key, metre, newton) if _numeric(part) else _part(part, metre, newton)
    return value.model_copy(update=changes)


def _numeric(value: Any) -> bool:
    if isinstance(value, list | tuple):
        return bool(value) and _numeric(value[0])
    return isinstance(value, float | int) and not isinstance(value, bool)


def _numbers(value: Any, key: str, metre: Fraction, newton: Fraction) -> Any:
    if key not in DIMENSIONS:
        raise ModelError(f"units: the unit of {key!r} is not known; write the file in m and N")
    force, length = DIMENSIONS[key]
    return _scaled(value, key, newton**force * metre**length) if force or length else value


def _scaled(value: Any, key: str, factor: Fraction) -> Any:
    if isinstance(value, list | tuple):
        return type(value)(_scaled(part, key, factor) for part in value)
    scaled = float(Fraction(value) * factor)
    if abs(scaled) < 1e30:
        return scaled
    raise ModelError(f"units: {key} is {value:g}, in SI {scaled:g}; expected a number less than 1e30 in size")
