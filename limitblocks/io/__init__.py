"""Files in and out: the model file, the result file, and blocks in the formats of other programs."""

from limitblocks.io.blocks import read_blocks, write_blocks
from limitblocks.io.forces import write_forces
from limitblocks.io.formats.dxf.elevation import read_drawing
from limitblocks.io.formats.gltf.writer import write_animation
from limitblocks.io.formats.vtu import write_vtu
from limitblocks.io.imported import ImportedBlocks
from limitblocks.io.look import Look, SeenBlock, look
from limitblocks.io.materials import read_materials
from limitblocks.io.model_file import model_schema
from limitblocks.io.result_file import read_result, write_result
from limitblocks.io.structure_file import read
from limitblocks.io.supports import LikelySupports

__all__ = [
    "ImportedBlocks",
    "LikelySupports",
    "Look",
    "SeenBlock",
    "look",
    "model_schema",
    "read",
    "read_blocks",
    "read_drawing",
    "read_materials",
    "read_result",
    "write_animation",
    "write_blocks",
    "write_forces",
    "write_result",
    "write_vtu",
]
