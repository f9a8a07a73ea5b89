"""What all structures share: prisms, boxes in a row, and the model of blocks that rest on supports."""

from __future__ import annotations

import inspect
import reprlib
from collections.abc import Callable, Iterable, Sequence
from functools import wraps
from typing import Any, ParamSpec, TypeVar

import numpy as np
import numpy.typing as npt

from limitblocks.arrays import real
from limitblocks.errors import ModelError, near
from limitblocks.geometry import Block, find_interfaces
from limitblocks.joints import Joint
from limitblocks.mechanics import Load
from limitblocks.mechanics.loads import mass_proportional, self_weight
from limitblocks.model import Model

UNIT_WEIGHT = 20e3  # N/m3, stone masonry
HORIZONTAL = (1.0, 0.0, 0.0)
#: Sizes of a number that is not zero, and most stones of one kind.
_LEAST, _LARGEST, _MOST = 1e-30, 1e30, 100_000
_WANTED = {
    "float": f"a number, between {_LEAST:g} and {_LARGEST:g} in size",
    "int": f"a whole number up to {_MOST}",
    "bool": "True or False",
}
_PLAIN: dict[str, Callable[[Any], float]] = {"float": float, "int": int, "bool": bool}
_P = ParamSpec("_P")
_Record = TypeVar("_Record")


def plain_numbers(make: Callable[_P, Model]) -> Callable[_P, Model]:
    """Give the maker of a structure its arguments, numbers as plain floats and ints, or raise ModelError.

    Rounded to single precision, the same number would leave gaps between the blocks.
    """
    signature = inspect.signature(make)
    parameters = signature.parameters
    kinds = {name: one.annotation.removesuffix(" | None") for name, one in parameters.items()}

    @wraps(make)
    def made(*args: _P.args, **kwargs: _P.kwargs) -> Model:
        given = _bound(make.__name__, signature, *args, **kwargs)
        asked = {
            name: value
            for name, value in given.arguments.items()
            if kinds[name] in _WANTED and not (value is None and parameters[name].default is None)
        }
        refuse(
            f"{name.replace('_', ' ')} is {reprlib.repr(value)}, expected {_WANTED[kinds[name]]}"
            for name, value in asked.items()
            if not _sound(kinds[name], value)
        )
        given.arguments |= {name: _PLAIN[kinds[name]](value) for name, value in asked.items()}
        return make(*given.args, **given.kwargs)

    return made


def _bound(name: str, signature: inspect.Signature, /, *args: Any, **kwargs: Any) -> inspect.BoundArguments:
    """Return arguments by their names, or raise ModelError naming those that the maker does not have."""
    try:
        return signature.bind(*args, **kwargs)
    except TypeError as error:
        own, rest = signature.parameters, [*signature.parameters][len(args) :]
        refuse(f"{name} has no argument {key!r}{near(key, own.keys() - kwargs)}"
               for key in kwargs if key not in own)  # fmt: skip
        missing = (key for key in rest if own[key].default is own[key].empty and key not in kwargs)
        refuse(f"{name} needs {key!r}" for key in missing)
        raise ModelError(f"{name}: {error}") from None


def _sound(kind: str, value: Any) -> bool:
    """Whether a value is a number of a kind; NaN and infinities are, which each structure refuses itself."""
    if kind == "bool":
        return isinstance(value, bool | np.bool_)
    size = abs(real(value))
    if kind == "int":
        return isinstance(value, int | np.integer) and size <= _MOST
    undefined = isinstance(value, float) and not np.isfinite(value)
    return undefined or size == 0.0 or _LEAST <= size < _LARGEST


def record(kind: Callable[..., _Record], value: Any) -> _Record:
    """Return `value` as a named tuple, or raise ModelError."""
    try:
        return kind(*value)
    except TypeError:
        wanted = f"{kind.__name__}({', '.join(kind._fields)})"  # type: ignore[attr-defined] # a named tuple
        raise ModelError(f"{kind.__name__.lower()} is {value!r}, expected {wanted}") from None


def model_of(
    blocks: Sequence[Block],
    supports: Sequence[Block],
    joint: Joint | Callable[[Block, Block], Joint],
    direction: Sequence[float],
    name: str,
    extra: tuple[Load, Load] = (Load(), Load()),
) -> Model:
    """Model under self weight and a mass-proportional live load along `direction`.

    `joint` may be a law that gives the joint of two blocks. `extra` is added to the dead and the live load.
    """
    everything = [*supports, *blocks]
    return Model(
        blocks=everything,
        supports=[support.name for support in supports],
        interfaces=find_interfaces(everything, joint),
        dead=self_weight() + extra[0],
        live=mass_proportional(direction) + extra[1],
        name=name,
    )


def prism(
    name: str, outline: npt.ArrayLike, depth: float, unit_weight: float | None = None, at: float = 0.0
) -> Block:
    """Prism along Y about y = `at` of a convex outline (n, 2) in X and Z, counter-clockwise seen from -Y."""
    return Block.prism(name, outline, (at - depth / 2, at + depth / 2), unit_weight)


def span_box(
    name: str, x: Sequence[float], y: Sequence[float], z: Sequence[float], unit_weight: float | None = None
) -> Block:
    """Box between two values of each coordinate, m."""
    low, high = np.column_stack([x, y, z])
    return Block.box(name, size=high - low, at=(low + high) / 2, unit_weight=unit_weight)


def pier(
    name: str, x: Sequence[float], y: Sequence[float], count: int, height: float, unit_weight: float
) -> list[Block]:
    """Single blocks on top of one another from z = 0, each of `height`, m."""
    return [
        span_box(f"{name} {k + 1}", x, y, (k * height, (k + 1) * height), unit_weight) for k in range(count)
    ]


def base(x: Sequence[float], y: Sequence[float], depth: float, name: str = "base") -> Block:
    """Support below z = 0 under a rectangle, m."""
    return span_box(name, x, y, (-depth, 0.0))


def refuse_not_positive(**values: Any) -> None:
    """Raise ModelError naming all `values` that are not finite and positive."""
    refuse(f"{name.replace('_', ' ')} is {value!r}, expected a number > 0"
           for name, value in values.items()
           if not (isinstance(value, int | float | np.number) and 0.0 < value < np.inf))  # fmt: skip


def refuse_fewer(least: int, **counts: Any) -> None:
    """Raise ModelError naming all `counts` that are not whole numbers of at least `least`, or too many."""
    refuse(f"{name.replace('_', ' ')} is {reprlib.repr(count)}, expected a whole number of at least {least}"
           f"{f' and at most {_MOST}' * (real(count) > _MOST)}"
           for name, count in counts.items()
           if not (_sound("int", count) and not isinstance(count, bool) and count >= least))  # fmt: skip


def refuse_many(stone: float, **lengths: float) -> None:
    """Raise ModelError naming all `lengths`, m, in which there are too many stones of a length."""
    refuse(f"{name.replace('_', ' ')} is {value!r}, expected at most {_MOST} stones of {stone:g} m"
           for name, value in lengths.items() if value > _MOST * stone)  # fmt: skip


def refuse(problems: Iterable[str]) -> None:
    """Raise ModelError if there are problems."""
    faults = tuple(problems)
    if faults:
        raise ModelError(*faults)
