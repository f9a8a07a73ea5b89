"""Blocks chosen by name, layer, material, pattern or place."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from fnmatch import fnmatchcase
from fractions import Fraction

from limitblocks.errors import ModelError, few, near, sequence_of
from limitblocks.geometry.block import Block
from limitblocks.shown import many

Selection = str | Iterable[str] | Callable[[Block], bool]

_WORDS = ("name", "layer", "material", "group")
_PLACE = re.compile(r"\s*([xyz])\s*([<>])=?\s*([-+0-9.eE]+)\s*")
_WILD = re.compile(r"[*?\[]")
_SHOWN = 12
ROUNDING = 1e-9  # of the size of a block and of its place: three courses of .2 m end at .6 m


def select(blocks: Sequence[Block], wanted: Selection, word: str = "selection") -> tuple[str, ...]:
    """Return the names of the blocks that are wanted, in their order.

    Parameters
    ----------
    blocks : sequence of Block
    wanted : str, iterable of str, or function of a Block
        What is true for a block that is wanted, or texts, each one of

        - the name of a block, or of a layer: "ground", "BASE";
        - "name:", "layer:", "material:" or "group:PATTERN", where * stands for any letters, ? for one;
        - a pattern alone, of names and layers: "ground*";
        - "z<0.05", "x>2": blocks with no point beyond that coordinate, m.
    word : str
        What the blocks are wanted for, in messages.

    Raises
    ------
    ModelError
        A text matches no block, or the function is true for none; the message lists what there is.
    """
    blocks = sequence_of("blocks", blocks, Block)
    if callable(wanted):
        picked = {block.name for block in blocks if wanted(block)}
        if not picked:
            raise ModelError(f"{word}: the function is true for none of {many(len(blocks), 'block')}")
    else:
        texts = [wanted] if isinstance(wanted, str) else sequence_of(word, wanted, str)
        picked, wrong = set[str](), list[str]()
        for text in texts:
            names = _matching(blocks, text)
            picked.update(names)
            wrong += [] if names else [f"{word} {text!r} {_why_none(blocks, text)}"]
        if wrong:
            raise ModelError(*wrong)
    return tuple(block.name for block in blocks if block.name in picked)


def in_metres(text: str, metre: Fraction) -> str:
    """Return a text with the coordinate of a place, "z<500" in mm, in m; any other text as it is."""
    place = _PLACE.fullmatch(text)
    if not place:
        return text
    return f"{place[1]}{place[2]}{float(Fraction(_number(place[3], text)) * metre)!r}"


def matches(pattern: str, text: str) -> bool:
    """Return whether `text` is `pattern`, or matches it, in the same letters."""
    return pattern == text or fnmatchcase(text, pattern)


def listed(blocks: Sequence[Block]) -> str:
    """Return what blocks can be chosen by: layers, materials and groups with numbers of blocks, and names."""
    parts = []
    for word in _WORDS[1:]:
        counts = Counter(one for block in blocks for one in _said(block, word))
        counts.pop("", None)
        if counts:
            some = [f"{name!r} ({number})" for name, number in counts.most_common()]
            parts.append(f"{word}s {few(some, _SHOWN)}")
    return "; ".join([*parts, f"blocks {few([repr(block.name) for block in blocks], _SHOWN)}"])


def _said(block: Block, word: str) -> tuple[str, ...]:
    """Return the words of a kind that a block has."""
    return tuple(block.groups) if word == "group" else (getattr(block, word),)


def _matching(blocks: Sequence[Block], text: str) -> list[str]:
    exact = [block.name for block in blocks if text in (block.name, block.layer)]
    if exact:
        return exact if text else []
    word, _, pattern = text.partition(":")
    if word in _WORDS and pattern:
        return [b.name for b in blocks if any(matches(pattern, one) for one in _said(b, word))]
    place = _PLACE.fullmatch(text)
    if place:
        axis, sign, bound = "xyz".index(place[1]), place[2], _number(place[3], text)
        return [block.name for block in blocks if _within(block, axis, sign, bound)]
    if not _WILD.search(text):
        return []
    return [b.name for b in blocks if fnmatchcase(b.name, text) or fnmatchcase(b.layer, text)]


def _number(text: str, whole: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise ModelError(f"{whole!r} has no number after its sign; expected as in 'z<0.05'") from None


def _within(block: Block, axis: int, sign: str, bound: float) -> bool:
    coordinates, slack = block.vertices[:, axis], ROUNDING * (block.size + abs(bound))
    return bool(coordinates.max() <= bound + slack if sign == "<" else coordinates.min() >= bound - slack)


def _why_none(blocks: Sequence[Block], text: str) -> str:
    """Return why no block matches, and what would."""
    place = _PLACE.fullmatch(text)
    if place:
        axis, below = "xyz".index(place[1]), place[2] == "<"
        ends = [(b.vertices[:, axis].max() if below else b.vertices[:, axis].min(), b.name) for b in blocks]
        nearest = (sorted(ends) if below else sorted(ends, reverse=True))[:3]
        some = ", ".join(f"{name!r} {end:.4g}" for end, name in nearest)
        return f"matches no block: {'tops' if below else 'bottoms'} along {place[1]} (m): {some}"
    word, _, pattern = text.partition(":")
    if word in _WORDS and pattern:
        known = {one for block in blocks for one in _said(block, word)} - {""}
        return f"matches no {word}{near(pattern, known)}; there are {listed(blocks)}"
    if _WILD.search(text):
        return f"matches no name and no layer; there are {listed(blocks)}"
    known = {block.name for block in blocks} | {block.layer for block in blocks} - {""}
    return f"is neither a block nor a layer{near(text, known)}; there are {listed(blocks)}"
