"""Drawings of the report for reportlab, and what stands above and below every page."""

from __future__ import annotations

from collections.abc import Callable
from colorsys import hls_to_rgb
from datetime import UTC, datetime
from typing import Any

from reportlab.graphics.shapes import Circle, Drawing, Group, Polygon, PolyLine, Rect, String
from reportlab.lib.colors import Color, HexColor
from reportlab.pdfgen.canvas import Canvas

from limitblocks.drawing.sheet import WIDTH, Label, Sheet, polylines
from limitblocks.drawing.sheet import Group as Shapes

_TALLEST = 330.0  # points
_SIDE, _FOOT, _SIZE = 51.0, 25.0, 7.0  # points
_LONGEST = 90  # letters of the title above a page
_INK, _QUIET, _RULE, _ACCENT = "#22262c", "#5b636e", "#d4d9df", "#a63c06"
#: Hue, saturation and the lightness of the four shades, as on the screen.
_TINTS = {
    "moving": (24, 72, (84, 74, 62, 50)),
    "still": (212, 16, (84, 74, 62, 50)),
    "support": (212, 8, (58, 50, 42, 34)),
}
#: Colour and width, points, of the lines of a group, and of their dashes.
_LINES = {
    "ghost": (_QUIET, 0.5, 3.0),
    "outline": (_INK, 1.0, 5.0),
    "axis": (_QUIET, 1.2, 0.0),
    "live": (_ACCENT, 1.6, 0.0),
    "grid": (_RULE, 0.5, 0.0),
    "line": (_ACCENT, 1.2, 0.0),
    "dimension": (_QUIET, 0.6, 0.0),
    "tie-stick": (_INK, 1.6, 0.0),
    "tie-yield": ("#a6093d", 2.2, 0.0),
    "tie-slack": (_QUIET, 1.2, 3.0),
}
_LETTER = 17.0  # user units


def drawing(sheet: Sheet, wide: float, latin: Callable[[str], str]) -> Drawing:
    """Return a drawing at most `wide` points wide; `latin` makes texts printable."""
    scale = min(wide / WIDTH, _TALLEST / sheet.height)
    group = Group(transform=(scale, 0, 0, -scale, 0, scale * sheet.height))
    for shapes in sheet.groups:
        for line in _lines(shapes, scale):
            group.add(line)
    for dot in sheet.dots:
        group.add(Circle(dot.x, dot.y, 4.0, fillColor=HexColor(_ACCENT), strokeColor=None))
    for label in sheet.labels:
        group.add(_label(label, latin))
    return Drawing(scale * WIDTH, scale * sheet.height, group, hAlign="CENTER")


def legend(entries: tuple[tuple[str, str], ...], wide: float, latin: Callable[[str], str]) -> Drawing:
    """Return a row of colours with their words."""
    row, x = Drawing(wide, 14.0), 0.0
    for style, word in entries:
        line, _, dashed = _LINES.get(style, (_INK, 0.5, 0.0))
        fill = _tint(style, 1) if style in _TINTS else None if dashed else HexColor(line)
        dash = None if fill else [2, 2]
        row.add(
            Rect(
                x, 3, 11, 8, fillColor=fill, strokeColor=HexColor(_INK), strokeWidth=0.5, strokeDashArray=dash
            )
        )
        row.add(String(x + 15, 4, latin(word), fontName="Helvetica", fontSize=8))
        x += 15 + 4.2 * len(word) + 22
    return row


def _lines(shapes: Shapes, scale: float) -> list[Any]:
    drawn = []
    for shape in shapes.shapes:
        fill = _tint(shapes.style, int(shape.style[1])) if shapes.style in _TINTS else None
        colour, width, dash = _LINES.get(shapes.style, (_INK, 0.5, 0.0))
        style = {
            "strokeColor": HexColor(colour),
            "strokeWidth": width / scale,
            "strokeDashArray": [dash / scale, dash / scale] if dash else None,
        }
        for points, closed in polylines(shape.path):
            drawn.append(Polygon(points, fillColor=fill, **style) if closed else PolyLine(points, **style))
    return drawn


def _label(label: Label, latin: Callable[[str], str]) -> Group:
    text = String(
        0, 0, latin(label.text), fontName="Helvetica", fontSize=_LETTER, fillColor=HexColor(_QUIET),
        textAnchor=label.style.split()[0],
    )  # fmt: skip
    # the page's y axis points upwards again for texts
    turned = (0, -1, -1, 0, label.x, label.y) if label.upwards else (1, 0, 0, -1, label.x, label.y)
    return Group(text, transform=turned)


def _tint(kind: str, shade: int) -> Color:
    hue, saturation, lightness = _TINTS[kind]
    return Color(*hls_to_rgb(hue / 360, lightness[shade] / 100, saturation / 100))


def numbered(title: str, digest: str, date: datetime) -> type[Canvas]:
    """Return a canvas that writes title, hash and "page k of n", known only when all pages are there.

    The file is dated as the report is, whenever it is saved.
    """

    class Numbered(Canvas):  # type: ignore[misc] # reportlab has no types
        def __init__(self, *args: Any, **settings: Any) -> None:
            super().__init__(*args, **settings)
            self._pages: list[dict[str, Any]] = []
            self.setDateFormatter(lambda *_: f"{date.astimezone(UTC):D:%Y%m%d%H%M%SZ}")

        def showPage(self) -> None:
            self._pages.append(dict(self.__dict__))
            self._startPage()

        def save(self) -> None:
            for number, state in enumerate(self._pages, start=1):
                self.__dict__.update(state)
                _margins(self, title, digest, f"Page {number} of {len(self._pages)}")
                super().showPage()
            super().save()

    return Numbered


def _margins(canvas: Canvas, title: str, digest: str, number: str) -> None:
    wide, tall = canvas._pagesize
    canvas.setFont("Helvetica", _SIZE)
    canvas.drawString(
        _SIDE, tall - _FOOT - _SIZE, title if len(title) <= _LONGEST else f"{title[:_LONGEST]}..."
    )
    canvas.drawRightString(wide - _SIDE, tall - _FOOT - _SIZE, "limitblocks report")
    canvas.drawString(_SIDE, _FOOT, f"Model {digest}")
    canvas.drawRightString(wide - _SIDE, _FOOT, number)
