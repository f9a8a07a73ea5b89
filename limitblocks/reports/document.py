"""What a report says, made once: every renderer shows this and computes nothing."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import NamedTuple

from limitblocks.drawing.sheet import Sheet


@dataclass(frozen=True)
class Text:
    """A paragraph; `warning` where a reader must not miss it."""

    text: str
    warning: bool = False


@dataclass(frozen=True)
class Items:
    """A list of sentences."""

    lines: tuple[str, ...]


@dataclass(frozen=True)
class Heading:
    """Title of a part of a chapter."""

    text: str


@dataclass(frozen=True)
class Headline:
    """A number and what it is; `main` is the one number of a report to be read from afar."""

    number: str
    quantity: str
    main: bool = False


class Cell(NamedTuple):
    """Text of a cell, and the number it sorts by; None for text."""

    text: str
    value: float | None = None


@dataclass(frozen=True)
class Table:
    """Rows of text under a caption.

    Attributes
    ----------
    caption : str
    heads : tuple of str
        Of the columns.
    rows : tuple of tuple of Cell
        The first cell names its row.
    right : tuple of int
        Columns of numbers.
    scene_result : int, optional
        Place in the viewer of the result whose interfaces the rows are; a browser sorts such a table.
    """

    caption: str
    heads: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]
    right: tuple[int, ...] = ()
    scene_result: int | None = None

    @classmethod
    def of(
        cls, caption: str, heads: Sequence[str], rows: Sequence[Sequence[str]], right: tuple[int, ...] = ()
    ) -> Table:
        """Return the table of rows of text."""
        return cls(caption, tuple(heads), tuple(tuple(map(Cell, row)) for row in rows), right)


@dataclass(frozen=True)
class Figure:
    """A drawing with its caption and its legend: style and word of each colour.

    One that is `played` is in the viewer, too, whose picture takes its place on the screen.
    """

    sheet: Sheet
    caption: str
    legend: tuple[tuple[str, str], ...] = ()
    played: bool = False


Part = Text | Items | Heading | Headline | Table | Figure


@dataclass(frozen=True)
class Chapter:
    """Parts under a title."""

    title: str
    parts: tuple[Part, ...]


@dataclass(frozen=True)
class Document:
    """A report.

    Attributes
    ----------
    title : str
    about : tuple of (str, str)
        Project, author and the like, and what is stated.
    notes : str
        What the author adds.
    date : datetime
        When it was made.
    digest : str
        SHA-256 of the model.
    versions : dict of str
        Versions of the packages that the numbers come from.
    chapters : tuple of Chapter
        The first has the number to design with.
    """

    title: str
    about: tuple[tuple[str, str], ...]
    notes: str
    date: datetime
    digest: str
    versions: dict[str, str]
    chapters: tuple[Chapter, ...]

    @property
    def dated(self) -> str:
        """The date as text."""
        return self.date.strftime("%Y-%m-%d %H:%M %z").strip()

    def facts(self) -> Iterator[str]:
        """Yield every text of the report, that of drawings in the words for those who do not see them."""
        yield from (self.title, *(text for row in self.about for text in row), *self.notes.splitlines())
        for chapter in self.chapters:
            yield chapter.title
            for part in chapter.parts:
                yield from texts(part)


def texts(part: Part) -> Iterator[str]:
    """Yield every text of a part."""
    match part:
        case Text() | Heading():
            yield part.text
        case Items():
            yield from part.lines
        case Headline():
            yield from (part.number, part.quantity)
        case Table():
            yield from (part.caption, *part.heads, *(cell.text for row in part.rows for cell in row))
        case Figure():
            yield from (part.caption, part.sheet.text, *(word for _, word in part.legend))
