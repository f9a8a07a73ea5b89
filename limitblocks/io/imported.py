"""Blocks from files of other programs, and what the readers of all formats share."""

from __future__ import annotations

import logging
import re
import warnings
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from copy import copy
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from limitblocks.errors import LimitBlocksError, ModelError
from limitblocks.geometry import Block
from limitblocks.geometry.twisted import Twisted
from limitblocks.io import faults, strict_json
from limitblocks.io.made import Made, left_out, made, refused
from limitblocks.io.placed import Contents, Frame, frame, upright
from limitblocks.io.solid import Solid
from limitblocks.shown import Shown, many

MOST_SOLIDS = 100_000
#: Layers, in small letters, whose blocks are supports unless the format says otherwise.
SUPPORT_LAYERS = ("support", "supports")
MOST_FACES = 1_000_000

#: Control characters, and halves of letters.
_NO_LETTER = re.compile(r"[\x00-\x1f\x7f-\x9f\ud800-\udfff]")

UnitWeight = float | Mapping[str, float] | None


@dataclass(frozen=True, repr=False)
class ImportedBlocks(Shown):
    """Blocks read from a file.

    Attributes
    ----------
    blocks : tuple of Block
        In the order of the file; names are unique.
    notes : tuple of str
        What was mended and renamed, a line each.
    supports : tuple of str
        Names of the blocks that the file says do not move: COMPAS marks them, in other formats they are on a
        layer named "support" or "supports".
    guesses : tuple of str
        What was guessed, or may not be meant: the unit of length, the axis up; a line each.
    left_out : tuple of str
        Parts of the file that are no blocks and were left out, as asked or since they are hidden or open; the
        notes say why.
    """

    blocks: tuple[Block, ...]
    notes: tuple[str, ...] = ()
    supports: tuple[str, ...] = ()
    guesses: tuple[str, ...] = ()
    left_out: tuple[str, ...] = ()

    @property
    def layers(self) -> dict[str, str]:
        """Layer, group or material of each block, by block name; empty text where the file has none."""
        return {block.name: block.layer for block in self.blocks}

    def __str__(self) -> str:
        beside = {
            "support": self.supports,
            "note": self.notes,
            "guess": self.guesses,
            "part left out": self.left_out,
        }
        plural = {"guess": "guesses", "part left out": "parts left out"}
        counts = [many(len(those), word, plural.get(word, "")) for word, those in beside.items() if those]
        return ", ".join([many(len(self.blocks), "block"), *counts])


def read_bytes(path: Path) -> bytes:
    """Return the content of the file of blocks at `path`; raises ModelError as `strict_json.plain_bytes`."""
    return strict_json.plain_bytes(path, "blocks")


def refuse_many(solids: int = 0, faces: int = 0) -> None:
    """Raise ModelError where a file has more blocks or faces than are read."""
    for number, most, word in ((solids, MOST_SOLIDS, "blocks"), (faces, MOST_FACES, "faces")):
        if number > most:
            raise ModelError(f"has {number} {word}; at most {most} are read, split the file")


def one_line(name: str) -> str:
    """Return a name as one line of text without blanks around it; what is no letter becomes U+FFFD."""
    return " ".join(_NO_LETTER.sub("\ufffd", " ".join(name.split())).split())


@contextmanager
def foreign(word: str) -> Iterator[None]:
    """Turn whatever another package does with a damaged file into one ModelError; `word` is the format."""
    try:
        with warnings.catch_warnings(), np.errstate(all="ignore"), _silent():
            warnings.simplefilter("ignore")
            yield
    except LimitBlocksError:
        raise
    except Exception as error:
        said = " ".join(str(error).split()) or "no reason given"
        raise ModelError(f"is not sound {word}: {type(error).__name__}: {said}") from None


@contextmanager
def _silent() -> Iterator[None]:
    """Keep other packages from logging; the caller gets one error."""
    before = logging.root.manager.disable
    logging.disable(logging.CRITICAL)
    try:
        yield
    finally:
        logging.disable(before)


