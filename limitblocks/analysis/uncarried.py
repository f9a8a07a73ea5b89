"""Blocks that no interface pushes or pulls against their dead load: held by friction alone, if at all."""

from __future__ import annotations

import numpy as np

from limitblocks.errors import few
from limitblocks.geometry import Tolerances
from limitblocks.geometry.ends import ends_of
from limitblocks.joints import Tie
from limitblocks.model import Model

#: Share of a push against the dead load that is none: rounding, and over the accuracy; faces lean up to 7.1.
_ROUNDED, _LEANING = 1e-6, 8.0
#: Dead force, over the largest on a block, that is none.
_NONE = 1e-9


def uncarried(model: Model, used: Tolerances | None) -> tuple[str, ...]:
    """Return the names of the free blocks that friction alone holds against their dead load, if anything.

    A contact pushes along its normal and a tie pulls; dowels, guides and bond carry whatever their place.
    `used` are tolerances that say how accurate the faces are.
    """
    free, interfaces = model.free_blocks, model.interfaces
    force = model.dead.on(free)[:, :3]
    size = np.linalg.norm(force, axis=1)
    loaded = size > _NONE * size.max(initial=0.0)
    down = np.divide(force, size[:, None], out=np.zeros_like(force), where=loaded[:, None])
    ends = ends_of(free, interfaces)
    normal = np.array([one.axes[2] for one in interfaces])
    pulls = np.array([1.0 if isinstance(one.joint, Tie) else -1.0 for one in interfaces])
    held = np.array([_held(one.joint) for one in interfaces])
    accuracy = (used.accuracy if used else None) or 0.0
    least = max(_ROUNDED, _LEANING * accuracy)
    for end, out in ((ends[:, 0], 1.0), (ends[:, 1], -1.0)):
        # share of the force that it gives the block
        against = -out * pulls * (normal * down[end]).sum(axis=1)
        loaded[end[(end >= 0) & (held | (against > least))]] = False
    return tuple(block.name for block, one in zip(free, loaded.tolist(), strict=True) if one)


def uncarried_words(found: tuple[str, ...]) -> list[str]:
    """Return the line that names blocks that no interface carries, with what would be right; none of none."""
    if not found:
        return []
    return [
        "blocks that friction alone holds, if anything, for no interface pushes or pulls them against their "
        f"dead load: {few(found)}; is a support or a lintel under them missing, or a joint drawn open "
        "(gap, --gap)?"
    ]


def _held(joint: object) -> bool:
    """Whether a joint carries more than friction does, in whatever direction: a dowel, a guide or bond."""
    element = bool(getattr(joint, "word", "")) and not isinstance(joint, Tie)
    return element or bool(getattr(joint, "cohesion", 0.0))  # without it no joint has tension
