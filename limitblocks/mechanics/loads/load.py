"""A load: a sum of terms, each with a factor."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Protocol

import numpy as np

from limitblocks.arrays import Array, as_typed, real, reals_if_any
from limitblocks.errors import ModelError, few, near, sequence_of
from limitblocks.geometry import Block

_LEVEL = 1e-9  # rise of a unit vector that counts as horizontal
_LARGEST = 1e30  # as in a model file: its powers are still numbers
Vector = tuple[float, float, float]
Place = tuple[float, float]


class Term(Protocol):
    """What a load adds up: a frozen dataclass of plain numbers and names, as the model file writes it."""

    __dataclass_fields__: ClassVar[dict[str, Any]]

    def on(self, blocks: Sequence[Block]) -> Array:
        """Return forces (N) and moments (N m) at the centroids of `blocks`, global axes, shape (n, 6)."""

    def in_words(self) -> str:
        """Return the term as an engineer would say it, with units."""


CANCELLED = 1e-12  # of the forces of a load: a sum below it is what rounding leaves of them


@dataclass(frozen=True)
class Load:
    """A sum of load terms, each with a factor. Loads add up, and a number times a load is one."""

    terms: tuple[tuple[float, Term], ...] = ()

    def __add__(self, other: Load) -> Load:
        if not isinstance(other, Load):
            raise ModelError(
                f"{other!r} cannot be added to a load; masses go into self_weight([mass]) and "
                "mass_proportional(direction, [mass])"
            )
        return Load(self.terms + other.terms)

    def __radd__(self, other: Any) -> Load:
        return self if other == 0 else self + other  # sum() begins with 0

    def __mul__(self, factor: float) -> Load:
        times = number(factor, "factor of a load", "")
        return Load(tuple((times * own, term) for own, term in self.terms))

    __rmul__ = __mul__

    def __truediv__(self, divisor: float) -> Load:
        by = number(divisor, "divisor of a load", "")
        if by == 0.0:
            raise ModelError("divisor of a load is 0, expected any other number")
        return Load(tuple((own / by, term) for own, term in self.terms))

    def __neg__(self) -> Load:
        return -1.0 * self

    def __sub__(self, other: Any) -> Load:
        return self + (-other if isinstance(other, Load) else other)

    def on(self, blocks: Sequence[Block]) -> Array:
        """Return forces (N) and moments (N m) at the centroids of `blocks`, global axes, shape (n, 6).

        Raises
        ------
        ModelError
            If a term names a block that is not in `blocks` or does not meet them, or a block has no unit
            weight.
        """
        return sum((factor * term.on(blocks) for factor, term in self.terms), np.zeros((len(blocks), 6)))


def of(*terms: Term) -> Load:
    """Return the load of these terms, each with factor one."""
    return Load(tuple((1.0, term) for term in terms))


def resultant(load: Load, blocks: Sequence[Block]) -> Array:
    """Return the sum of the forces of a load on `blocks`, N, (3,): 0 where they cancel but for rounding."""
    parts = [factor * term.on(blocks)[:, :3] for factor, term in load.terms]
    total = sum((part.sum(axis=0) for part in parts), np.zeros(3))
    size = sum(float(np.abs(part).sum()) for part in parts)
    return np.where(np.abs(total) > CANCELLED * size, total, 0.0)


def vector(values: Sequence[float], word: str) -> Vector:
    """Return `values` as three floats; ModelError where they are not three finite numbers."""
    x, y, z = _numbers(values, word, 3, "three")
    return x, y, z


def place(values: Sequence[float], word: str) -> Place:
    """Return `values` as two floats; ModelError where they are not two finite numbers."""
    x, y = _numbers(values, word, 2, "two")
    return x, y


def unit_vector(values: Sequence[float], word: str) -> Vector:
    """Return `values` brought to unit length; ModelError where that cannot be."""
    x, y, z = vector(values, word)
    length = float(np.linalg.norm((x, y, z)))
    if length == 0.0:
        raise ModelError(f"{word} is (0, 0, 0), expected a non-zero vector")
    return x / length, y / length, z / length


def horizontal(values: Sequence[float], word: str) -> Vector:
    """Return a horizontal direction brought to unit length; ModelError where it rises or cannot be."""
    x, y, z = unit_vector(values, word)
    if abs(z) > _LEVEL:
        raise ModelError(f"{word} is {(*map(float, values),)}, expected a horizontal direction, (x, y, 0)")
    return x, y, 0.0


def number(
    value: float,
    word: str,
    unit: str,
    *,
    least: float = -np.inf,
    above: float = -np.inf,
    most: float = np.inf,
) -> float:
    """Return `value` as a float; ModelError where it is not finite, too small or too large."""
    given = real(value)
    if np.isfinite(given) and most >= given >= least and given > above:
        return given
    wanted = f" > {above:g}" if above > -np.inf else f" >= {least:g}" if least > -np.inf else ""
    wanted += f" and <= {most:g}" if most < np.inf else ""
    short = float(f"{given:.12g}")  # -1.962, not -1.9620000000000002
    shown = short if abs(given - short) > 0.0 else value
    raise ModelError(f"{word} is {as_typed(shown)}, expected a finite number{wanted}{unit and f' in {unit}'}")


def along(direction: Sequence[float]) -> str:
    """Return a direction as text: +X, -Y, downwards, or its components."""
    named = {(0.0, 0.0, -1.0): "downwards", (0.0, 0.0, 1.0): "upwards"}
    named |= {(s, 0.0, 0.0): f"along {w}X" for s, w in ((1.0, "+"), (-1.0, "-"))}
    named |= {(0.0, s, 0.0): f"along {w}Y" for s, w in ((1.0, "+"), (-1.0, "-"))}
    x, y, z = (round(float(part), 9) + 0.0 for part in direction)
    return named.get((x, y, z), f"along {triple(direction)}")


def triple(values: Sequence[float], size: float = 1.0) -> str:
    """Return numbers as text, in units of `size`: (0, 1.5, -2)."""
    return f"({', '.join(f'{value / size + 0.0:.4g}' for value in values)})"


def some(names: Sequence[str]) -> str:
    """Return the first of some names of blocks as text."""
    return f"block{'s' * (len(names) > 1)} {few([*map(repr, names)])}"


def names_of(blocks: str | Sequence[str]) -> tuple[str, ...]:
    """Return the names of one or more blocks; ModelError where they are none."""
    return (blocks,) if isinstance(blocks, str) else sequence_of("blocks", blocks, str)


def keep(term: object, **values: float) -> None:
    """Keep numbers as floats in a frozen term, as the model file gives them back."""
    for name, value in values.items():
        object.__setattr__(term, name, value)


def position(name: str, blocks: Sequence[Block]) -> int:
    """Return where the block named `name` is in `blocks`; ModelError where it is not."""
    for k, block in enumerate(blocks):
        if block.name == name:
            return k
    like = near(str(name), (block.name for block in blocks))
    raise ModelError(f"a load names block {name!r}, which is not a free block of the model{like}")


def _numbers(values: Sequence[float], word: str, count: int, said: str) -> list[float]:
    array = reals_if_any(values)
    if array.shape != (count,) or not (np.abs(array) < _LARGEST).all():
        raise ModelError(
            f"{word} is {as_typed(values)}, expected {said} finite numbers < {_LARGEST:g} in size"
        )
    numbers: list[float] = array.tolist()
    return numbers
