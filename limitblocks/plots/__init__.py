"""Figures for papers, drawn by matplotlib, which the extra `plots` installs.

Every function returns the Axes it drew on; `ax` is where to draw, a new figure without it. No function
touches pyplot, so that nothing is left open: save by ``ax.figure.savefig("wall.pdf")``.
"""

from limitblocks.io.packages import missing

try:
    import matplotlib as _matplotlib  # noqa: F401
except ImportError as error:
    raise missing("matplotlib", "limitblocks.plots") from error

from limitblocks.plots.brackets import bracket
from limitblocks.plots.capacities import capacity, settlement
from limitblocks.plots.contacts import forces, interface_states, thrust_line
from limitblocks.plots.curves import convergence, load_path, polar
from limitblocks.plots.findings import findings
from limitblocks.plots.sensitivity import sensitivity
from limitblocks.plots.structures import mechanism, structure
from limitblocks.plots.surfaces import interaction

__all__ = [
    "bracket",
    "capacity",
    "convergence",
    "findings",
    "forces",
    "interaction",
    "interface_states",
    "load_path",
    "mechanism",
    "polar",
    "sensitivity",
    "settlement",
    "structure",
    "thrust_line",
]


def __dir__() -> list[str]:
    return __all__
