"""glTF 2.0 and its binary form GLB."""

from limitblocks.io.formats.gltf.forces import with_forces
from limitblocks.io.formats.gltf.reader import contents
from limitblocks.io.formats.gltf.writer import encoded

__all__ = ["contents", "encoded", "with_forces"]
