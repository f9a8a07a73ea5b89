"""A mechanism as one axonometric line drawing: polygons for an SVG, back to front."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import shapely

from limitblocks.arrays import Array
from limitblocks.geometry import polyhedron
from limitblocks.geometry.painter import Body, painting_order, placed
from limitblocks.model import Model

WIDTH, MARGIN = 1000.0, 12.0  # user units of the SVG
DRAWN = 0.08  # largest displacement drawn, over the diagonal of the structure
TURN = 0.25  # largest rotation drawn, rad: the drawing is linear in it
MOST_GHOSTS = 500  # more moving blocks, and only the outline around them shows where they were
MOVING = 1e-3  # of the largest displacement rate: less counts as standing still
SHADES = 4
LIGHT = np.array([-0.35, -0.5, 0.8])


class Face(NamedTuple):
    """Visible face: SVG path and shade, 0 (bright) to 3."""

    path: str
    shade: int


class Drawn(NamedTuple):
    """Block as drawn: its name, `moving`, `still` or `support`, and its visible faces."""

    name: str
    kind: str
    faces: tuple[Face, ...]


@dataclass(frozen=True)
class Picture:
    """Drawing of a mechanism.

    Attributes
    ----------
    height : float
        Of the view box, in user units; the width is 1000.
    blocks, ghosts : tuple of Drawn
        Displaced blocks, and the moving ones where they were before; back to front.
    outline : str
        SVG path around the moving blocks before they moved.
    axes : tuple of (str, float, float)
        Label and tip of unit vectors along X, Y, Z and the live load's resultant, where it has one.
    magnification : float
        Drawn displacement over displacement rate, m/m.
    largest : str
        Name of the block with the largest displacement.
    """

    height: float
    blocks: tuple[Drawn, ...]
    ghosts: tuple[Drawn, ...]
    outline: str
    axes: tuple[tuple[str, float, float], ...]
    magnification: float
    largest: str


def mechanism_picture(model: Model, rates: Array) -> Picture:
    """Return the drawing of displacement rates (n, 6) of the blocks of `model`."""
    middle = np.mean([block.centroid for block in model.blocks], axis=0)
    points = [block.vertices - middle for block in model.blocks]
    faces = [block.faces for block in model.blocks]
    shifts = _shifts(model, rates)
    sizes = np.array([np.linalg.norm(shift, axis=1).max() for shift in shifts])
    scale = _magnification(points, sizes, rates)
    view = _view(np.concatenate(points))
    before = [placed(p, f) for p, f in zip(points, faces, strict=True)]
    after = [placed(p + scale * s, f) for p, s, f in zip(points, shifts, faces, strict=True)]
    page = _Page.around(np.concatenate([body.points for body in (*before, *after)]), view)
    moving = sizes > MOVING * max(sizes.max(), 1e-300)
    kinds = np.where(moving, "moving", "still").tolist()
    for k, block in enumerate(model.blocks):
        kinds[k] = "support" if block.name in model.supports else kinds[k]
    names = [block.name for block in model.blocks]
    drawn = [_drawn(*each, view, page) for each in zip(names, kinds, faces, after, strict=True)]
    shown = np.flatnonzero(moving).tolist()
    ghostly = shown if len(shown) <= MOST_GHOSTS else []
    ghosts = [_drawn(names[k], "ghost", faces[k], before[k], view, page) for k in ghostly]
    live = model.live.on(model.free_blocks)[:, :3].sum(axis=0)
    return Picture(
        height=page.height,
        blocks=tuple(drawn[k] for k in painting_order(after, view[2])),
        ghosts=tuple(ghosts[k] for k in painting_order([before[k] for k in ghostly], view[2])),
        outline=_outline([before[k] for k in shown], view, page),
        axes=_axes(live, view),
        magnification=scale,
        largest=names[int(sizes.argmax())],
    )


def magnification(model: Model, rates: Array) -> float:
    """Return by how much displacement rates (n, 6) are drawn larger; 0 where nothing moves."""
    sizes = np.array([np.linalg.norm(shift, axis=1).max() for shift in _shifts(model, rates)])
    return _magnification([block.vertices for block in model.blocks], sizes, rates)


def _shifts(model: Model, rates: Array) -> list[Array]:
    """Displacement rates of the vertices of each block."""
    return [
        rate[:3] + np.cross(rate[3:], block.vertices - block.centroid)
        for block, rate in zip(model.blocks, rates, strict=True)
    ]


def _magnification(points: Sequence[Array], sizes: Array, rates: Array) -> float:
    largest, turn = float(sizes.max()), float(np.linalg.norm(rates[:, 3:], axis=1).max())
    diagonal = float(np.linalg.norm(np.ptp(np.concatenate(points), axis=0)))
    return min(DRAWN * diagonal / largest, TURN / turn if turn > 0.0 else np.inf) if largest > 0.0 else 0.0


def _view(points: Array) -> Array:
    """Rows: right, up and towards the eye; the longer horizontal side of the model runs across the page."""
    wide, deep, _ = np.ptp(points, axis=0)
    eye = np.array([0.45, -0.8, 0.4] if wide >= deep else [0.8, -0.45, 0.4])
    eye /= np.linalg.norm(eye)
    right = np.cross([0.0, 0.0, 1.0], eye)
    right /= np.linalg.norm(right)
    return np.array([right, np.cross(eye, right), eye])


class _Page(NamedTuple):
    """Place of the drawing on the page: user units = (x, -y) * scale - corner."""

    scale: float
    corner: Array
    height: float

    @classmethod
    def around(cls, points: Array, view: Array) -> _Page:
        flat = points @ view[:2].T * [1.0, -1.0]
        low, size = flat.min(axis=0), np.ptp(flat, axis=0)
        scale = float(min((WIDTH - 2 * MARGIN) / size[0], WIDTH / size[1]))
        spare = (WIDTH - scale * size[0]) / 2  # a tall structure stands in the middle
        return cls(scale, scale * low - [spare, MARGIN], float(np.ceil(scale * size[1] + 2 * MARGIN)))

    def path(self, flat: Array) -> str:
        """SVG path of the closed polygon `flat` (n, 2), given in m to the right and up."""
        places = flat * [self.scale, -self.scale] - self.corner
        return "M" + " ".join(f"{x:.1f},{y:.1f}".replace(".0", "") for x, y in places.tolist()) + "z"


def _drawn(name: str, kind: str, faces: polyhedron.Faces, body: Body, view: Array, page: _Page) -> Drawn:
    """The faces of a convex body that face the eye; they do not hide each other."""
    flat = body.points @ view[:2].T
    bright = body.normals @ LIGHT / np.linalg.norm(LIGHT)
    shades = np.clip(((1.0 - bright) / 2 * SHADES), 0, SHADES - 1).astype(int).tolist()
    seen = np.flatnonzero(body.normals @ view[2] > 1e-9).tolist()
    return Drawn(name, kind, tuple(Face(page.path(flat[list(faces[k])]), shades[k]) for k in seen))


def _outline(bodies: Sequence[Body], view: Array, page: _Page) -> str:
    hulls = shapely.convex_hull([shapely.multipoints(body.points @ view[:2].T) for body in bodies])
    # a hair wider, to close the slits between blocks that touch
    whole = shapely.buffer(shapely.union_all(hulls), 1.0 / page.scale, join_style="mitre")
    rings = [ring for part in shapely.get_parts(whole) for ring in (part.exterior, *part.interiors)]
    return "".join(page.path(shapely.get_coordinates(ring)[:-1]) for ring in rings)


def _axes(live: Array, view: Array) -> tuple[tuple[str, float, float], ...]:
    vectors = dict(zip("XYZ", np.eye(3), strict=True))
    if np.linalg.norm(live) > 0.0:
        vectors["live"] = live / np.linalg.norm(live)
    tips = {label: (view[:2] @ vector).tolist() for label, vector in vectors.items()}
    return tuple((label, round(x, 3), -round(y, 3)) for label, (x, y) in tips.items())
