"""Vectors on the command line: `--live 1,0,0` and `--live 1 0 0` are the same, in every command.

So are places of blocks: `--anchor wall,1,0,0`, `--anchor wall 1,0,0` and `--anchor wall 1 0 0`.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import Any

import typer
from typer.core import TyperCommand

_NUMBERS = re.compile(r"[A-Z]+(,[A-Z]+)+")  # metavar of an option whose value is so many numbers
_PLACE = "BLOCK,X,Y,Z"  # metavar of one whose value is a name, then numbers


class Vector:
    """Parser of an option whose value is finite numbers, one for each of `names`."""

    def __init__(self, *names: str) -> None:
        self.names = names
        self.__name__ = ",".join(names)

    def __call__(self, given: str | Sequence[float]) -> tuple[float, ...]:
        """Return the numbers; typer names the option in front of what is wrong."""
        if not isinstance(given, str):
            return tuple(given)
        words = given.replace(",", " ").split()
        if len(words) != len(self.names) or not all(map(_is_number, words)):
            raise typer.BadParameter(f"{given!r}: expected {len(self.names)} numbers, {self.__name__}")
        return tuple(map(float, words))


def vector(*declared: str, names: str, **settings: Any) -> Any:
    """Return the option `declared` whose value is a :class:`Vector` of `names`, such as "X,Y,Z"."""
    return typer.Option(*declared, parser=Vector(*names.split(",")), metavar=names, **settings)


class Place(Vector):
    """Parser of an option whose value is a block and a point of it."""

    def __init__(self) -> None:
        super().__init__("X", "Y", "Z")
        self.__name__ = _PLACE

    def __call__(self, given: Any) -> Any:
        """Return the name of the block and the point."""
        block, *words = given.rsplit(",", 3)
        try:
            return block, super().__call__(",".join(words))
        except typer.BadParameter:
            raise typer.BadParameter(f"{given!r}: expected a block and 3 numbers, {_PLACE}") from None


def places(declared: str, **settings: Any) -> Any:
    """Return the option `declared`, to be repeated, each of whose values is a block and a point of it."""
    return typer.Option(declared, parser=Place(), metavar=_PLACE, **settings)


class Command(TyperCommand):
    """A command that takes vectors and other tuples of numbers with blanks between them, too."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Join the numbers that follow the name of a vector option, then go on as usual."""
        numbers = {
            name: (int(param.metavar == _PLACE), param.metavar.replace("BLOCK,", "").count(",") + 1)
            for param in self.params
            if param.metavar and _NUMBERS.fullmatch(param.metavar)
            for name in param.opts
        }
        return super().parse_args(ctx, list(_joined(args, numbers)))


def _joined(args: list[str], lengths: dict[str, tuple[int, int]]) -> Iterator[str]:
    """The arguments; those of an option of so many names and numbers as one."""
    rest = iter(range(len(args)))
    for k in rest:
        yield args[k]
        named, count = lengths.get(args[k], (0, 0))
        first = k + 1 + named
        for end in (first + 1, first + count):
            numbers = ",".join(args[first:end]).split(",")
            if len(numbers) == count and all(map(_is_number, numbers)):
                yield ",".join(args[k + 1 : end])
                for _ in range(k + 1, end):
                    next(rest)
                break


def _is_number(word: str) -> bool:
    try:
        return abs(float(word)) < float("inf")
    except ValueError:
        return False


def numbers(option: str, words: str) -> tuple[float, ...]:
    """Return the numbers that an option gives, with commas or blanks between them."""
    try:
        return tuple(float(word) for word in words.replace(",", " ").split())
    except ValueError:
        raise typer.BadParameter(f"{words!r}: expected numbers such as 0,1.2", param_hint=option) from None
