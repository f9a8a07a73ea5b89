"""Vectors on the command line: `--live 1,0,0` and `--live 1 0 0` are the same, in every command."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import Any

import typer
from typer.core import TyperCommand

_NUMBERS = re.compile(r"[A-Z]+(,[A-Z]+)+")  # metavar of an option whose value is so many numbers


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


class Command(TyperCommand):
    """A command that takes vectors and other tuples of numbers with blanks between them, too."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Join the numbers that follow the name of a vector option, then go on as usual."""
        numbers = {
            name: param.metavar.count(",") + 1
            for param in self.params
            if param.metavar and _NUMBERS.fullmatch(param.metavar)
            for name in param.opts
        }
        return super().parse_args(ctx, list(_joined(args, numbers)))


def _joined(args: list[str], lengths: dict[str, int]) -> Iterator[str]:
    rest = iter(range(len(args)))
    for k in rest:
        yield args[k]
        numbers = args[k + 1 : k + 1 + lengths.get(args[k], 0)]
        if len(numbers) > 1 and all(map(_is_number, numbers)):
            yield ",".join(numbers)
            for _ in numbers:
                next(rest)


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