def imported(
    contents: Contents,
    units: str | None,
    unit_weight: UnitWeight,
    up: str | None = None,
    twisted: Twisted | None = None,
    skip_bad: bool = False,
) -> ImportedBlocks:
    """Return the solids of a file as blocks with unique names, in metres, with Z up.

    Raises
    ------
    ModelError
        With all faults: solids that are no blocks, no solid, an unknown unit, axis or layer.
    """
    solids = contents.solids
    refuse_many(len(solids), sum(len(solid.faces) for solid in solids))
    if not solids and contents.wrong:
        raise refused(contents.wrong, 0)
    if not solids:
        raise ModelError("holds no solid; expected at least one block")
    where = frame(contents, units, up)
    found = blocks_of(contents, where, twisted)
    if found.wrong and (not skip_bad or not found.blocks):
        raise refused(found.wrong, len(found.blocks), found.twisted)
    weights = _weights({block.name: block.layer for block in found.blocks}, unit_weight)
    blocks = tuple(block.labelled(unit_weight=weights[block.name]) for block in found.blocks)
    notes = (*contents.notes, *found.notes, *left_out(found.wrong))
    gone = (*found.wrong, *contents.left_out)
    return ImportedBlocks(blocks, notes, found.supports, (*where.warnings, *found.warnings), gone)


def blocks_of(contents: Contents, where: Frame, twisted: Twisted | None = None) -> Made:
    """Return the solids of a file as blocks with unique names, in metres, with Z up."""
    names, renamed = unique_names([solid.name for solid in contents.solids])
    named = dict(zip(names, contents.solids, strict=True))
    found = made(named, where.metres * upright(where.up), twisted)
    supports = tuple(block.name for block in found.blocks if _is_support(named[block.name]))
    wrong = dict(contents.wrong)
    for name, lines in found.wrong.items():
        wrong[name] = [*wrong.get(name, ()), *lines]
    lost = tuple(name for name in wrong if name in named and _is_support(named[name]))
    return Made(found.blocks, (*renamed, *found.notes), wrong, supports, found.twisted, lost)


def _is_support(solid: Solid) -> bool:
    name = solid.layer.rpartition("::")[2]  # of a layer within others in Rhino
    on_layer = name.strip().lower() in SUPPORT_LAYERS
    return on_layer if solid.support is None else solid.support


def unique_names(names: Iterable[str]) -> tuple[list[str], list[str]]:
    """Return names that are unique and not empty, and a note for each name that was shared.

    The first of a name keeps it, the others get a number: "stone", "stone 2", "stone 3".
    """
    given = [one_line(name) or "block" for name in names]
    times, taken, last = Counter(given), set(given), dict.fromkeys(given, 1)
    unique = []
    for name in given:
        new = name
        if last[name] > 1:
            while (new := f"{name} {last[name]}") in taken:
                last[name] += 1
            taken.add(new)
        last[name] += 1
        unique.append(new)
    shared = [name for name, k in times.items() if k > 1]
    return unique, [
        f"{times[name]} blocks are named {name!r}; all but the first got a number" for name in shared
    ]


def plain(blocks: Iterable[Block], fixed: Sequence[bool]) -> tuple[Block, ...]:
    """Return blocks with their words as every format can have them.

    Where some of them are fixed, the layer of a block without one is support or block.
    """
    bare, made = ("block", "support") if any(fixed) else ("", ""), []
    for block, held in zip(blocks, fixed, strict=True):
        same = copy(block)
        words = {key: one_line(getattr(block, key)) for key in ("name", "layer", "material")}
        groups = tuple(filter(None, map(one_line, block.groups)))
        same.__dict__.update(words | {"layer": words["layer"] or bare[held], "groups": groups})
        made.append(same)
    return tuple(made)


def _weights(layers: Mapping[str, str], unit_weight: UnitWeight) -> dict[str, float | None]:
    """Return the unit weight of each block; None on layers without one."""
    if not isinstance(unit_weight, Mapping):
        return dict.fromkeys(layers, unit_weight)
    known = sorted(set(layers.values()))
    unknown = [layer for layer in unit_weight if layer not in known]
    if unknown:
        raise ModelError(
            *(f"unit weight of layer {layer!r}: there are layers {known[:8]}{faults.near(layer, known)}"
              for layer in unknown)
        )  # fmt: skip
    return {name: unit_weight.get(layer) for name, layer in layers.items()}
