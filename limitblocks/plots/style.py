"""Colours, axes and units of all figures. Colours: Okabe & Ito (2008), safe for the colour-blind."""

from __future__ import annotations

from collections.abc import Sequence
from io import BytesIO
from typing import Any

from matplotlib import rcParams
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.projections.polar import PolarAxes
from matplotlib.transforms import ScaledTranslation
from mpl_toolkits.mplot3d import Axes3D

from limitblocks.errors import LimitBlocksError

BLACK, ORANGE, SKY, GREEN = "#000000", "#E69F00", "#56B4E9", "#009E73"
YELLOW, BLUE, VERMILION, PURPLE = "#F0E442", "#0072B2", "#D55E00", "#CC79A7"
CYCLE = (BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY, BLACK)
STONE, MOVING, SUPPORT, EDGE, PALE = "#ece6da", "#c3daee", "#a8a39b", "#4d4943", "#b9b4ab"


class _InNotebooks:
    """Axes that notebooks show as the picture of their figure, which pyplot does not know of."""

    figure: Any

    def _repr_png_(self) -> bytes:
        stream = BytesIO()
        self.figure.savefig(stream, format="png", dpi=100, bbox_inches="tight")
        return stream.getvalue()


class FlatAxes(_InNotebooks, Axes):
    """Plane axes."""


class RoundAxes(_InNotebooks, PolarAxes):
    """Polar axes."""


class SpatialAxes(_InNotebooks, Axes3D):  # type: ignore[misc] # without types
    """Axes in space."""


_KINDS: dict[str | None, type[Axes]] = {None: FlatAxes, "polar": RoundAxes, "3d": SpatialAxes}


def room() -> float:
    """Return the width of a figure that matplotlib's settings ask for, inches."""
    return float(rcParams["figure.figsize"][0])


def inches(ax: Any) -> float:
    """Return the width of Axes."""
    return float(ax.bbox.width / ax.figure.dpi)


def columns(ax: Any, names: Sequence[str]) -> int:
    """Return how many columns of a legend find room below Axes, from the longest name at 7 pt."""
    longest = max(map(len, names), default=1)
    return max(1, min(4, int((inches(ax) + 0.9) / (0.06 * longest + 0.4))))


def new_axes(projection: str | None = None, size: tuple[float, float] | None = None) -> Any:
    """Return Axes in a new figure that pyplot knows nothing of, as large as matplotlib's settings say."""
    kind = _KINDS[projection]
    if projection == "3d":
        return Figure(figsize=size).add_subplot(axes_class=kind, proj_type="ortho", computed_zorder=False)
    return Figure(figsize=size, layout="constrained").add_subplot(axes_class=kind)


def curve_axes(ax: Any, projection: str | None = None, size: tuple[float, float] | None = None) -> Any:
    """Return `ax` if it fits, or new Axes; LimitBlocksError if it is of another projection."""
    if ax is None:
        return new_axes(projection, size)
    wanted = projection or "rectilinear"
    if getattr(ax, "name", None) != wanted:
        raise LimitBlocksError(
            f"ax has the projection {getattr(ax, 'name', None)!r}, expected {wanted!r}; "
            "leave ax out to have it made"
        )
    return ax


def plain(ax: Axes) -> None:
    """Take away the frame's upper and right side."""
    ax.spines[["top", "right"]].set_visible(False)


def legend_below(
    ax: Any, place: tuple[float, float] = (0.5, 0.0), inches: float = 0.5, **options: Any
) -> None:
    """Put the legend some inches below a place in axes coordinates, for the labels to have room."""
    lower = ax.transAxes + ScaledTranslation(0.0, -inches, ax.figure.dpi_scale_trans)
    style = {"loc": "upper center", "bbox_to_anchor": place, "frameon": False, "fontsize": "small"}
    ax.legend(bbox_transform=lower, **(style | options))


def number(value: float) -> str:
    """Return a number with three digits, powers of ten as in print."""
    digits, _, power = f"{value:.3g}".partition("e")
    return digits if not power else rf"${digits}\times10^{{{int(power)}}}$"


def in_newtons(value: float) -> str:
    """Return a force with a prefix that keeps the number short."""
    for size, prefix in ((1e6, "M"), (1e3, "k")):
        if abs(value) >= size:
            return f"{value / size:.3g} {prefix}N"
    return f"{value:.3g} N"
