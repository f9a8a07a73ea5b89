"""Drawings made by ezdxf, and the structures drawn."""

import ezdxf
import numpy as np

import limitblocks as lb
from limitblocks.geometry.polygon import areas

JOINT = lb.OrdunaLourenco(0.6)
STRUCTURES = {
    "arch": lb.structures.arch(JOINT, radius=2.0, thickness=0.3, voussoirs=9, depth=0.5),
    "wall": lb.structures.wall(JOINT, length=1.6, courses=3, thickness=0.2),
    "corner": lb.structures.corner(JOINT, length=2.4, return_length=1.6, courses=2),
    "vault": lb.structures.barrel_vault(JOINT, radius=2.0, thickness=0.3, length=1.5, courses=7, stones=2),
}


def total_area(interfaces):
    return float(sum(areas(interface.polygon[None])[0] for interface in interfaces))


def drawn(path, draw, units=6, version="R2010"):
    """A DXF file of what `draw` puts into the model space; unit code 6 is m, 4 is mm."""
    drawing = ezdxf.new(version, units=units)
    draw(drawing.modelspace())
    drawing.saveas(path)
    return path


def elevation(model, scale=1.0, jitter=0.0):
    """Outlines of a model in the plane X, Z, by name."""
    rng = np.random.default_rng(1)
    outlines = {}
    for block in model.blocks:
        front = block.faces[int(np.argmin(block.normals[:, 1]))]
        corners = block.vertices[list(front)][:, [0, 2]]
        outlines[block.name] = (corners + rng.uniform(-jitter, jitter, corners.shape)) * scale
    return outlines
