"""The report on a terminal, and results one by one."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace
from io import StringIO
from typing import Any, Literal

from rich.console import Console
from rich.table import Table as RichTable
from rich.text import Text

from limitblocks.model import Model
from limitblocks.reports.chapters import chapter
from limitblocks.reports.document import Cell, Document, Figure, Heading, Headline, Items, Part, Table
from limitblocks.reports.document import Text as Text_
from limitblocks.reports.sections import section

_WIDTH = 100  # of the report as text
_COLUMNS, _WIDE = 8, 160  # of more columns a table may be as wide, before a name is broken over lines
_SCREEN = 24  # rows of tables beyond which what counts is scrolled away
_ROWS, _ENDS = 60, 8  # of a table at most; of a longer one the first and the last
_NUMBER = re.compile(r"[-+]?(\d+(\.\d*)?(e[-+]?\d+)?|nan|inf)")


def text(document: Document, width: int = _WIDTH) -> str:
    """Return the report as on a terminal `width` letters wide."""
    stream = StringIO()
    console = Console(file=stream, width=width, color_system=None, highlight=False, soft_wrap=False)
    console.print(Text(document.title, style="bold"))
    for name, value in (*document.about, ("Date", document.dated)):
        console.print(Text(f"{name}: {value}"))
    for line in document.notes.splitlines():
        console.print(Text(line))
    for one in document.chapters:
        console.print(Text(f"\n{one.title}\n{'=' * len(one.title)}", style="bold"))
        for part in one.parts:
            wide = isinstance(part, Table) and len(part.heads) > _COLUMNS
            console.width = max(width, _WIDE) if wide else width
            console.print(_renderable(part), crop=False)
    return stream.getvalue()


def print_result(model: Model, result: Any) -> None:
    """Print what a report says of `result`, without the drawings and the middle of long tables.

    What counts stands first, and last again where tables of many rows scroll it away.
    """
    said = section(model, result)
    head = (said.headline, "bold"), f"  {said.quantity}, {said.title}\n"
    headline = Text.assemble("\n  ", *head)  # Text: a name in brackets is not markup
    tables = [part for part in chapter(said, None, "").parts if isinstance(part, Table)]
    Console(soft_wrap=True).print(headline)
    Console().print(Text(said.meaning))
    for table in tables:
        Console().print(_table(_shortened(table)), crop=False)
    print_warnings(said.warnings)
    if sum(len(table.rows) for table in tables) > _SCREEN:
        Console(soft_wrap=True).print(headline)


def _shortened(part: Table) -> Table:
    """The table without the middle of its rows, where it has many, and how to see them."""
    left = len(part.rows) - 2 * _ENDS
    if len(part.rows) <= _ROWS:
        return part
    gap = (Cell("…"),) * len(part.rows[0])
    rows = (*part.rows[:_ENDS], gap, *part.rows[-_ENDS:])
    return replace(part, caption=f"{part.caption} ({left} rows left out: --json or --report FILE)", rows=rows)


def print_warnings(warnings: Iterable[str]) -> None:
    """Print a line for each warning."""
    for warning in warnings:
        Console(soft_wrap=True).print(f"warning: {warning}", style="yellow", markup=False, highlight=False)


def print_table(title: str, heads: tuple[str, ...], rows: Any) -> None:
    """Print rows of text in columns; without heads, the first column is the name of each row."""
    columns = enumerate(zip(*rows, strict=True)) if heads else ()
    right = tuple(k for k, cells in columns if all(map(_NUMBER.fullmatch, cells)))
    Console().print(_table(Table.of(title, heads, rows, right)), crop=False)


def _renderable(part: Part) -> Any:
    match part:
        case Text_():
            return Text(f"Warning: {part.text}" if part.warning else part.text, style="bold" * part.warning)
        case Heading():
            return Text(part.text, style="bold")
        case Items():
            return Text("\n".join(f"- {line}" for line in part.lines))
        case Headline():
            return Text(f"  {part.number}  {part.quantity}", style="bold")
        case Figure():
            legend = f" Colours: {', '.join(word for _, word in part.legend)}." if part.legend else ""
            return Text(f"Figure. {part.sheet.text} {part.caption}{legend}")
        case Table():
            return _table(part)


def _table(part: Table) -> RichTable:
    table = RichTable(
        title=Text(f"\n{part.caption}") if part.caption else None,
        title_justify="left",
        show_header=bool(part.heads),
        box=None,
        pad_edge=False,
    )
    for k, head in enumerate(part.heads):
        justify: Literal["left", "right"] = "right" if k in part.right else "left"
        table.add_column(Text(head), justify=justify, overflow="fold", min_width=_unbroken(part, k))
    if not part.heads:
        table.add_column(no_wrap=True)
        table.add_column(overflow="fold")
    for row in part.rows:
        table.add_row(*(Text(cell.text) for cell in row))  # Text: a name in brackets is not markup
    return table


def _unbroken(part: Table, column: int) -> int:
    """Letters of the longest number or word of the head: half of 2.5e-09 on its own line reads as another."""
    cells = (row[column].text for row in part.rows)
    numbers = (cell for cell in cells if _NUMBER.fullmatch(cell))
    return max(map(len, (*part.heads[column].split(), *numbers)), default=1)
