"""What a file does not say: the unit of length, and which axis points up."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import shapely

from limitblocks.arrays import Array
from limitblocks.geometry import Block
from limitblocks.geometry.accuracy import COARSEST, millimetres
from limitblocks.geometry.neighbours import bounds_of
from limitblocks.shown import many

#: Words for blocks that do not move, in names and layers: parts of words, and whole words with their plurals.
SUPPORT_WORDS = re.compile(
    "support|ground|found|footing|plinth|abutment|fixed|anchor"  # English
    "|appogg|fondaz|basament|incastr"  # Italian
    "|apoyo|cimiento|cimentaci|soporte|empotra|zapata|estribo"  # Spanish
    "|apoio|funda[cç]|alicerce|suporte|sapata"  # Portuguese
    "|appui|fondation|soubassement|semelle|cul[ée]e|encastr"  # French
    "|auflager|fundament|widerlager|gründung|gruendung"  # German
    r"|(?<![^\W\d_])(base|bases|sol|suolo|suelo|terreno|terrain|spalla|spalle|socle|sockel|boden)(?![^\W\d_])",
    re.IGNORECASE,
)
#: Size, m, beyond which a structure is hardly in metres: the longest masonry bridge spans and naves are less.
LARGE = 300.0
#: Median length of the blocks, m, beyond which they are hardly in metres: only single stones are longer.
_LONG = 10.0
#: Length of a block, m, that a guess of the unit comes closest to.
_BLOCK = 0.4
_CANDIDATES = {"cm": 0.01, "mm": 0.001}  # metres per unit
_MOST_PAIRS = 1_000_000  # of blocks one above the other, of which a share is looked at beyond
_FEWEST = 4  # blocks that tell which way is up where no support is named
_ALL, _MOST, _HALF = 0.98, 0.9, 0.5
_ENOUGH = 1.5  # shares on the ground and carried: all of a wall lies there, half of a table stands
_LOWER, _UPPER = 0.49, 0.51  # of the height: between is the middle of a support as long as the structure


class Boxes(NamedTuple):
    """Bounding boxes of n solids, (n, 3) each, and which are supports by their names."""

    low: Array
    high: Array
    support: Array

    @classmethod
    def of(cls, vertices: Sequence[Array], words: Sequence[tuple[str, str]]) -> Boxes:
        """Return the boxes of solids with these vertices, and (name, layer)."""
        named = [any(SUPPORT_WORDS.search(word) for word in pair) for pair in words]
        return cls(*bounds_of(vertices), np.array(named))

    @property
    def size(self) -> float:
        """Largest dimension of all."""
        return float((self.high.max(axis=0) - self.low.min(axis=0)).max())

    @property
    def length(self) -> float:
        """Median of the longest dimension of a solid."""
        return float(np.median((self.high - self.low).max(axis=1)))


def unit(boxes: Boxes) -> tuple[str, str] | None:
    """Return the unit that solids too large for metres are taken in, and a sentence on it; else None.

    Too large is a structure; where its blocks alone are, metres stay, and the sentence asks.
    """
    if not boxes.size < 1e30 or (boxes.size <= LARGE and boxes.length <= _LONG):
        return None
    name = _likeliest(boxes)
    size, length = boxes.size * _CANDIDATES[name], boxes.length * _CANDIDATES[name]
    if boxes.size <= LARGE:
        return "m", (
            f"states no unit of length: taken as m, it is {boxes.size:.4g} m large with blocks of "
            f"{boxes.length:.4g} m, in {name} {size:.4g} m with blocks of {length:.2g} m; say units (--units)"
        )
    return name, (
        f"states no unit of length and is {boxes.size:.4g} units large: taken as {name}, {size:.4g} m large "
        f"with blocks of {length:.2g} m; say units={name!r} (--units {name}), or what it is in"
    )


def of_stated(boxes: Boxes, metres: float) -> str:
    """Return the question about blocks that are hardly so long in the unit, `metres` m, which a file states.

    A structure too large as a whole is asked about where the model is.
    """
    length = metres * boxes.length
    if length <= _LONG or metres * boxes.size > LARGE:
        return ""
    name = _likeliest(boxes)
    if _CANDIDATES[name] >= metres:
        return ""
    return (
        f"states a unit of {metres:g} m, in which its blocks are {length:.4g} m long (median), in {name} "
        f"{_CANDIDATES[name] * boxes.length:.2g} m: if it is in {name}, say units={name!r} (--units {name})"
    )


def of_single_precision(bodies: Sequence[Array], length: float, metres: float) -> str:
    """Return the warning of coordinates in single precision too far from the origin for blocks of a `length`.

    Single precision has 24 binary digits (IEEE 754-2019, Table 3.5), of which coordinates that are drawn on a
    grid leave the last ones 0. `bodies` have vertices (n, 3), in units of `metres` m.
    """
    points = np.concatenate(bodies)
    steps = np.spacing(np.abs(points).astype(np.float32)).astype(np.float64)
    coarsest = steps == steps.max()
    step = float(steps.max())
    rounded = (points.astype(np.float32) == points).all() and (points[coarsest] % (2.0 * step) != 0.0).any()
    if not rounded or step / np.sqrt(12.0) <= COARSEST * length:  # the standard deviation of what is rounded
        return ""
    return (
        f"has coordinates in single precision, which go in steps of {millimetres(metres * step)} "
        f"{metres * np.abs(points).max():.3g} m from the origin, for blocks {metres * length:.3g} m long: "
        "the load factor may be off by more than 1 %; move the structure to the origin in the program that "
        "wrote it, and write it again"
    )


def _likeliest(boxes: Boxes) -> str:
    """Return the unit, other than m, in which blocks are nearest to their usual length."""
    far = {name: abs(np.log(boxes.length * metres / _BLOCK)) for name, metres in _CANDIDATES.items()}
    return min(far, key=lambda one: far[one])


def tilted(boxes: Boxes, up: str) -> str:
    """Return why the other of the axes Y and Z points up rather than `up`, or nothing where it does not.

    Masonry rests on what lies below it. A structure whose blocks mostly lie on the ground although the other
    axis stacks them, whose blocks hang over nothing although the other axis carries them all, or whose
    supports are at the bottom of the other axis only, lies on its side.
    """
    if not np.isfinite(boxes.size):
        return ""
    a, b = (1, 2) if up == "y" else (2, 1)
    this, other = "XYZ"[a], "XYZ"[b]
    if _on_side(boxes, a, b):
        return f"the blocks whose names say support are at the bottom along {other}, not along {this}"
    if len(boxes.low) < _FEWEST or _stand(boxes, a, b):
        return ""
    ground, carried = _shares(boxes, a)
    ground_b, carried_b = _shares(boxes, b)
    n = len(boxes.low)
    if ground >= _HALF and ground_b <= ground / 2.0 and ground + carried_b >= _ENOUGH:
        return (
            f"{round(ground * n)} of {many(n, 'block')} would lie on the ground with {this} up, "
            f"{round(ground_b * n)} with {other} up"
        )
    if carried <= _MOST and ground_b <= _HALF and carried_b >= _ALL:
        return (
            f"{round((1.0 - carried) * n)} of {many(n, 'block')} would have nothing below with {this} up, "
            f"{round((1.0 - carried_b) * n)} with {other} up"
        )
    return ""


def on_side(blocks: Sequence[Block], supports: Sequence[str]) -> list[str]:
    """Return the question about blocks whose `supports`, as chosen, are at the bottom along Y alone."""
    named = np.array([block.name in supports for block in blocks])
    if not _on_side(Boxes(*bounds_of([block.vertices for block in blocks]), named), 2, 1):
        return []
    return [
        "seems to lie on its side: the supports are at the bottom along Y, not along Z; if so, say which "
        "axis of the file points up (up, --up)"
    ]


def _on_side(boxes: Boxes, a: int, b: int) -> bool:
    """Return whether the supports are at the bottom along the axis `b`, and not along `a`.

    Those as high as the structure, and those of few blocks, may be a wall that stones jut out of: only if
    all stand on each other along `a` as well do they tell.
    """
    if not boxes.support.any() or not _at_bottom(boxes, b) or _at_bottom(boxes, a, _LOWER):
        return False
    told = len(boxes.low) >= _FEWEST and not _at_bottom(boxes, a, _UPPER)
    return told or _shares(boxes, a)[1] >= _ALL


def _stand(boxes: Boxes, a: int, b: int) -> bool:
    """Return whether all supports are in the lower half along `a`, and some above it along `b`."""
    return bool(boxes.support.any()) and _at_bottom(boxes, a, _UPPER) and not _at_bottom(boxes, b, _UPPER)


def _at_bottom(boxes: Boxes, axis: int, share: float = 1.0 / 3.0) -> bool:
    """Return whether the centres of all supports are in the lowest share of the height along `axis`."""
    low, high = boxes.low[:, axis], boxes.high[:, axis]
    middle = (low + high)[boxes.support] / 2.0
    return bool((middle <= low.min() + share * (high.max() - low.min())).all())


def _shares(boxes: Boxes, axis: int) -> tuple[float, float]:
    """Return the share of blocks on the ground, and of those there or on another one, with `axis` up."""
    low, high, _ = boxes
    plan = [k for k in range(3) if k != axis]
    tolerance = 0.05 * boxes.length
    ground = low[:, axis] <= low[:, axis].min() + tolerance
    shapes = shapely.box(low[:, plan[0]], low[:, plan[1]], high[:, plan[0]], high[:, plan[1]])
    n = len(shapes)
    asked = np.unique(np.linspace(0, n - 1, min(n, max(50, _MOST_PAIRS // n))).astype(int))
    k, j = shapely.STRtree(shapes).query(shapes[asked])
    i = asked[k]
    sides = np.minimum(high[i], high[j]) - np.maximum(low[i], low[j])
    area = (high - low)[:, plan].prod(axis=1)
    over = sides[:, plan].clip(0.0).prod(axis=1) > 0.01 * area[i]
    below = (low[j, axis] < low[i, axis] - tolerance) & (high[j, axis] >= low[i, axis] - tolerance)
    carried = ground.copy()
    carried[i[over & below]] = True
    return float(ground.mean()), float(carried[asked].mean())
