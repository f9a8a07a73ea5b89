"""Blocks, polygons, lines and arrows, in elevation or axonometric, on the axes of a structure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import product
from textwrap import wrap
from typing import Any

import numpy as np
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.ticker import FixedLocator, Locator, MaxNLocator
from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection
from mpl_toolkits.mplot3d.proj3d import proj_transform

from limitblocks.arrays import Array
from limitblocks.drawing.painter import painting_order, placed
from limitblocks.drawing.silhouette import hulls, outlines
from limitblocks.geometry import polyhedron
from limitblocks.plots.style import EDGE, SUPPORT, columns, inches, legend_below, plain, room

LIGHT = np.array([-0.35, -0.6, 0.72])
BESIDE = 1.3  # inches: left free beside an axonometric drawing
LETTER, ASIDE = 0.06, 0.5  # inches: a letter of 7 pt, and how far a title may stand out
SHORT = 0.25  # of the longest axis: one tick is enough
ABOVE = 10_000.0  # zorder of what is drawn over all blocks


@dataclass(frozen=True)
class Canvas:
    """Axes with the view of a structure: rows right, up, towards the eye.

    `spatial` for 3d Axes; `own` where the figure was made here and may be cut to the drawing, with the points
    `beyond` the frame, to which it may be added.
    """

    ax: Any
    view: Array
    spatial: bool
    own: bool
    beyond: list[Array] = field(default_factory=list)

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
            shapes = hulls([points[k] for k in these], self.view)
            fill = [to_rgb("white" if hatch else colours[k]) for k in these]
            lines = {"hatch": hatch, "zorder": 0.9} if hatch else {"zorder": 1.0}
            self._add(PolyCollection(shapes, facecolors=fill, **(lines | style)))

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
            lines = {"arrow_length_ratio": 0.2, "linewidth": 1.0, "clip_on": False}  # may be above the axes
            self.ax.quiver(*tails.T, *vectors.T, **lines, **style)
        else:
            across = {"angles": "xy", "scale_units": "xy", "scale": 1.0, "units": "inches", "width": 0.018}
            self.ax.quiver(*self.flat(tails).T, *self.flat(vectors).T, **across, **style)

    def outline(self, points: Sequence[Array], **style: Any) -> None:
        """Draw the outline of bodies as seen, as one."""
        size = float(np.ptp(np.concatenate(points), axis=0).max())
        self.lines([ring @ self.view[:2] for ring in outlines(points, self.view, 1e-4 * size)], **style)

    def frame(self, points: Array) -> None:
        """Label the axes, in m, with equal scales and the limits of `points` (n, 3)."""
        if not self.spatial:
            names = ["XYZ"[int(np.abs(row).argmax())] for row in self.view[:2]]
            self.ax.set(xlabel=f"{names[0]} (m)", ylabel=f"{names[1]} (m)", aspect="equal")
            self.ax.update_datalim(self.flat(np.concatenate([points, *self.beyond])))
            self.ax.margins(0.04)
            self.ax.autoscale_view()
            # one tick will do on a thin wall: matplotlib wants two, whose labels touch
            self.ax.xaxis.set_major_locator(MaxNLocator("auto", steps=[1, 2, 2.5, 5, 10], min_n_ticks=1))
            plain(self.ax)
            return
        low, high = points.min(axis=0), points.max(axis=0)
        span = np.maximum(high - low, 0.02 * (high - low).max())
        middle = (low + high) / 2
        for name, centre, length in zip("xyz", middle, span, strict=True):
            share = float(length / span.max())
            axis = getattr(self.ax, f"{name}axis")
            getattr(self.ax, f"set_{name}lim3d")(centre - 0.51 * length, centre + 0.51 * length)
            axis.set_major_locator(_few(share, float(centre), float(length), inches(self.ax)))
            axis.set_label_text(f"{name.upper()} (m)")
            axis.set_pane_color((1.0, 1.0, 1.0, 0.0))
        self.ax.set_box_aspect(span)
        self.ax.grid(False)
        self._cut(0.75)

    def title(self, text: str) -> None:
        """Write lines above the drawing, broken to the width of the axes."""
        most = int((inches(self.ax) + ASIDE) / LETTER)
        text = "\n".join(part for line in text.splitlines() for part in wrap(line, most))
        low, high = self._extent()
        above = high[1] + 0.03
        place = {"x": (low[0] + high[0]) / 2, "y": above, "va": "bottom"} if self.spatial else {}
        self.ax.set_title(text, fontsize="small", **place)
        if self.spatial:
            self.ax.title.set_y(above)  # of which set_title of 3d Axes makes 0.92

    def legend(self) -> None:
        """Put the legend below the drawing."""
        names = self.ax.get_legend_handles_labels()[1]
        ncols = columns(self.ax, names)
        if self.spatial:
            rows = -(-len(names) // ncols)
            self._cut(0.85 + 0.2 * rows)
        low, high = self._extent()
        place = ((low[0] + high[0]) / 2, low[1])
        legend_below(self.ax, place, 0.65 if self.spatial else 0.5, ncols=ncols)

    def _extent(self) -> tuple[Array, Array]:
        """Lower left and upper right corner of what is drawn, in axes coordinates."""
        if not self.spatial:
            return np.zeros(2), np.ones(2)
        limits = [getattr(self.ax, f"get_{name}lim3d")() for name in "xyz"]
        points = np.concatenate([np.array(list(product(*limits))), *self.beyond])
        x, y, _ = proj_transform(*points.T, self.ax.get_proj())
        to_axes = self.ax.transData + self.ax.transAxes.inverted()
        places = to_axes.transform(np.column_stack([x, y]))
        return places.min(axis=0), places.max(axis=0)

    def _cut(self, below: float) -> None:
        """Give a new figure the shape of the drawing, with `below` inches for what is written there."""
        if not self.own:
            return
        low, high = self._extent()
        side = float(
            min((room() - BESIDE) / (high - low))
        )  # inches: the square axes may reach beyond the figure
        left, right, above = 0.55, 0.75, 0.75
        wide, tall = side * (high - low) + [left + right, below + above]
        self.ax.figure.set_size_inches(wide, tall)
        corner = np.array([left, below]) - side * low
        self.ax.set_position([corner[0] / wide, corner[1] / tall, side / wide, side / tall])

    def _add(self, collection: Any) -> None:
        if self.spatial:
            self.ax.add_collection3d(collection, autolim=False)
        else:
            self.ax.add_collection(collection)


def _few(share: float, centre: float, length: float, wide: float) -> Locator:
    """Ticks of an axis that is a `share` of the longest, on axes so many inches wide."""
    if share < SHORT:
        return FixedLocator([round(centre, 1 - int(np.floor(np.log10(length))))])
    return MaxNLocator(max(1, round(float(np.clip(1.2 * wide, 2.0, 5.0)) * share)), steps=[1, 2, 5, 10])


def _shaded(colour: str, normal: Array) -> tuple[float, ...]:
    bright = 0.78 + 0.22 * float(normal @ LIGHT)
    return tuple(float(np.clip(bright * part, 0.0, 1.0)) for part in to_rgb(colour))
