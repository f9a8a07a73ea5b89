"""Rhino's 3dm files."""

from limitblocks.io.formats.rhino.reader import contents
from limitblocks.io.formats.rhino.writer import encoded, with_forces

__all__ = ["contents", "encoded", "with_forces"]
