"""COMPAS JSON."""

from limitblocks.io.formats.compas.forces import with_forces
from limitblocks.io.formats.compas.reader import contents, holds_blocks
from limitblocks.io.formats.compas.writer import encoded

__all__ = ["contents", "encoded", "holds_blocks", "with_forces"]
