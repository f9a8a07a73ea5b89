"""A mechanism as one axonometric line drawing, back to front."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from limitblocks.arrays import Array
from limitblocks.drawing import sheet
from limitblocks.drawing.motion import STILL, displaced, magnification, travel
from limitblocks.drawing.painter import Body, painting_order, placed
from limitblocks.drawing.sheet import WIDTH, Group, Label, Shape, Sheet
from limitblocks.drawing.silhouette import outlines
from limitblocks.drawing.ties import moved, tie_lines
from limitblocks.drawing.view import towards, view_of
from limitblocks.geometry import polyhedron
from limitblocks.mechanics.loads.load import resultant
from limitblocks.model import Model
from limitblocks.shown import many

MARGIN = 12.0  # user units
MOST_GHOSTS = 500  # more moving blocks, and only the outline around them shows where they were
SHADES = 4
LIGHT = np.array([-0.35, -0.5, 0.8])
_FOOT, _ARM = 130.0, 44.0  # room for the axes, and their length


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
    ties : tuple of (str, str, str)
        State, name and SVG path of each tie from anchor to anchor; displaced.
    """

    height: float
    blocks: tuple[Drawn, ...]
    ghosts: tuple[Drawn, ...]
    outline: str
    axes: tuple[tuple[str, float, float], ...]
    magnification: float
    largest: str
    ties: tuple[tuple[str, str, str], ...] = ()

    @property
    def summary(self) -> str:
        """What is seen, in a sentence."""
        count = sum(block.kind == "moving" for block in self.blocks)
        moving = f"{count} of {many(len(self.blocks), 'block')} {'moves' if count == 1 else 'move'}"
        return f"{moving}, {self.largest} most."

    def sheet(self, title: str) -> Sheet:
        """Return the drawing with the axes below it."""
        layers = (*self.ghosts, *self.blocks)
        groups = [
            Group(one.kind, one.name, tuple(Shape(f.path, f"f{f.shade}") for f in one.faces))
            for one in layers
        ]
        groups += [Group(f"tie-{state}", name, (Shape(line),)) for state, name, line in self.ties]
        groups.append(Group("outline", "", (Shape(self.outline),) if self.outline else ()))
        arms, labels = [], []
        for name, x, y in self.axes:
            foot = np.array([260.0 if name == "live" else 90.0, self.height + 75.0])
            tip = foot + _ARM * np.array([x, y])
            arm = Shape(sheet.path(np.array([foot, tip]), closed=False))
            arms.append(Group("live" if name == "live" else "axis", "", (arm,)))
            side, off = ("start axis", 10.0) if x >= 0.0 else ("end axis", -10.0)
            labels.append(Label(float(tip[0]) + off, float(tip[1]) - 4.0, name, side))
        text = f"Axonometric drawing. {self.summary}"
        return Sheet("mechanism", title, text, self.height + _FOOT, (*groups, *arms), tuple(labels))


def mechanism_picture(
    model: Model, rates: Array, states: Sequence[str] = (), *, pushed: bool = True
) -> Picture:
    """Return the drawing of displacement rates (n, 6) of the blocks of `model`, from where they move to.

    `states` are those of its interfaces, in whose colours ties are drawn; all stick without them. An arrow
    shows where its live load points to, if it is `pushed` by one.
    """
    blocks = model.blocks
    middle = np.mean([block.centroid for block in blocks], axis=0)
    points = [block.vertices - middle for block in blocks]
    faces = [block.faces for block in blocks]
    scale, sizes = magnification(blocks, rates), travel(blocks, rates)
    view = view_of(towards(model, rates))
    before = [placed(p, f) for p, f in zip(points, faces, strict=True)]
    shifts = [displaced(block, rate) for block, rate in zip(blocks, rates, strict=True)]
    after = [placed(p + scale * s, f) for p, s, f in zip(points, shifts, faces, strict=True)]
    lines = tie_lines(model)
    anchors = [moved(model, line, scale * rates) - middle for line in lines]
    named = [(states[k] if states else "stick", model.interfaces[k].name) for k, *_ in lines]
    page = _Page.around(np.concatenate([*(body.points for body in (*before, *after)), *anchors]), view)
    moving = sizes > STILL * sizes.max()
    kinds = np.where(model.free, np.where(moving, "moving", "still"), "support").tolist()
    names = [block.name for block in blocks]
    drawn = [_drawn(*each, view, page) for each in zip(names, kinds, faces, after, strict=True)]
    shown = np.flatnonzero(moving).tolist()
    ghostly = shown if len(shown) <= MOST_GHOSTS else []
    ghosts = [_drawn(names[k], "ghost", faces[k], before[k], view, page) for k in ghostly]
    live = resultant(model.live, model.free_blocks) if pushed else np.zeros(3)
    rings = outlines([before[k].points for k in shown], view, 1.0 / page.scale)  # a hair, to close slits
    return Picture(
        height=page.height,
        blocks=tuple(drawn[k] for k in painting_order(after, view[2])),
        ghosts=tuple(ghosts[k] for k in painting_order([before[k] for k in ghostly], view[2])),
        outline="".join(page.path(ring[:-1]) for ring in rings),
        axes=_axes(live, view),
        magnification=scale,
        largest=names[int(sizes.argmax())],
        ties=tuple(
            (state, name, page.path(ends @ view[:2].T, closed=False))
            for (state, name), ends in zip(named, anchors, strict=True)
        ),
    )


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

    def path(self, flat: Array, *, closed: bool = True) -> str:
        """SVG path of the polygon or line `flat` (n, 2), given in m to the right and up."""
        return sheet.path(flat * [self.scale, -self.scale] - self.corner, closed=closed)


def _drawn(name: str, kind: str, faces: polyhedron.Faces, body: Body, view: Array, page: _Page) -> Drawn:
    """The faces of a convex body that face the eye; they do not hide each other."""
    flat = body.points @ view[:2].T
    bright = body.normals @ LIGHT / np.linalg.norm(LIGHT)
    shades = np.clip(((1.0 - bright) / 2 * SHADES), 0, SHADES - 1).astype(int).tolist()
    seen = np.flatnonzero(body.normals @ view[2] > 0.0).tolist()
    return Drawn(name, kind, tuple(Face(page.path(flat[list(faces[k])]), shades[k]) for k in seen))


def _axes(live: Array, view: Array) -> tuple[tuple[str, float, float], ...]:
    vectors = dict(zip("XYZ", np.eye(3), strict=True))
    if np.linalg.norm(live) > 0.0:
        vectors["live"] = live / np.linalg.norm(live)
    tips = {label: (view[:2] @ vector).tolist() for label, vector in vectors.items()}
    return tuple((label, round(x, 3), -round(y, 3)) for label, (x, y) in tips.items())
