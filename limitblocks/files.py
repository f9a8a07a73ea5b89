"""Files in and out: models, results, and blocks in the formats of other programs."""

from limitblocks.geometry import Selection, select
from limitblocks.io import (
    ImportedBlocks,
    LikelySupports,
    Look,
    SeenBlock,
    look,
    model_schema,
    read,
    read_blocks,
    read_drawing,
    read_materials,
    read_result,
    write_animation,
    write_blocks,
    write_forces,
    write_result,
    write_vtu,
)
from limitblocks.reports import report_schema

__all__ = [
    "ImportedBlocks",
    "LikelySupports",
    "Look",
    "SeenBlock",
    "Selection",
    "look",
    "model_schema",
    "read",
    "read_blocks",
    "read_drawing",
    "read_materials",
    "read_result",
    "report_schema",
    "select",
    "write_animation",
    "write_blocks",
    "write_forces",
    "write_result",
    "write_vtu",
]


def __dir__() -> list[str]:
    return __all__
