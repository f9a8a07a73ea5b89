"""The report as one HTML document, and the viewer as a document of its own."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

from limitblocks.reports import assets
from limitblocks.reports.document import Document, Figure
from limitblocks.shown import many

if TYPE_CHECKING:
    from jinja2 import Environment

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


def page(document: Document, scene: dict[str, Any], chosen: int) -> str:
    """Return the report as HTML that needs no other file and no network.

    `scene` is what the viewer shows, at first its result number `chosen`.
    """
    own = assets.printed(document.title, document.digest)
    styles = [assets.style(), own]
    drawn = any(result["magnification"] > 0.0 for result in scene["results"])
    parts = [part for one in document.chapters for part in one.parts]
    played = [part for part in parts if isinstance(part, Figure) and part.played]  # where the viewer would be
    known = {
        "document": document,
        "played": played,
        "drawn": drawn,
        "generator": document.versions["limitblocks"],
    }
    return _rendered("report.html", document.title, styles, scene, chosen, **known)


def viewer_page(scene: dict[str, Any], version: str) -> str:
    """Return the viewer alone as an HTML document, to be put into a frame of a notebook."""
    styles = [assets.style()]
    known = {"drawn": False, "generator": version}
    return _rendered("viewer_page.html", scene["title"], styles, scene, 0, **known)


@cache
def environment() -> Environment:
    """Return what finds and fills the templates."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    return Environment(
        loader=FileSystemLoader(assets.FOLDER),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )


def _rendered(
    template: str, title: str, styles: list[str], scene: dict[str, Any], chosen: int, **known: Any
) -> str:
    from markupsafe import Markup

    moving = [one["title"] for one in scene["results"]]
    return (
        environment()
        .get_template(template)
        .render(
            title=title,
            styles=[Markup(style) for style in styles],
            scripts=[Markup(script) for script in assets.scripts()],
            policy=assets.policy(styles),
            scene=Markup(assets.json_in_html(scene)),
            moving=moving,
            layers=[layer for layer in LAYERS if moving or layer[0] in _PLAIN_LAYERS],
            chosen=chosen,
            summary=_summary(scene, moving),
            **known,
        )
    )


def _summary(scene: dict[str, Any], moving: list[str]) -> str:
    """Return the picture in a sentence or two, for those who do not see it."""
    supports = len(scene["blocks"]["support"])
    free = len(scene["blocks"]["name"]) - supports
    said = f"3D picture of {many(free, 'block')} on {many(supports, 'support')}"
    said += f" with {many(len(scene['interfaces']['i']), 'interface')}"
    if not moving:
        return said
    return f"{said}; mechanism and contact forces of: {', '.join(moving)}. The tables have the numbers."
