"""A drawing as lines, polygons and texts, for an SVG or a page of print; y runs downwards."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import NamedTuple

from limitblocks.arrays import Array

WIDTH = 1000.0  # user units of every sheet


class Shape(NamedTuple):
    """SVG path of straight lines, polygons ending in z, and its style: a shade f0 to f3, or a name."""

    path: str
    style: str = ""


class Group(NamedTuple):
    """Shapes of one thing: its style, its name, empty where there is nothing to say."""

    style: str
    name: str
    shapes: tuple[Shape, ...]


class Label(NamedTuple):
    """Text at a place; style begins with start, middle or end, which says what of it is there."""

    x: float
    y: float
    text: str
    style: str = "middle"
    upwards: bool = False


class Dot(NamedTuple):
    """Place of a value, and what it is."""

    x: float
    y: float
    text: str


@dataclass(frozen=True)
class Sheet:
    """Drawing in a view box of 1000 by `height`.

    Attributes
    ----------
    style : str
        Kind of drawing.
    title, text : str
        What it shows, and the same for those who do not see it.
    """

    style: str
    title: str
    text: str
    height: float
    groups: tuple[Group, ...] = ()
    labels: tuple[Label, ...] = ()
    dots: tuple[Dot, ...] = ()


def path(points: Array, *, closed: bool = True) -> str:
    """Return the SVG path through `points` (n, 2), in user units."""
    places = " ".join(f"{x:.1f},{y:.1f}".replace(".0", "") for x, y in points.tolist())
    return f"M{places}" + "z" * closed


def polylines(path: str) -> Iterable[tuple[list[float], bool]]:
    """Yield the vertices x, y, x, y, ... of each line of an SVG path, and whether it is closed."""
    for one in re.findall(r"M[^M]*", path):
        yield [float(number) for number in re.findall(r"-?[\d.]+", one)], one.endswith("z")
