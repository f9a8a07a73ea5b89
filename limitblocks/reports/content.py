"""What a report says, part by part, for formats of plain text and tables."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

from limitblocks.drawing.picture import Picture
from limitblocks.io.result_file import versions
from limitblocks.reports.comparison import NOT_UNIQUE, comparison
from limitblocks.reports.facts import assumptions, fact_rows, facts
from limitblocks.reports.interfaces import active_interfaces
from limitblocks.reports.section import Section, Table

if TYPE_CHECKING:
    from limitblocks.reports.report import Report

RIGID = (
    "Blocks are rigid and do not break; displacements are small; joints carry no tension unless stated. "
    "N is negative in compression."
)
MECHANISM = (
    "Displacement rates of the mechanism; the shape of a mechanism is meant, its size is arbitrary. "
    "Dashed: the moving blocks before they moved."
)
MOST_ROWS = 40  # of the interfaces in a format that is read from top to bottom


class Heading(NamedTuple):
    """Title of what follows; level 1 is the title of the report."""

    level: int
    text: str


class Headline(NamedTuple):
    """A number to be read from afar, and what it is."""

    number: str
    quantity: str


class Bullets(NamedTuple):
    """A list of lines."""

    lines: tuple[str, ...]


class Figure(NamedTuple):
    """A drawing with its caption."""

    picture: Picture
    caption: str


Part = Heading | Headline | Bullets | Figure | Table | str


def content(report: Report) -> Iterator[Part]:
    """Yield the parts of a report in order; a text is a paragraph."""
    known = facts(report.model)
    yield Heading(1, report.title)
    yield f"limitblocks report, {report.date.isoformat(timespec='seconds')}"
    rows = comparison(report.results)
    if rows:
        yield Heading(2, "Side by side")
        yield Table("Load factors of this structure", ("Flow", "Load factor", "What it means"), rows)
        yield NOT_UNIQUE
    for one, result in zip(report.sections, report.results, strict=True):
        yield from _section(report, one)
        yield from _interfaces(report, one, result)
    warnings = [warning for one in report.sections for warning in one.warnings] + known["warnings"]
    if warnings:
        yield Heading(2, "Warnings")
        yield Bullets(tuple(warnings))
    yield Heading(2, "Model")
    yield Table("Facts", ("Quantity", "Value"), fact_rows(known))
    yield from _assumptions(report)
    yield Heading(2, "Origin")
    stated = (("Model, SHA-256", report.model.digest), *versions().items())
    yield Table("Model and versions", ("What", "Which"), stated)


def _section(report: Report, one: Section) -> Iterator[Part]:
    yield Heading(2, one.title)
    yield Headline(one.headline, one.quantity)
    yield Table("Result", ("Quantity", "Value", "From"), one.values)
    yield one.meaning
    if one is report.drawn and report.picture:
        yield Figure(report.picture, MECHANISM)
    if one.steps:
        yield one.steps
    caption = f"Residuals, recomputed without the solver; each at most {one.tolerance:.1e}"
    checks = tuple((c.name, f"{c.value:.1e}", c.meaning, "pass" if c.passed else "FAIL") for c in one.checks)
    yield Table(caption, ("Residual", "Value", "What it measures", "Check"), checks)


def _interfaces(report: Report, one: Section, result: object) -> Iterator[Part]:
    table = active_interfaces(report.model, result, one.title)
    if table is None:
        return
    rows = tuple(tuple(cell.text for cell in row) for row in table.rows[:MOST_ROWS])
    shown = f", {len(rows)} of them shown" if len(rows) < table.active else ""
    caption = f"Interfaces that do not stick: {table.active} of {table.interfaces}{shown}"
    yield Table(caption, table.heads, rows) if rows else caption


def _assumptions(report: Report) -> Iterator[Part]:
    yield Heading(2, "Assumptions")
    yield RIGID
    for joint, paragraphs in assumptions(report.model).items():
        yield Heading(3, joint)
        for paragraph in paragraphs:
            yield Bullets(tuple(paragraph["items"])) if paragraph["items"] else paragraph["text"]
