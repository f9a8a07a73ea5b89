"""Results made from what they wrote of themselves: each field from its own key, by its type.

What the registry of results says of a kind comes first, here for parts of results as well.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import MISSING, fields, is_dataclass, replace
from enum import Enum
from math import inf, nan
from types import NoneType, UnionType
from typing import Any, Union, get_args, get_origin, get_type_hints

import numpy as np
import numpy.typing as npt

from limitblocks.arrays import Array, Indices, read_only
from limitblocks.errors import ModelError
from limitblocks.evidence.associated import Bounds
from limitblocks.evidence.backward_error import MEANINGS, BackwardError
from limitblocks.evidence.load_path_result import LoadPath, Snap
from limitblocks.evidence.range_answer import Origin
from limitblocks.evidence.range_result import LoadFactorRange
from limitblocks.evidence.residuals import Residual, Residuals
from limitblocks.io.model_file import model_from
from limitblocks.kinds import KINDS, Kind, named
from limitblocks.model import Model
from limitblocks.shown import KEYS

#: What null stands for where it is not NaN.
_NULL = {"lower": -inf} | dict.fromkeys(
    ("associated", "upper", "bound", "intervals", "stress_limit", "multiplier_limit"), inf
)
#: And in arrays that may have it.
_NULLS = {"load_factors": inf} | dict.fromkeys(
    ("friction", "cohesion", "compressive_strength", "tensile_strength", "frictions"), nan
)
_COLUMNS = dict.fromkeys(("stress_resultants", "displacement_rates", "arising", "displacements"), 6)
_MOST = 1e30  # in size: far beyond any structure, and its powers are still finite
_Flags = npt.NDArray[np.bool_]
_STEP = {"step", "kind", "load_factor", "newly_active", "displacements", "stress_resultants"}


class Lacking(ValueError):
    """Something that the class needs is not there, or is of another type."""


def result_of(data: Any) -> Any:
    """Return the result whose ``to_dict()`` is `data`, marked as from a file.

    Raises
    ------
    Lacking
        It is of no known kind, or the class needs more than there is.
    """
    word = data.get("analysis") if isinstance(data, dict) else None
    kind = KINDS.get(word) if isinstance(word, str) else None
    if kind is None:
        raise Lacking("analysis")
    try:
        return _read(kind, data)
    except (AttributeError, IndexError, KeyError, ModelError, TypeError, ValueError) as error:
        raise Lacking(str(error)) from None


def _read(kind: Kind, data: Mapping[str, Any]) -> Any:
    return named(kind.read)(named(kind.home), data)


def bounds_of(kind: type[Bounds], data: Mapping[str, Any]) -> Bounds:
    """Bounds, which need their upper one."""
    if data["upper"] is None:
        raise Lacking("upper")
    found: Bounds = made(kind, data)
    return found


def path_of(kind: type[LoadPath], data: Mapping[str, Any]) -> LoadPath:
    """A path, whose steps have their residuals as keys of their own and whose snaps name steps."""
    steps = [
        step
        | {"residuals": {k: v for k, v in step.items() if k not in _STEP}, "active": step["newly_active"]}
        for step in data["steps"]
    ]
    found: LoadPath = made(kind, {**data, "steps": steps, "snaps": []})
    end = found.collapse.displacement_rates.shape, found.collapse.stress_resultants.shape
    if not found.steps or any(
        (step.displacements.shape, step.stress_resultants.shape) != end for step in found.steps
    ):
        raise Lacking("no steps, or of another size than the collapse")
    snaps = (Snap(found.steps[_place(i)], found.steps[_place(j)]) for i, j in data["snaps"])
    return replace(found, snaps=tuple(snaps))


def range_of(kind: type[LoadFactorRange], data: Mapping[str, Any]) -> LoadFactorRange:
    """A range, which names the answer of the load path by its place."""
    found: LoadFactorRange = made(kind, {**data, "load_path": None})
    for key in ("frictionless", "associated", "dilatancy", "turning"):
        for solution in (one.solution for one in found.answers):
            if str(getattr(solution, key)) != str(getattr(found, key)):
                said = f"{key} is {getattr(found, key)!r}"
                raise ModelError(f"{said}, but {getattr(solution, key)!r} of an answer")
    place = data["load_path_place"]
    return found if place is None else replace(found, load_path=found.answers[_place(place)])


def _place(data: Any) -> int:
    if type(data) is not int or data < 0:
        raise Lacking(f"{data!r} is no place")
    return data


def made(kind: Any, data: Any) -> Any:
    """Return a frozen dataclass of what the keys say; a key that is not there is the field's default."""
    if kind is BackwardError:
        return _backward_error(data)
    hints = get_type_hints(kind)
    said: dict[str, Any] = {}
    for field in fields(kind):
        key = KEYS.get(field.name, field.name)
        if field.name == "from_file":
            said[field.name] = True
        elif hints[field.name] is Residuals:
            with _within(key):
                said[field.name] = _residuals(data.get(key), data.get("residual_details", {}))
        elif key in data:
            with _within(key):
                said[field.name] = _value(hints[field.name], data[key], field.name)
        elif field.default is MISSING and field.default_factory is MISSING:
            raise Lacking(f"{key} is missing")
    if said.get("digest") == "":
        raise Lacking("the model is not named")
    return kind(**said)


