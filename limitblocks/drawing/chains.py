"""Chains of blocks, such as arches and columns: along them runs a line of thrust."""

from __future__ import annotations

from collections import defaultdict

from limitblocks.model import Model

At = dict[str, list[int]]


def crowded(model: Model) -> tuple[str, int] | None:
    """Return the first free block with more than two joints, and their number; None if there is none."""
    return next(((name, len(known)) for name, known in _meeting(model).items() if len(known) > 2), None)


def touching(model: Model) -> list[int]:
    """Return the joints in which two blocks touch, by their places: no ties, dowels, fill or guides."""
    return [k for k, one in enumerate(model.interfaces) if not getattr(one.joint, "word", "")]


def chains(model: Model) -> list[list[int]]:
    """Return the interfaces of each chain of blocks, from a support on; none if the blocks branch."""
    at, supports = _meeting(model), set(model.supports)
    if crowded(model):
        return []
    lines: list[list[int]] = []
    seen = set[int]()
    for k in touching(model):
        own = model.interfaces[k]
        if k not in seen and supports & {own.block_i, own.block_j}:
            lines.append(_chain(model, k, at))
            seen.update(lines[-1])
    return lines


def _meeting(model: Model) -> At:
    """Joints in which each free block touches others, by their places."""
    supports, at = set(model.supports), defaultdict[str, list[int]](list)
    for k in touching(model):
        for name in {model.interfaces[k].block_i, model.interfaces[k].block_j} - supports:
            at[name].append(k)
    return at


def _chain(model: Model, first: int, at: At) -> list[int]:
    chain = [first]
    while True:
        interface = model.interfaces[chain[-1]]
        around = {k for name in (interface.block_i, interface.block_j) for k in at.get(name, ())}
        beyond = sorted(around - set(chain))
        if not beyond:
            return chain
        chain.append(beyond[0])
