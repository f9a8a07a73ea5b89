"""Every drawing in one column of a journal: no text below 7 pt, none over another or over a curve."""

import matplotlib.pyplot as plt
import numpy as np
import pytest
from overlap import collisions, covered, too_small
from plotted import arch, bounds, corner, path, rocking

import limitblocks as lb

plots = lb.plots
SQUARE = lb.joints.interface([(0.25, -0.25), (0.25, 0.25), (-0.25, 0.25), (-0.25, -0.25)], None)
ANGLES = np.linspace(0.0, 2 * np.pi, 16, endpoint=False)


def thin():
    return lb.structures.wall(lb.PointContact(0.6), length=2.0, courses=10, thickness=0.1)


DRAWN = {
    "structure": lambda: plots.structure(arch()),
    "thin wall": lambda: plots.structure(thin(), plane="yz"),
    "corner": lambda: plots.structure(corner()),
    "mechanism": lambda: plots.mechanism(arch(), bounds(arch)),
    "mechanism of a corner": lambda: plots.mechanism(corner(), bounds(corner)),
    "forces": lambda: plots.forces(arch(), bounds(arch)),
    "states": lambda: plots.interface_states(arch(), bounds(arch)),
    "states of a corner": lambda: plots.interface_states(corner(), bounds(corner)),
    "thrust": lambda: plots.thrust_line(arch(), bounds(arch)),
    "findings": lambda: plots.findings(corner()),
    "convergence": lambda: plots.convergence(lb.nonassociated(rocking())),
    "path": lambda: plots.load_path(rocking(), path()),
    "bracket": lambda: plots.bracket(bounds(rocking), path()),
    "polar": lambda: plots.polar(ANGLES, 1.0 + 0.2 * np.cos(ANGLES)),
    "interaction": lambda: plots.interaction(lb.OrdunaLourenco(0.6), SQUARE, "V1", "T", exact=True),
    "sensitivity": lambda: plots.sensitivity(arch(), lb.sensitivities(arch(), bounds(arch))),
}


@pytest.mark.parametrize("draw", DRAWN.values(), ids=DRAWN)
def test_drawings_are_fit_for_one_column(draw, request):
    with plt.style.context("limitblocks.plots.paper"):
        figure = draw().figure
        assert figure.get_size_inches()[0] <= 3.5 + 1e-9
        assert collisions(figure) == []
        assert covered(figure) == []
        assert too_small(figure) == []
