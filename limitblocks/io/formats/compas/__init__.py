"""COMPAS JSON."""

from limitblocks.io.formats.compas.reader import contents
from limitblocks.io.formats.compas.writer import encoded

__all__ = ["contents", "encoded"]
