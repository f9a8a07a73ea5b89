"""COMPAS JSON."""

from limitblocks.io.formats.compas.reader import contents, holds_blocks
from limitblocks.io.formats.compas.writer import encoded, with_forces

__all__ = ["contents", "encoded", "holds_blocks", "with_forces"]
