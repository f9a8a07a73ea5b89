"""The report as PDF, with reportlab: `pip install limitblocks[pdf]`."""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import singledispatch
from io import BytesIO
from typing import Any
from xml.sax.saxutils import escape

from limitblocks.drawing.picture import Drawn, Picture
from limitblocks.drawing.sheet import WIDTH
from limitblocks.errors import MissingDependency
from limitblocks.reports.content import Bullets, Figure, Heading, Headline, Part
from limitblocks.reports.section import Table

CREATOR = "limitblocks report"
_MARGIN = 51.0  # points
_PAGE = (595.3, 841.9)  # A4, points
_TALLEST = 330.0  # of the drawing, points
_SAFE = str.maketrans({"−": "-", "≤": "<=", "≥": ">=", "✓": "", "✗": ""})
#: Hue, saturation and the lightness of the four shades, as on the screen.
_TINTS = {
    "moving": (24, 72, (84, 74, 62, 50)),
    "still": (212, 16, (84, 74, 62, 50)),
    "support": (212, 8, (58, 50, 42, 34)),
}


def pdf(parts: Iterable[Part], title: str) -> bytes:
    """Return the parts as a PDF document of A4 pages.

    Raises
    ------
    MissingDependency
        reportlab is not installed.
    """
    try:
        from reportlab.platypus import SimpleDocTemplate
    except ImportError:
        raise MissingDependency(
            "a PDF needs the package reportlab; install it by: pip install limitblocks[pdf]"
        ) from None
    stream = BytesIO()
    sides = dict.fromkeys(("leftMargin", "rightMargin", "topMargin", "bottomMargin"), _MARGIN)
    document = SimpleDocTemplate(stream, pagesize=_PAGE, title=title, creator=CREATOR, **sides)
    story = [flowable for part in parts for flowable in _flowables(part)]
    document.build(story, onFirstPage=_number, onLaterPages=_number)
    return stream.getvalue()


def marked(text: str) -> str:
    """Return `text` as reportlab's markup shows it; characters the fonts lack appear by their code."""
    latin = text.translate(_SAFE).replace("α", "\0").encode("cp1252", "backslashreplace").decode("cp1252")
    return escape(latin).replace("\0", "<greek>a</greek>")


def _paragraph(
    text: str,
    size: float = 9.0,
    *,
    bold: bool = False,
    space: float = 4.0,
    raw: bool = False,
    stays: bool = False,
) -> Any:
    """A paragraph of `size` points; `raw` text is markup already, `stays` with what follows."""
    from reportlab.lib.styles import ParagraphStyle
    from reportlab.platypus import Paragraph

    font = "Helvetica-Bold" if bold else "Helvetica"
    style = ParagraphStyle(
        "",
        fontName=font,
        fontSize=size,
        leading=1.3 * size,
        spaceAfter=space,
        splitLongWords=1,
        keepWithNext=stays,
    )
    return Paragraph(text if raw else marked(text), style)


@singledispatch
def _flowables(part: Part) -> list[Any]:
    return [_paragraph(str(part))]


@_flowables.register
def _(part: Heading) -> list[Any]:
    from reportlab.platypus import Spacer

    size = {1: 18.0, 2: 13.0}.get(part.level, 10.0)
    return [Spacer(1, 0.6 * size), _paragraph(part.text, size, bold=True, stays=True)]


@_flowables.register
def _(part: Headline) -> list[Any]:
    text = f'<font color="#8a2f00"><b>{marked(part.number)}</b></font>'
    return [_paragraph(f'{text} <font size="9">{marked(part.quantity)}</font>', 24.0, raw=True)]


@_flowables.register
def _(part: Bullets) -> list[Any]:
    return [_paragraph(f"• {line}", space=2.0) for line in part.lines]


@_flowables.register
def _(part: Figure) -> list[Any]:
    return [_drawing(part.picture), _paragraph(part.caption, 8.0)]


@_flowables.register
def _(part: Table) -> list[Any]:
    from reportlab.lib.colors import HexColor
    from reportlab.platypus import LongTable, Spacer

    wide = len(part.heads) > 5
    size = 6.0 if wide else 8.0
    cells = [[_paragraph(head, size, bold=True, space=0.0) for head in part.heads]]
    cells += [[_paragraph(cell, size, space=0.0) for cell in row] for row in part.rows]
    width = _PAGE[0] - 2 * _MARGIN - 12
    table = LongTable(cells, colWidths=[width * share for share in _shares(part)], repeatRows=1)
    rules = [("LINEBELOW", (0, 0), (-1, -1), 0.4, HexColor("#999999")), ("VALIGN", (0, 0), (-1, -1), "TOP")]
    table.setStyle([*rules, ("LEFTPADDING", (0, 0), (-1, -1), 0), ("RIGHTPADDING", (0, 0), (-1, -1), 5)])
    return [Spacer(1, 4), _paragraph(part.caption, 8.0, space=2.0, stays=True), table, Spacer(1, 6)]


def _shares(table: Table) -> list[float]:
    """Widths of the columns over that of the table, by the longest of their texts."""
    columns = zip(*(table.heads, *table.rows), strict=True)
    lengths = [min(max(map(len, column)), 60) + 2.0 for column in columns]
    return [length / sum(lengths) for length in lengths]


def _drawing(picture: Picture) -> Any:
    from reportlab.graphics.shapes import Drawing, Group

    scale = min((_PAGE[0] - 2 * _MARGIN - 12) / WIDTH, _TALLEST / picture.height)
    group = Group(transform=(scale, 0, 0, -scale, 0, scale * picture.height))
    for layer in (picture.ghosts, picture.blocks):
        for block in layer:
            for polygon in _polygons(block, scale):
                group.add(polygon)
    for points in _points(picture.outline):
        group.add(_polygon(points, None, 1.2 / scale, dashed=6 / scale))
    return Drawing(scale * WIDTH, scale * picture.height, group, hAlign="CENTER")


def _polygons(block: Drawn, scale: float) -> list[Any]:
    ghost = block.kind == "ghost"
    return [
        _polygon(points, None if ghost else _tint(block.kind, face.shade), 0.5 / scale, 3 / scale * ghost)
        for face in block.faces
        for points in _points(face.path)
    ]


def _polygon(points: list[float], fill: Any, width: float, dashed: float = 0.0) -> Any:
    from reportlab.graphics.shapes import Polygon
    from reportlab.lib.colors import HexColor

    dash = [dashed, dashed] if dashed else None
    return Polygon(
        points, fillColor=fill, strokeColor=HexColor("#22262c"), strokeWidth=width, strokeDashArray=dash
    )


def _tint(kind: str, shade: int) -> Any:
    from colorsys import hls_to_rgb

    from reportlab.lib.colors import Color

    hue, saturation, lightness = _TINTS[kind]
    return Color(*hls_to_rgb(hue / 360, lightness[shade] / 100, saturation / 100))


def _points(path: str) -> list[list[float]]:
    """Vertices x, y, x, y, ... of each closed polygon of an SVG path."""
    return [[float(number) for number in re.findall(r"-?[\d.]+", ring)] for ring in path.split("z") if ring]


def _number(canvas: Any, document: Any) -> None:
    canvas.setFont("Helvetica", 8)
    canvas.drawRightString(_PAGE[0] - _MARGIN, _MARGIN / 2, str(document.page))
