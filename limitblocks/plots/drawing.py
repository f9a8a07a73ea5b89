"""Blocks, polygons, lines and arrows, in elevation or axonometric, on the axes of a structure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
import shapely
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.ticker import MaxNLocator
from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection
from mpl_toolkits.mplot3d.proj3d import proj_transform

from limitblocks.arrays import Array
from limitblocks.errors import LimitBlocksError
from limitblocks.geometry import polyhedron
from limitblocks.geometry.painter import painting_order, placed
from limitblocks.model import Model
from limitblocks.plots.style import EDGE, SUPPORT, new_axes, plain

# Directions on the page to the right, up, and towards the eye.
PLANES = {
    "xz": np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]]),
    "yz": np.array([[0, 1.0, 0], [0, 0, 1], [1, 0, 0]]),
    "xy": np.array([[1.0, 0, 0], [0, 1, 0], [0, 0, 1]]),
}
LIGHT = np.array([-0.35, -0.6, 0.72])
LARGEST = 5.0  # inches: width or height of an axonometric drawing
ABOVE = 10_000.0  # zorder of what is drawn over all blocks


@dataclass(frozen=True)
class Canvas:
    """Axes with the view of a structure: rows right, up, towards the eye.

    `spatial` for 3d Axes; `own` where the figure was made here and may be cut to the drawing.
    """

    ax: Any
    view: Array
    spatial: bool
    own: bool

    def flat(self, points: Array) -> Array:
        """Coordinates (n, 2) on the page of points (n, 3)."""
        return np.asarray(points @ self.view[:2].T)

    def blocks(
        self, points: Sequence[Array], faces: Sequence[polyhedron.Faces], colours: Sequence[str], **style: Any
    ) -> None:
        """Fill convex bodies, those in front last."""
        style = {"edgecolor": EDGE, "linewidth": 0.5} | style
        if not self.spatial:
            self._silhouettes(points, colours, style)
            return
        bodies = [placed(p, f) for p, f in zip(points, faces, strict=True)]
        for rank, k in enumerate(painting_order(bodies, self.view[2])):
            seen = np.flatnonzero(bodies[k].normals @ self.view[2] > 1e-9).tolist()
            shades = [_shaded(colours[k], bodies[k].normals[face]) for face in seen]
            polygons = [points[k][list(faces[k][face])] for face in seen]
            self._add(Poly3DCollection(polygons, facecolors=shades, zorder=1 + rank, **style))

    def _silhouettes(self, points: Sequence[Array], colours: Sequence[str], style: dict[str, Any]) -> None:
        order = np.argsort([(p @ self.view[2]).max() for p in points], kind="stable").tolist()
        for hatch in ("", "/////"):
            these = [k for k in order if (colours[k] == SUPPORT) == bool(hatch)]
            hulls = [
                shapely.get_coordinates(shapely.MultiPoint(self.flat(points[k])).convex_hull)[:-1]
                for k in these
            ]
            fill = [to_rgb("white" if hatch else colours[k]) for k in these]
            lines = {"hatch": hatch, "zorder": 0.9} if hatch else {"zorder": 1.0}
            self._add(PolyCollection(hulls, facecolors=fill, **(lines | style)))

    def polygons(self, polygons: Sequence[Array], **style: Any) -> None:
        """Draw plane polygons (n, 3) over the blocks; in elevation those seen from the edge are lines."""
        style = {"zorder": ABOVE} | style
        if self.spatial:
            self._add(Poly3DCollection(polygons, **style))
        else:
            self._add(PolyCollection([self.flat(p) for p in polygons], **style))

    def lines(self, lines: Sequence[Array], **style: Any) -> None:
        """Draw polylines (n, 3) over the blocks."""
        style = {"zorder": ABOVE} | style
        if self.spatial:
            self._add(Line3DCollection(lines, **style))
        else:
            self._add(LineCollection([self.flat(line) for line in lines], **style))

    def plot(self, points: Array, *args: Any, **style: Any) -> None:
        """Call `ax.plot` for points (n, 3), over the blocks."""
        places = points if self.spatial else self.flat(points)
        self.ax.plot(*places.T, *args, **({"zorder": ABOVE} | style))

    def text(self, point: Array, text: str, **style: Any) -> None:
        """Write at a point (3,), over the blocks."""
        place = point if self.spatial else self.flat(point)
        self.ax.text(*place.tolist(), text, **({"va": "center", "fontsize": "small", "zorder": 2e4} | style))

    def arrows(self, tails: Array, vectors: Array, **style: Any) -> None:
        """Draw arrows (n, 3) from `tails` (n, 3), in m."""
        style = {"zorder": ABOVE} | style
        if self.spatial:
            self.ax.quiver(*tails.T, *vectors.T, arrow_length_ratio=0.2, linewidth=1.0, **style)
        else:
            across = {"angles": "xy", "scale_units": "xy", "scale": 1.0, "width": 0.0035}
            self.ax.quiver(*self.flat(tails).T, *self.flat(vectors).T, **across, **style)

    def outline(self, points: Sequence[Array], **style: Any) -> None:
        """Draw the outline of bodies as seen, as one."""
        hulls = [shapely.MultiPoint(self.flat(p)).convex_hull for p in points]
        size = float(np.ptp(np.concatenate(points), axis=0).max())
        whole = shapely.union_all(shapely.buffer(hulls, 1e-4 * size, join_style="mitre"))
        rings = [ring for part in shapely.get_parts(whole) for ring in (part.exterior, *part.interiors)]
        self.lines([shapely.get_coordinates(ring) @ self.view[:2] for ring in rings], **style)

    def frame(self, points: Array) -> None:
        """Label the axes, in m, with equal scales and the limits of `points` (n, 3)."""
        low, high = points.min(axis=0), points.max(axis=0)
        if not self.spatial:
            names = ["XYZ"[int(np.abs(row).argmax())] for row in self.view[:2]]
            self.ax.set(xlabel=f"{names[0]} (m)", ylabel=f"{names[1]} (m)", aspect="equal")
            self.ax.update_datalim(self.flat(points))
            self.ax.margins(0.04)
            self.ax.autoscale_view()
            plain(self.ax)
            return
        span = np.maximum(high - low, 0.02 * (high - low).max())
        middle = (low + high) / 2
        for name, centre, length in zip("xyz", middle, span, strict=True):
            axis = getattr(self.ax, f"{name}axis")
            getattr(self.ax, f"set_{name}lim3d")(centre - 0.51 * length, centre + 0.51 * length)
            axis.set_major_locator(MaxNLocator(max(1, round(5 * length / span.max())), steps=[1, 2, 5, 10]))
            axis.set_label_text(f"{name.upper()} (m)")
            axis.set_pane_color((1.0, 1.0, 1.0, 0.0))
        self.ax.set_box_aspect(span)
        self.ax.grid(False)
        self._cut(0.75)

    def title(self, text: str) -> None:
        """Write a line above the drawing."""
        if self.spatial and self.own:
            low, high = self._extent()
            self.ax.text2D(
                (low[0] + high[0]) / 2,
                high[1] + 0.04,
                text,
                transform=self.ax.transAxes,
                ha="center",
                fontsize="small",
            )
        else:
            self.ax.set_title(text, fontsize="small")

    def legend(self) -> None:
        """Put the legend below the drawing."""
        low, high = self._extent()
        labels = len(self.ax.get_legend_handles_labels()[1])
        rows = -(-labels // 4)
        if self.spatial:
            self._cut(0.95 + 0.25 * rows)
        place = ((low[0] + high[0]) / 2, low[1] - (0.12 if self.spatial else 0.14))
        self.ax.legend(loc="upper center", bbox_to_anchor=place, ncols=4, frameon=False, fontsize="small")

    def _extent(self) -> tuple[Array, Array]:
        """Lower left and upper right corner of what is drawn, in axes coordinates."""
        if not self.spatial:
            return np.zeros(2), np.ones(2)
        limits = [getattr(self.ax, f"get_{name}lim3d")() for name in "xyz"]
        x, y, _ = proj_transform(*np.array(list(product(*limits))).T, self.ax.get_proj())
        to_axes = self.ax.transData + self.ax.transAxes.inverted()
        places = to_axes.transform(np.column_stack([x, y]))
        return places.min(axis=0), places.max(axis=0)

    def _cut(self, below: float) -> None:
        """Give a new figure the shape of the drawing, with `below` inches for what is written there."""
        if not self.own:
            return
        low, high = self._extent()
        side = float(
            min(LARGEST / (high - low))
        )  # of the square axes, inches; they may reach beyond the figure
        left, right, above = 0.55, 0.75, 0.45
        wide, tall = side * (high - low) + [left + right, below + above]
        self.ax.figure.set_size_inches(wide, tall)
        corner = np.array([left, below]) - side * low
        self.ax.set_position([corner[0] / wide, corner[1] / tall, side / wide, side / tall])

    def _add(self, collection: Any) -> None:
        if self.spatial:
            self.ax.add_collection3d(collection, autolim=False)
        else:
            self.ax.add_collection(collection)


def canvas(model: Model, ax: Any, plane: str | None) -> Canvas:
    """Return `ax`, or new Axes, with the view of `model`.

    Without a plane, `ax` decides; without `ax` too, models whose contacts and loads lie in one vertical plane
    are drawn in elevation, others axonometrically.
    """
    if plane not in (None, "3d", *PLANES):
        known = ", ".join(map(repr, (*PLANES, "3d")))
        raise LimitBlocksError(f"plane is {plane!r}, expected one of {known}")
    if ax is not None and getattr(ax, "name", None) not in ("3d", "rectilinear"):
        raise LimitBlocksError(f"ax is {ax!r}, expected plain or 3d Axes of matplotlib")
    if ax is not None and plane is not None and (ax.name == "3d") != (plane == "3d"):
        raise LimitBlocksError(f"plane is {plane!r}, but ax has the projection {ax.name!r}; leave one out")
    plane = plane or ("3d" if ax is not None and ax.name == "3d" else _plane(model, ax is not None))
    if plane != "3d":
        return Canvas(ax or new_axes(size=_size(model, PLANES[plane])), PLANES[plane], False, False)
    own = ax is None
    if own:
        ax = new_axes("3d")
        wide, deep, _ = np.ptp(_vertices(model), axis=0)
        ax.view_init(elev=22.0, azim=-60.0 if wide >= deep else -30.0)
    ax.computed_zorder = False
    elev, azim = np.radians([ax.elev, ax.azim])
    eye = np.array([np.cos(elev) * np.cos(azim), np.cos(elev) * np.sin(azim), np.sin(elev)])
    right = np.array([-np.sin(azim), np.cos(azim), 0.0])
    return Canvas(ax, np.array([right, np.cross(eye, right), eye]), True, own)


def _plane(model: Model, flat: bool) -> str:
    """Name of the elevation in which contacts and live load lie, or else 3d, or xz if it must be `flat`."""
    vectors = np.stack([interface.axes[2] for interface in model.interfaces])
    live = model.live.on(model.free_blocks)[:, :3]
    live = live / max(float(np.abs(live).max()), np.finfo(float).tiny)
    out = np.abs(np.concatenate([vectors, live])).max(axis=0) < 1e-6
    return "xz" if out[1] else "yz" if out[0] else "xz" if flat else "3d"


def _vertices(model: Model) -> Array:
    return np.concatenate([block.vertices for block in model.blocks])


def _size(model: Model, view: Array) -> tuple[float, float]:
    """Size of a figure, inches, whose shape is that of the structure."""
    wide, high = np.ptp(_vertices(model) @ view[:2].T, axis=0)
    width = float(np.clip(4.5 * wide / high, 3.0, 6.5))
    return width + 0.6, float(np.clip(width * high / wide, 1.2, 6.5)) + 1.0


def _shaded(colour: str, normal: Array) -> tuple[float, ...]:
    bright = 0.78 + 0.22 * float(normal @ LIGHT)
    return tuple(float(np.clip(bright * part, 0.0, 1.0)) for part in to_rgb(colour))
