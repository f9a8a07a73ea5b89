"""DXF drawings: solids in space, and outlines of an elevation."""

from limitblocks.io.formats.dxf.reader import contents
from limitblocks.io.formats.dxf.writer import encoded

__all__ = ["contents", "encoded"]
