"""The report as one HTML document."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from limitblocks.drawing.picture import Picture
from limitblocks.io.result_file import versions
from limitblocks.reports import assets
from limitblocks.reports.comparison import NOT_UNIQUE, comparison
from limitblocks.reports.facts import assumptions, fact_rows, facts
from limitblocks.reports.interfaces import active_interfaces
from limitblocks.reports.scene import scene

if TYPE_CHECKING:
    from limitblocks.reports.report import Report

LAYERS = (
    ("blocks", "Blocks"),
    ("edges", "Edges"),
    ("glass", "See-through blocks"),
    ("interfaces", "Interfaces"),
    ("letters", "Letters"),
    ("forces", "Forces"),
    ("thrust", "Line of thrust"),
    ("before", "Before moving"),
)
_PLAIN_LAYERS = ("blocks", "edges", "glass", "interfaces")  # those that need no result


def page(report: Report) -> str:
    """Return the report as HTML that needs no other file and no network."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined
    from markupsafe import Markup

    environment = Environment(
        loader=FileSystemLoader(assets.FOLDER),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    known = facts(report.model)
    shown = scene(report.model, report.results, report.title)
    moving = [one["title"] for one in shown["results"]]
    return environment.get_template("report.html").render(
        title=report.title,
        date=report.date,
        sections=list(_sections(report)),
        comparison=comparison(report.results),
        not_unique=NOT_UNIQUE,
        warnings=[warning for one in report.sections for warning in one.warnings] + known["warnings"],
        model=fact_rows(known),
        assumptions=assumptions(report.model),
        digest=report.model.digest,
        versions=versions(),
        style=Markup(assets.style()),
        scripts=[Markup(script) for script in assets.scripts()],
        policy=assets.policy(),
        scene=Markup(assets.json_in_html(shown)),
        moving=moving,
        main=report.drawn,
        drawn=report.picture is not None,
        layers=[layer for layer in LAYERS if moving or layer[0] in _PLAIN_LAYERS],
        chosen=_chosen(report),
        summary=summary(known, moving, report.picture),
    )


def summary(known: dict[str, Any], moving: list[str], drawn: Picture | None) -> str:
    """Return the picture in a sentence or two, for those who do not see it."""
    supports = len(known["supports"])
    said = f"3D picture of {known['free_blocks']} blocks on {supports} support{'s' * (supports > 1)}"
    said += f" with {known['interfaces']} interfaces"
    if drawn is None:
        return said
    count = sum(block.kind == "moving" for block in drawn.blocks)
    return (
        f"{said}; mechanism and contact forces of: {', '.join(moving)}. "
        f"{count} blocks move, {drawn.largest} most; the tables below have the numbers."
    )


def _chosen(report: Report) -> int:
    """Place in the viewer of the result whose load factor heads the report."""
    moving = [one for one in report.sections if one.rates is not None]
    return moving.index(report.drawn) if report.drawn else 0


def _sections(report: Report) -> Any:
    """Each section with its static picture, its active interfaces and its place in the viewer."""
    place = 0
    for one, result in zip(report.sections, report.results, strict=True):
        table = active_interfaces(report.model, result, one.title)
        yield one, report.picture if one is report.drawn else None, table, place
        place += table is not None
