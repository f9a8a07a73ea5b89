"""The chapters of a report: the answer, the model, what is assumed, each result, its origin."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from datetime import datetime
from typing import Any

from limitblocks.drawing.elevations import elevations
from limitblocks.drawing.picture import Picture
from limitblocks.drawing.ties import tie_lines
from limitblocks.evidence.residuals import Residuals
from limitblocks.io.result_file import versions
from limitblocks.model import Model
from limitblocks.reports.answer import UNDEMANDED, WARNING, answer, verdict
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
from limitblocks.reports.facts import assumptions, fact_rows
from limitblocks.reports.interfaces import ELEMENT_HEADS, HEADS, Active, active_interfaces, element_rows
from limitblocks.reports.labels import Labels
from limitblocks.reports.rows import NOT_UNIQUE, comparison
from limitblocks.reports.section import LEGEND, Section
from limitblocks.reports.words import acceleration

GENERAL = (
    "Blocks are rigid and do not break.",
    "Displacements are small: equilibrium is that of the structure as drawn.",
    "Joints carry no tension unless stated.",
    "Dead loads stay as they are; the live load grows in proportion to the load factor. Time, inertia and "
    "damage by repeated loading are left out: an acceleration is a static one.",
    "N is negative in compression.",
)
MECHANISM = (
    "Displacement rates of the mechanism, seen from the side to which it moves; the shape of a mechanism is "
    "meant, its size is arbitrary: rates at which the live load does the work 1 N m, drawn {:.3g} times, "
    "linearly. Dashed: the moving blocks before they moved."
)
VIEWS = "Front, side and plan at one scale, with the overall size of the blocks that can move."
SENSITIVE = "Sensitivity"  # how the title of the section of such a result begins
SENSITIVITY = (
    "How much the load factor changes with friction, unit weights and geometry is not in this report: "
    "no sensitivity was given to it."
)
STANDING = "Stability"  # how the title of the section of such a result begins
STANDS = (
    "Whether the structure stands under its dead loads by itself, or only by stresses that somebody would "
    "have to wedge in, is not in this report: no stability was given to it."
)
NOT_STATED = "not stated"
UNTITLED = "Limit analysis of a rigid-block structure"
OWN = (
    "It is the answer of the chapter {}. This report has no load factor to design with, and nothing is said "
    "about safety beyond what that chapter says."
)
JUDGED = "Safety: chapter {}: {}, {}."
UNCOMPARED = "Safety: the demand {:.15g} is not compared with anything."
TIED = (("tie-stick", "tie, from anchor to anchor"),)
VIEWED = (("still", "block that can move"), ("support", "support"))


def document(
    model: Model,
    results: Sequence[Any],
    sections: Sequence[Section],
    labels: Labels,
    date: datetime,
    known: dict[str, Any],
    drawn: Section | None,
    picture: Picture | None,
) -> Document:
    """Return the report on `model`: `known` are its facts, `picture` is the mechanism of section `drawn`."""
    title = labels.title or model.name or UNTITLED
    place = 0
    first = _answer(model, sections, labels)
    failed = tuple(Text(why, warning=True) for why in labels.failed)
    chapters = [Chapter(first.title, (*first.parts, *failed)), *_side_by_side(sections)]
    shown = []
    for one, result in zip(sections, results, strict=True):
        moving = picture if one is drawn else None
        table = _interfaces(model, result, place)
        shown.append(chapter(one, moving, title, table))
        place += bool(table)
    warnings = [warning for one in sections for warning in one.warnings] + known["warnings"]
    said = Items(tuple(warnings)) if warnings else Text("There are no warnings.")
    chapters += [_model(model, known), _assumptions(model), *shown]
    if not any(one.title.startswith(STANDING) for one in sections):
        chapters.append(Chapter(STANDING, (Text(STANDS),)))
    if not any(one.title.startswith(SENSITIVE) for one in sections):
        chapters.append(Chapter(SENSITIVE, (Text(SENSITIVITY),)))
    chapters.append(Chapter("Warnings", (said,)))
    chapters += [_findings(known), _origin(model)]
    about = (
        ("Project", labels.project or NOT_STATED),
        ("Author", labels.author or NOT_STATED),
        ("Structure", model.name or NOT_STATED),
    )
    return Document(title, about, labels.notes, date, model.digest, versions(), tuple(chapters))


def chapter(one: Section, picture: Picture | None, title: str, interfaces: Sequence[Part] = ()) -> Chapter:
    """Return what a report says of one result."""
    parts: list[Part] = [Headline(one.headline, one.quantity)]
    if one.values:
        parts.append(Table.of("Result", ("Quantity", "Value", "From"), one.values, right=(1,)))
    parts.append(Text(one.meaning))
    if picture:
        caption = MECHANISM.format(picture.magnification)
        ties = tuple((f"tie-{state}", f"tie: {state}") for state in dict.fromkeys(t[0] for t in picture.ties))
        parts.append(Figure(picture.sheet(f"Mechanism of {title}"), caption, (*LEGEND, *ties), played=True))
    if one.curve:
        parts.append(Figure(one.curve.sheet(), one.curve.caption))
    parts += [*interfaces, *one.parts]
    if one.judged:
        parts.append(_residuals(*one.judged))
    return Chapter(one.title, tuple(parts))


def _residuals(residuals: Residuals, tolerance: float) -> Table:
    caption = f"Residuals, recomputed without the solver; each at most {tolerance:.1e}"
    rows = [
        (one.name, f"{one.value:.1e}", one.meaning, "pass" if one.value <= tolerance else "FAIL")
        for one in residuals.entries
    ]
    return Table.of(caption, ("Residual", "Value", "What it measures", "Check"), rows, right=(1,))


def _answer(model: Model, sections: Sequence[Section], labels: Labels) -> Chapter:
    found = answer(sections)
    own = next((one for one in sections if one.own), None)
    if found.load_factor is None and own:
        said_alone = [Text(OWN.format(own.title))]
        said_alone += [] if labels.demand is None else [Text(UNCOMPARED.format(labels.demand))]
        return Chapter("Answer", (Headline(own.headline, own.quantity, main=True), *said_alone))
    parts: list[Part] = [Headline(found.number, found.quantity(model), main=True), Text(found.reason)]
    if found.load_factor is not None and not found.certified:
        parts.append(Text(WARNING, warning=True))
    parts += [Text(f"{remark[0].upper()}{remark[1:]}.", warning=True) for remark in found.remarks]
    said = verdict(found, labels.demand) if labels.demand is not None else None
    judged = [JUDGED.format(one.title, one.headline, one.quantity) for one in sections if one.judges]
    parts += [Text(words) for words in judged]
    if labels.demand is None:
        parts += [] if judged else [Text(UNDEMANDED)]
    elif said is None:
        parts.append(Text(UNCOMPARED.format(labels.demand)))
    else:
        parts.append(Text(f"Safety: {said.text}"))
    return Chapter("Load factor to design with", tuple(parts))


def _side_by_side(sections: Sequence[Section]) -> Iterator[Chapter]:
    rows = comparison(sections)
    if rows:
        heads = ("Flow", "Load factor", "What it means")
        table = Table.of("Load factors of this structure", heads, rows, right=(1,))
        yield Chapter("Side by side", (table, Text(NOT_UNIQUE)))


def _model(model: Model, known: dict[str, Any]) -> Chapter:
    parts: list[Part] = [
        Table.of("Facts", ("Quantity", "Value"), fact_rows(known)),
        Figure(elevations(model), VIEWS, (*VIEWED, *TIED) if tie_lines(model) else VIEWED),
    ]
    given = acceleration(model)
    if given:
        factor, words = given
        parts.append(Text(f"A load factor of 1 of the model's own live load is {words} of {factor:g} g."))
    return Chapter("Model", tuple(parts))


def _assumptions(model: Model) -> Chapter:
    parts: list[Part] = [Items(GENERAL)]
    for joint, sentences in assumptions(model).items():
        parts += [Heading(f"Joints: {joint}"), Items(tuple(sentences))]
    return Chapter("Assumptions", tuple(parts))


def _interfaces(model: Model, result: Any, place: int) -> tuple[Part, ...]:
    table = active_interfaces(model, result)
    if table is None:
        return ()
    elements = element_rows(model, result)
    tied = Table.of("Ties, dowels and passive fill", ELEMENT_HEADS, elements, right=(2, 3, 4))
    return (*_active(table, place), *((tied,) if elements else ()))


def _active(table: Active, place: int) -> tuple[Part, ...]:
    shown = f"; the {len(table.rows)} that move most" if len(table.rows) < table.active else ""
    caption = f"Interfaces that do not stick: {table.active} of {table.interfaces}{shown}"
    if not table.rows:
        return (Text(caption),)
    return (Table(f"{caption}. {table.note}", HEADS, table.rows, tuple(range(2, 10)), scene_result=place),)


def _findings(known: dict[str, Any]) -> Chapter:
    caption = f"What was looked for; {known['tolerances']}"
    return Chapter("Findings", (Table.of(caption, ("Looked for", "Found"), known["findings"]),))


def _origin(model: Model) -> Chapter:
    stated = (("Model, SHA-256", model.digest), *versions().items())
    return Chapter("Origin", (Table.of("Model and versions", ("What", "Which"), stated),))
