"""The model in the words of an engineer: joints, loads, acceleration."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal
from inspect import getdoc
from typing import Any

import numpy as np

from limitblocks.arrays import Array
from limitblocks.errors import few
from limitblocks.mechanics import Load
from limitblocks.mechanics.loads import AddedMass, MassProportional, PointForce
from limitblocks.mechanics.loads.forces import left_still
from limitblocks.mechanics.loads.load import along, resultant, triple
from limitblocks.model import Model
from limitblocks.shown import many
from limitblocks.units import gravity

MOST_FORCES = 8  # listed one by one
_NUMBER = re.compile(r"(?<![\w.'])-?\d+(?:\.\d+)?(?:e[+-]?\d+)?(?![\w.])")
_OF_BLOCK = re.compile(r"block ('.*?'): (.*)")


def joint_words(joint: Any) -> str:
    """Return a joint in words; one of somebody else's by its name and settings."""
    said = getattr(joint, "in_words", None)
    return str(said()) if said else repr(joint)


def assumed(joint: Any) -> tuple[str, ...]:
    """Return what a joint assumes, a sentence each; of a joint that does not say, what it is."""
    said = getattr(joint, "assumed", None)
    sentences = tuple(said()) if said else ()
    summary = " ".join((getdoc(type(joint)) or "").split("\n\n")[0].replace("`", "").split())
    return sentences or ((summary,) if summary else ())


def load_words(load: Load, weighs: Mapping[str, float] | None = None) -> list[str]:
    """Return a line a term, with its factor where that is not one; many forces are one line.

    That says which part of what `weighs` on their blocks they are, N by the name of the block.
    """
    forces = [term for term in load.terms if isinstance(term[1], PointForce)]
    if len(forces) > MOST_FORCES:
        rest = Load(tuple(term for term in load.terms if not isinstance(term[1], PointForce)))
        return [*load_words(rest), _as_one(forces, weighs or {})]
    return [
        f"{factor:g} × {one.in_words()}" if factor != 1.0 else one.in_words() for factor, one in load.terms
    ]


def laid_on(model: Model) -> dict[str, float]:
    """What the dead load weighs on each free block, N, beside masses, which have an inertia of their own."""
    masses = MassProportional | AddedMass
    laid = Load(tuple(term for term in model.dead.terms if not isinstance(term[1], masses)))
    down = -laid.on(model.free_blocks)[:, 2]
    return {block.name: float(weight) for block, weight in zip(model.free_blocks, down, strict=True)}


def _as_one(forces: Sequence[tuple[float, Any]], weighs: Mapping[str, float]) -> str:
    """Forces in one line."""
    pushed: dict[str, Array] = {}
    for factor, one in forces:
        pushed[one.block] = pushed.get(one.block, np.zeros(3)) + factor * np.array(one.force)
    total = sum(pushed.values(), np.zeros(3))
    size = float(np.linalg.norm(total))
    said = f"{len(forces)} forces on {many(len(pushed), 'block')}"
    if not size:
        return f"{said} without a resultant"
    said += f", {size / 1e3:.4g} kN {along((total / size).tolist())}"
    down = np.array([weighs.get(name, 0.0) for name in pushed])
    if (down <= 0.0).any():
        return said
    alike = np.allclose(list(pushed.values()), np.outer(down / down.sum(), total), atol=1e-9 * size)
    part = f": {size / down.sum():.4g} × what weighs on them in the dead load, as the inertia of fill"
    return said + part * alike


def resultant_words(model: Model, load: Load) -> str:
    """Return the sum of the forces on the free blocks as text."""
    force = resultant(load, model.free_blocks)
    size = float(np.linalg.norm(force))
    if size == 0.0:
        return "no resultant force"
    way, parts = (force / size).tolist(), force.tolist()
    return f"{size / 1e3:.4g} kN {along(way)}, components {triple(parts, 1e3)} kN"


