"""The report as PDF, with reportlab, which the extra `pdf` installs."""

from __future__ import annotations

import re
from collections.abc import Iterator
from io import BytesIO
from typing import Any
from xml.sax.saxutils import escape

from limitblocks.io.packages import missing
from limitblocks.reports.document import (
    Chapter,
    Document,
    Figure,
    Heading,
    Headline,
    Items,
    Part,
    Table,
    Text,
)

CREATOR = "limitblocks report"
_MARGIN = 51.0  # points
_PAGE = (595.3, 841.9)  # A4, points
_WIDE = _PAGE[0] - 2 * _MARGIN - 12
_GAP, _PADDING = 7.0, 8.0  # between columns, points; and a little for rounding
_SAFE = str.maketrans({"−": "-", "≤": "<=", "≥": ">="})
GREEK = {"α": "a", "γ": "g", "δ": "d", "ζ": "z", "ξ": "x", "π": "p", "ψ": "y", "Σ": "S"}  # in its symbol font


def pdf(document: Document) -> bytes:
    """Return the report as a PDF document of A4 pages: title above, hash and number of the page below.

    Raises
    ------
    MissingDependency
        reportlab is not installed.
    """
    try:
        from reportlab.platypus import SimpleDocTemplate
    except ImportError:
        raise missing("reportlab", "a PDF") from None
    from limitblocks.reports.pdf_drawing import numbered

    stream = BytesIO()
    sides = dict.fromkeys(("leftMargin", "rightMargin", "topMargin", "bottomMargin"), _MARGIN)
    author = dict(document.about).get("Author", "")
    named = {"title": document.title, "author": author, "creator": CREATOR}
    template = SimpleDocTemplate(stream, pagesize=_PAGE, invariant=1, **named, **sides)
    made = numbered(latin(document.title), document.digest, document.date)
    template.build(list(_story(document)), canvasmaker=made)
    return stream.getvalue()


def latin(text: str) -> str:
    """Return `text` in the characters of the standard fonts; others appear by their code."""
    return text.translate(_SAFE).encode("cp1252", "backslashreplace").decode("cp1252")


def marked(text: str) -> str:
    """Return `text` as reportlab's markup shows it; characters the fonts lack appear by their code."""
    parts = re.split(f"([{''.join(GREEK)}])", text)
    return "".join(
        f"<greek>{GREEK[part]}</greek>" if part in GREEK else escape(latin(part)) for part in parts
    )


def _story(document: Document) -> Iterator[Any]:
    yield _paragraph(document.title, 18.0, bold=True)
    about = (*document.about, ("Date", document.dated))
    yield from (_paragraph(f"{name}: {value}", space=1.0) for name, value in about)
    yield from (_paragraph(line) for line in document.notes.splitlines() if line.strip())
    for chapter in document.chapters:
        yield from _chapter(chapter)


def _chapter(chapter: Chapter) -> Iterator[Any]:
    from reportlab.platypus import CondPageBreak, Spacer

    # room for what follows the title; reportlab's keepWithNext would move a whole table with it
    yield CondPageBreak(150.0)
    yield Spacer(1, 8)
    yield _paragraph(chapter.title, 13.0, bold=True)
    for part in chapter.parts:
        yield from flowables(part)


def flowables(part: Part) -> list[Any]:
    """Return a part as reportlab lays it out."""
    from reportlab.platypus import CondPageBreak

    match part:
        case Text():
            return [_paragraph(part.text, bold=part.warning)]
        case Heading():
            return [CondPageBreak(60.0), _paragraph(part.text, 10.0, bold=True)]
        case Items():
            return [_paragraph(f"• {line}", space=2.0) for line in part.lines]
        case Headline():
            number = f'<font color="#8a2f00"><b>{marked(part.number)}</b></font>'
            if not part.main:
                return [_paragraph(f"{number} {marked(part.quantity)}", 11.0, raw=True)]
            return [_paragraph(number, 26.0, space=1.0, raw=True), _paragraph(part.quantity, 10.0)]
        case Figure():
            return _figure(part)
        case Table():
            return _table(part)


def _paragraph(
    text: str,
    size: float = 9.0,
    *,
    bold: bool = False,
    space: float = 4.0,
    raw: bool = False,
    right: bool = False,
) -> Any:
    """A paragraph of `size` points; `raw` text is markup already."""
    from reportlab.lib.enums import TA_LEFT, TA_RIGHT
    from reportlab.lib.styles import ParagraphStyle
    from reportlab.platypus import Paragraph

    style = ParagraphStyle(
        "",
        fontName="Helvetica-Bold" if bold else "Helvetica",
        fontSize=size,
        leading=1.3 * size,
        spaceAfter=space,
        splitLongWords=1,
        alignment=TA_RIGHT if right else TA_LEFT,
    )
    return Paragraph(text if raw else marked(text), style)


def _figure(part: Figure) -> list[Any]:
    from reportlab.platypus import KeepTogether

    from limitblocks.reports.pdf_drawing import drawing, legend

    parts = [drawing(part.sheet, _WIDE, latin)]
    parts += [legend(part.legend, _WIDE, latin)] if part.legend else []
    parts += [_paragraph(text, 8.0, space=2.0) for text in (part.sheet.text, part.caption)]
    return [KeepTogether(parts)]


def _table(part: Table) -> list[Any]:
    from reportlab.lib.colors import HexColor
    from reportlab.platypus import CondPageBreak, LongTable, Spacer

    crowded = len(part.heads) > 5 and sum(_wanted(part, 8.0)) > _WIDE
    size = 6.0 if crowded else 8.0
    numbers = [k in part.right for k in range(len(part.heads))]
    cells = [
        [
            _paragraph(head, size, bold=True, space=0.0, right=r)
            for head, r in zip(part.heads, numbers, strict=True)
        ]
    ]
    cells += [
        [_paragraph(cell.text, size, space=0.0, right=r) for cell, r in zip(row, numbers, strict=True)]
        for row in part.rows
    ]
    table = LongTable(cells, colWidths=_widths(part, size), repeatRows=1)
    rules = [("LINEBELOW", (0, 0), (-1, -1), 0.4, HexColor("#999999")), ("VALIGN", (0, 0), (-1, -1), "TOP")]
    table.setStyle([*rules, ("LEFTPADDING", (0, 0), (-1, -1), 0), ("RIGHTPADDING", (0, 0), (-1, -1), _GAP)])
    caption = _paragraph(part.caption, 8.0, space=2.0)
    # the caption, the heads and two rows stay on one page
    return [Spacer(1, 4), CondPageBreak(5 * 1.6 * size + 16), caption, table, Spacer(1, 6)]


def _widths(table: Table, size: float) -> list[float]:
    """Widths of the columns, points: as wide as their texts, the widest ones less where that is too much."""
    wanted = _wanted(table, size)
    left, widths = _WIDE, [0.0] * len(wanted)
    for rank, k in enumerate(sorted(range(len(wanted)), key=wanted.__getitem__)):
        widths[k] = min(wanted[k], left / (len(wanted) - rank))
        left -= widths[k]
    words = [k for k in range(len(widths)) if k not in table.right]
    widths[max(words, default=-1)] += left  # what is to spare, so that the rules run across the page
    return widths


def _wanted(table: Table, size: float) -> list[float]:
    """Widths at which no text of a column is broken, points."""
    from reportlab.pdfbase.pdfmetrics import stringWidth

    columns = zip(*(table.heads, *([cell.text for cell in row] for row in table.rows)), strict=True)
    return [
        max(stringWidth(latin(text), "Helvetica-Bold", size) for text in column) + _PADDING
        for column in columns
    ]
