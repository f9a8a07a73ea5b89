"""Files in and out: the model file, the result file, and blocks in the formats of other programs."""

from limitblocks.io.dxf_outlines import read_drawing
from limitblocks.io.formats import read_blocks
from limitblocks.io.glb import write_animation
from limitblocks.io.imported import ImportedBlocks
from limitblocks.io.mesh_files import write_blocks
from limitblocks.io.model_file import model_schema
from limitblocks.io.result_file import read_result, write_result
from limitblocks.io.structure_file import read
from limitblocks.io.vtu import write_vtu

__all__ = [
    "ImportedBlocks",
    "model_schema",
    "read",
    "read_blocks",
    "read_drawing",
    "read_result",
    "write_animation",
    "write_blocks",
    "write_result",
    "write_vtu",
]