def acceleration(model: Model) -> tuple[float, str] | None:
    """Return the acceleration over g of a load factor of one, and its direction in words.

    None where the live load is no acceleration of all masses in one direction, or the dead load has their
    weight more or less than once: which mass is meant is not known then.
    """
    weights = [(factor, term) for factor, term in model.dead.terms if isinstance(term, MassProportional)]
    if abs(sum(factor * term.direction[2] for factor, term in weights) + 1.0) > 1e-9:
        return None
    masses = all(isinstance(term, MassProportional | AddedMass) for _, term in model.live.terms)
    if not masses or left_still(model.dead, model.live):
        return None
    pushes: dict[Any, list[float]] = {MassProportional: [], AddedMass: []}
    for factor, term in model.live.terms:
        pushes[type(term)].append(factor)
    factor = sum(pushes[MassProportional])
    directions = {term.direction for _, term in model.live.terms}  # type: ignore[attr-defined] # both have it
    if not factor or len(directions) != 1 or any(own != factor for own in pushes[AddedMass]):
        return None
    (direction,) = directions
    word = "a horizontal acceleration" if abs(direction[2]) < 1e-9 else "an acceleration"
    return factor, f"{word} {along(direction)}"


def as_acceleration(model: Model, load_factor: float, most: bool = False) -> str:
    """Return a load factor as an acceleration, as text; empty where the live load is none."""
    known = acceleration(model)
    if known is None:
        return ""
    size = known[0] * load_factor
    most = most if known[0] > 0.0 else not most  # of a number below zero the larger is nearer to zero
    return f"{known[1]} of {cut(size, most=most)} g = {cut(size * gravity, most=most)} m/s²"


def together(notes: Iterable[str]) -> list[str]:
    """Return notes that differ in the name of the block and in numbers alone as one, with the first names."""
    alike: dict[str, list[tuple[str, str]]] = {}
    for note in notes:
        name, said = found.groups() if (found := _OF_BLOCK.fullmatch(note)) else ("", note)
        alike.setdefault(_NUMBER.sub("#", said) if name else said, []).append((name, said))
    lines = []
    for group in alike.values():
        names, said = zip(*group, strict=True)
        blocks = f"{'block' if len(names) == 1 else f'{len(names)} blocks'} {few(names)}: "
        lines.append(blocks * bool(names[0]) + _least_to_most(said))
    return lines


def _least_to_most(texts: Sequence[str]) -> str:
    """Return texts that differ in numbers alone as one, each number as the least and the most of them."""
    ends = []
    for own in zip(*map(_NUMBER.findall, texts), strict=True):
        least, most = min(own, key=float), max(own, key=float)
        ends.append(least if least == most else f"{least} to {most}")
    each = iter(ends)
    return _NUMBER.sub(lambda _: next(each), texts[0])


def times(counts: dict[str, int]) -> str:
    """Return counted words as text."""
    return few([f"{count} × {word}" for word, count in counts.items()])


def cut(value: float, digits: int = 4, most: bool = False) -> str:
    """Return a load factor or displacement as text: the first of three more `digits`, never more.

    What is the `most` that something can be is never less.
    """
    first = Decimal(f"{value:.{digits + 3}g}")
    rounding = ROUND_CEILING if most else ROUND_FLOOR
    return figures(float(Context(prec=digits, rounding=rounding).plus(first)), digits)


def figures(value: float, digits: int) -> str:
    """Return a number to its significant figures, trailing zeros too, without a bare point behind them."""
    return f"{value:#.{digits}g}".removesuffix(".")


def at_least(bound: float) -> str:
    """Return a lower bound in the seven digits of tables, rounded down."""
    return cut(bound, 7)


def at_most(bound: float) -> str:
    """Return an upper bound in the seven digits of tables, rounded up."""
    return cut(bound, 7, most=True)


def kilonewtons(force: float) -> str:
    """Return a force, N, in kN as text."""
    return f"{force / 1e3:.6g} kN"


def with_unit(value: float, unit: str) -> str:
    """Return a number with its unit as text."""
    return f"{value:.6g} {unit.replace('s2', 's²')}".strip()
