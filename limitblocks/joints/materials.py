"""Materials: unit weight and joint of the blocks that patterns pick, and joints between two materials."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cache, cached_property
from typing import Any

import numpy as np

from limitblocks.arrays import real
from limitblocks.errors import ModelError, near
from limitblocks.geometry import Block, select
from limitblocks.geometry.selection import listed
from limitblocks.joints.base import Joint
from limitblocks.shown import many

#: Numbers of a joint of which the least is the weaker; None is a strength without limit.
_STRENGTHS = ("friction", "cohesion", "compressive_strength", "tensile_strength")


@dataclass(frozen=True)
class Material:
    """What blocks are made of.

    Parameters
    ----------
    unit_weight : float, optional
        N/m3; left out for blocks that have one, and for supports.
    joint : Joint, optional
        What an interface between two blocks of this material can carry; left out, a joint to another material
        is that of the other.
    blocks : sequence of str
        Which blocks it is, as for :func:`limitblocks.files.select`: names, "layer:PATTERN", "z<0.5". Left
        out, those whose layer or material has the name of this one.
    """

    unit_weight: float | None = None
    joint: Joint | None = None
    blocks: Sequence[str] = ()

    def __post_init__(self) -> None:
        if self.unit_weight is not None and not 0.0 <= real(self.unit_weight) < np.inf:
            raise ModelError(f"unit weight is {self.unit_weight!r}, expected a finite number >= 0 in N/m3")
        if self.joint is not None and not isinstance(self.joint, Joint):
            raise ModelError(f"joint is {self.joint!r}, expected one such as OrdunaLourenco(friction=0.6)")
        patterns: Any = self.blocks
        if not isinstance(patterns, list | tuple) or not all(isinstance(one, str) for one in patterns):
            raise ModelError(f"blocks are {patterns!r}, expected a list of names or patterns")


@dataclass(frozen=True)
class Materials:
    """Materials by name, in an order: a block is of the first whose patterns pick it.

    Parameters
    ----------
    materials : mapping of str to Material
    pairs : mapping of (str, str) to Joint
        Joints between two materials, in either order. Other pairs get the weaker joint: of two joints of one
        kind the least friction, the least cohesion and the least strengths; their other settings must agree.

    Raises
    ------
    ModelError
        There is no material, or a pair names an unknown one.
    """

    materials: Mapping[str, Material]
    pairs: Mapping[tuple[str, str], Joint] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if not self.materials:
            raise ModelError("there is no material; expected at least one")
        unknown = [name for pair in self.pairs for name in pair if name not in self.materials]
        if unknown:
            raise ModelError(
                *(f"pair names material {name!r}, which is not there{near(name, self.materials)}"
                  for name in dict.fromkeys(unknown))
            )  # fmt: skip

    def on(self, blocks: Sequence[Block]) -> tuple[tuple[Block, ...], tuple[str, ...]]:
        """Return the blocks with their materials and unit weights, and a line for each pattern in vain.

        Raises
        ------
        ModelError
            A block is of no material, or has another unit weight already.
        """
        owner: dict[str, str] = {}
        warnings: list[str] = []
        for name, material in self.materials.items():
            for pattern in material.blocks or (f"layer:{name}", f"material:{name}"):
                picked, said = _picked(blocks, pattern)
                if material.blocks and not picked:
                    warnings.append(f"material {name!r}: {said}")
                elif material.blocks and picked <= owner.keys():
                    warnings.append(
                        f"material {name!r}: {pattern!r} picks only blocks of materials before it"
                    )
                for block in picked:
                    owner.setdefault(block, name)
            if not material.blocks and name not in owner.values():
                warnings.append(f"material {name!r}: no block has a layer or material of this name")
        bare = [block for block in blocks if block.name not in owner]
        if bare:
            raise ModelError(
                f"{many(len(bare), 'block')} {'has' if len(bare) == 1 else 'have'} no material of the table; "
                f"among them {listed(bare)}",
                *warnings,
            )
        self._refuse_two_weights(blocks, owner)
        return tuple(self._made(block, owner[block.name]) for block in blocks), tuple(warnings)

    def between(self, block_i: Block, block_j: Block) -> Joint | None:
        """Return the joint between `block_i` and `block_j`, of these materials; None where neither has one.

        Raises
        ------
        ModelError
            Their joints are of two kinds, or differ in more than strength, and the pair is not given.
        """
        return self._known(block_i.material, block_j.material)

    def words(self, a: str, b: str) -> str:
        """Return where the joint between materials `a` and `b` comes from, in words."""
        own, joint = [self.materials[name].joint for name in (a, b)], self._known(a, b)
        if (a, b) in self.pairs or (b, a) in self.pairs:
            return f"{a}|{b}: as given for the pair: {joint}"
        if a == b or None in own:
            return f"{a}|{b}: {joint}"
        parts = [_least(one.name, (a, b), own) for one in fields(own[0]) if one.name in _STRENGTHS]  # type: ignore[arg-type]
        return f"{a}|{b}: the weaker of both, {', '.join(part for part in parts if part)}"

    @cached_property
    def _known(self) -> Callable[[str, str], Joint | None]:
        return cache(self._joint)

    def _joint(self, a: str, b: str) -> Joint | None:
        given = self.pairs.get((a, b), self.pairs.get((b, a)))
        if given is not None:
            return given
        for name in (a, b):
            if name not in self.materials:
                raise ModelError(f"material {name!r} is not in the table{near(name, self.materials)}")
        mine, other = self.materials[a].joint, self.materials[b].joint
        if mine is None or other is None:
            return mine or other
        try:
            return weaker(mine, other)
        except ModelError as error:
            raise ModelError(f"between {a!r} and {b!r}: {error}; give their joint as a pair") from None

    def _made(self, block: Block, name: str) -> Block:
        weight = self.materials[name].unit_weight
        weight = block.unit_weight if weight is None else weight
        return block.labelled(unit_weight=weight, material=name)

    def _refuse_two_weights(self, blocks: Sequence[Block], owner: Mapping[str, str]) -> None:
        twice: dict[str, str] = {}
        for block in blocks:
            material = owner[block.name]
            weight = self.materials[material].unit_weight
            if None not in (weight, block.unit_weight) and weight != block.unit_weight:
                said = f"unit weight {weight:g} N/m3, but block {block.name!r} has {block.unit_weight:g}"
                twice.setdefault(material, f"material {material!r} has {said}; leave one out")
        if twice:
            raise ModelError(*twice.values())


def weaker(a: Joint, b: Joint) -> Joint:
    """Return the joint with the least strengths of two of one kind.

    Raises
    ------
    ModelError
        They are of two kinds, or differ in a setting that is no strength.
    """
    if type(a) is not type(b):
        raise ModelError(f"joints are {type(a).__name__} and {type(b).__name__}")
    changes: dict[str, Any] = {}
    for one in fields(a):  # type: ignore[arg-type] # joints are dataclasses
        values = getattr(a, one.name), getattr(b, one.name)
        if one.name in _STRENGTHS:
            changes[one.name] = min((value for value in values if value is not None), default=None)
        elif values[0] != values[1]:
            raise ModelError(f"{one.name} is {values[0]!r} and {values[1]!r}")
    return replace(a, **changes)  # type: ignore[type-var] # as above


def _least(word: str, names: tuple[str, str], joints: Sequence[Any]) -> str:
    """Return a number of the weaker joint with the material it is of; empty where both have none."""
    values = [(getattr(joint, word), name) for joint, name in zip(joints, names, strict=True)]
    known = [(value, name) for value, name in values if value is not None]
    if not any(value for value, _ in known):
        return ""
    value, name = min(known)
    whose = "both" if len({value for value, _ in values}) == 1 else name
    return f"{word.replace('_', ' ')} {value:g} ({whose})"


def _picked(blocks: Sequence[Block], pattern: str) -> tuple[set[str], str]:
    """Return the names that a pattern picks, and why there is none."""
    try:
        return set(select(blocks, pattern, "pattern")), ""
    except ModelError as error:
        return set(), str(error)
