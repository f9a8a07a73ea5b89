"""What the words and numbers of a block must be."""

from __future__ import annotations

import operator
import re
import reprlib
from collections.abc import Callable, Sequence
from typing import Any, NoReturn

import numpy as np

from limitblocks.arrays import Array, read_only, real, reals
from limitblocks.errors import GeometryError, ModelError
from limitblocks.geometry.polyhedron import Faces

_LARGEST = 1e30  # its cube is still a number
_COLOUR = re.compile(r"#[0-9a-f]{6}")


def wrong(name: str, fault: str) -> NoReturn:
    """Raise GeometryError that names the block."""
    raise GeometryError(f"block {name!r}: {fault}")


def require_name(name: object) -> None:
    """Raise ModelError unless `name` is a text that is not empty."""
    if not isinstance(name, str) or not name.strip():
        raise ModelError(f"a block's name is {name!r}; it must be a text that is not empty")


def numbers(name: str, what: str, values: Any, shape: tuple[int | None, ...]) -> Array:
    """Return `values` as a read-only array of finite numbers of the given shape (None: any length)."""
    wanted = str(shape).replace("None", "n")
    try:
        array = read_only(reals(values))
    except (TypeError, ValueError):
        wrong(name, f"{what}: {reprlib.repr(values)} given; numbers of shape {wanted} are needed")
    if array.ndim != len(shape) or any(n not in (None, m) for n, m in zip(shape, array.shape, strict=True)):
        wrong(name, f"{what}: shape {array.shape} given; shape {wanted} is needed")
    sound = np.abs(array) <= _LARGEST
    if not sound.all():
        place = tuple(np.argwhere(~sound)[0].tolist())
        indices = ", ".join(map(str, place))
        wrong(name, f"{what}[{indices}] is {array[place]}; a finite number up to {_LARGEST:g} is needed")
    return array


def words(name: str, given: dict[str, Any]) -> dict[str, Any]:
    """Return the words on a block by their keys, as they are kept; raises ModelError where one is none."""
    return {key: _KINDS[key](name, key, value) for key, value in given.items()}


def _text(name: str, key: str, value: Any) -> str:
    if not isinstance(value, str):
        raise ModelError(f"block {name!r}: {key} is {value!r}; text is needed, empty for none")
    return value


def _texts(name: str, key: str, values: Any) -> tuple[str, ...]:
    if isinstance(values, str) or not all(isinstance(value, str) and value for value in values):
        raise ModelError(f"block {name!r}: {key} are {values!r}; texts that are not empty are needed")
    return tuple(dict.fromkeys(values))


def _colour(name: str, key: str, value: Any) -> str:
    text = _text(name, key, value).lower()
    if text and not _COLOUR.fullmatch(text):
        raise ModelError(f"block {name!r}: {key} is {value!r}; '#rrggbb' is needed, empty for none")
    return text


def _unit_weight(name: str, key: str, value: Any) -> float | None:
    if value is None:
        return None
    weight = real(value)
    if not 0.0 <= weight < np.inf:
        raise ModelError(f"block {name!r}: unit weight is {value!r}; a finite number >= 0 in N/m3 is needed")
    return weight


def faces_of(name: str, faces: Sequence[Sequence[int]]) -> Faces:
    """Return faces as tuples of whole numbers."""
    try:
        return tuple(tuple(operator.index(vertex) for vertex in face) for face in faces)
    except TypeError:
        wrong(name, f"faces: {reprlib.repr(faces)} given; sequences of vertex indices are needed")


_KINDS: dict[str, Callable[[str, str, Any], Any]] = {
    "unit_weight": _unit_weight,
    "layer": _text,
    "material": _text,
    "groups": _texts,
    "colour": _colour,
}
