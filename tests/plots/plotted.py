import io
from functools import cache

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg

import limitblocks as lb

JOINT = lb.OrdunaLourenco(friction=0.7)


def inked(ax):
    """Share of the pixels of a figure that are not white once the frame of the axes is taken away."""
    for one in ax.figure.axes:
        one.set_axis_off()
        one.set_title("")
    canvas = FigureCanvasAgg(ax.figure)
    canvas.draw()
    return float((np.asarray(canvas.buffer_rgba())[..., :3].min(axis=2) < 250).mean())


def saved(ax):
    """Bytes of the figure as PNG."""
    stream = io.BytesIO()
    ax.figure.savefig(stream, format="png", dpi=40)
    return stream.getvalue()


@cache
def rocking():
    """A block of 0.5 m x 1 m x 2 m that tips over about x = 0.5 m, pushed along X."""
    return lb.structures.block(JOINT, width=0.5, height=2.0)


@cache
def arch():
    """A semicircular arch of 9 voussoirs with a growing force on its crown."""
    model = lb.structures.arch(JOINT, radius=2.0, thickness=0.4, voussoirs=9)
    crown = model.free_blocks[4]
    live = lb.loads.force(crown.name, (0, 0, -10e3), at=(0, 0, 2.0))
    return lb.Model(model.blocks, model.supports, model.interfaces, model.dead, live)


@cache
def corner():
    """Two walls that interlock at a corner, pushed along X."""
    return lb.structures.corner(JOINT, length=1.6, return_length=1.2, courses=3)


@cache
def bounds(make):
    return lb.bounds(make())


@cache
def path():
    return lb.load_path(rocking())