@contextmanager
def _within(key: str) -> Iterator[None]:
    """Name the key under which something is wrong."""
    try:
        yield
    except (AttributeError, IndexError, KeyError, ModelError, TypeError, ValueError) as error:
        raise Lacking(f"{key}: {error}") from None


def _value(kind: Any, data: Any, name: str) -> Any:
    """What `data` says, of the type that a field has."""
    origin, parts = get_origin(kind), get_args(kind)
    if origin in (Union, UnionType):
        if data is None:
            return None
        (kind,) = (part for part in parts if part is not NoneType)
        return _value(kind, data, name)
    if kind in (Array, Indices, _Flags):  # aliases since numpy 2.5, whose origin is no class
        return _flags(data) if kind == _Flags else _array(data, name)
    if origin is tuple and isinstance(data, list):
        kinds = [parts[0]] * len(data) if parts[-1] is Ellipsis else parts
        return tuple(_value(part, one, name) for part, one in zip(kinds, data, strict=True))
    if origin is dict:
        return {str(key): _number(one, inf) for key, one in data.items()}
    if is_dataclass(kind):
        return _part(kind, data)
    if issubclass(kind, Enum):
        return _member(kind, data)
    if kind is float:
        return _number(data, _NULL.get(name, nan))
    if type(data) is not kind:
        raise Lacking(f"{data!r} is no {kind.__name__}")
    return data


def _part(kind: Any, data: Any) -> Any:
    """A part that is a model, a result of its own, or has fields."""
    if kind is Model:
        return model_from(data)
    known = KINDS.get(str(data.get("analysis")))
    return _read(known, data) if known and known.name == kind.__name__ else made(kind, data)


def _member(kind: type[Enum], data: Any) -> Enum:
    for one in kind:
        if data in (one.value, _word(one)):
            return one
    raise Lacking(f"{data!r} is none of {kind.__name__}")


def _word(member: Enum) -> str:
    """As the origin of an answer and the kind of stability are written."""
    return member.name.lower().replace("_", " " if isinstance(member, Origin) else "-")


def _number(data: Any, null: float) -> float:
    if data is None:
        return null
    if type(data) not in (int, float) or not abs(data) < _MOST:
        raise Lacking(f"{data!r} is no number")
    return float(data)


def _array(data: Any, name: str) -> Array:
    columns = _COLUMNS.get(name, 3 if name == "trace" else None)
    if name in _NULLS:
        return read_only(np.array([_number(one, _NULLS[name]) for one in data]))
    array = np.array(data)
    numbers = array.dtype.kind in "fi" and array.ndim == (2 if columns else 1)
    if array.size and not (numbers and np.abs(array).max() < _MOST):
        raise Lacking("no array of numbers")
    return read_only(array.reshape(-1, columns) if columns else array.ravel())


def _flags(data: Any) -> _Flags:
    flags = np.array(data)
    if flags.dtype != bool or flags.ndim != 1:
        raise Lacking("no array of true and false")
    flags.flags.writeable = False
    return flags


def _residuals(data: Mapping[str, Any] | None, details: Mapping[str, Any]) -> Residuals:
    """Residuals by name; what they measure and where may be told beside them."""
    if not data:
        raise Lacking("no residuals")
    rows = ((name, _number(value, inf), details.get(name, ("", ""))) for name, value in data.items())
    return Residuals(tuple(Residual(name, value, str(said), str(at)) for name, value, (said, at) in rows))


def _backward_error(data: Mapping[str, Any]) -> BackwardError:
    where = data.get("at", {})
    parts = {
        name: Residual(name, _number(data.get(name, 0.0), inf), said, str(where.get(name, "")))
        for name, said in MEANINGS.items()
    }
    places = tuple((str(name), _number(change, inf)) for name, change in data["places"])
    return BackwardError(**parts, places=places, model=_number(data["model"], inf), exact=None)
