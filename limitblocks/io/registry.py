"""What a model file may name: every joint and every load term there is."""

from __future__ import annotations

from dataclasses import is_dataclass
from typing import Any, get_args

from limitblocks import joints
from limitblocks.mechanics.loads import LoadTerm

#: Name and class of every joint that a file may name: all that limitblocks.joints exports.
JOINTS: dict[str, Any] = {
    name: cls
    for name, cls in ((name, getattr(joints, name)) for name in joints.__all__)
    if is_dataclass(cls) and hasattr(cls, "yield_rows")
}
#: Name and class of every load term.
TERMS: dict[str, Any] = {cls.__name__: cls for cls in get_args(LoadTerm)}
