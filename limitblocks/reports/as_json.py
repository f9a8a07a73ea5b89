"""The report as plain dictionaries, lists and text for JSON."""

from __future__ import annotations

from typing import Any

from limitblocks.io.faults import REPORT
from limitblocks.reports.document import Document, Figure, Heading, Headline, Items, Part, Table, Text

REPORT_SCHEMA_VERSION = 2


def as_dict(document: Document) -> dict[str, Any]:
    """Return the texts of a report; each part has one key, which says what it is."""
    return {
        "format": REPORT,
        "schema_version": REPORT_SCHEMA_VERSION,
        "title": document.title,
        "about": dict(document.about),
        "notes": document.notes,
        "date": document.date.isoformat(timespec="seconds"),
        "digest": document.digest,
        "versions": document.versions,
        "chapters": [
            {"title": chapter.title, "parts": [_part(part) for part in chapter.parts]}
            for chapter in document.chapters
        ],
    }


def _part(part: Part) -> dict[str, Any]:
    match part:
        case Text(text=text, warning=warning):
            return {"warning" if warning else "text": text}
        case Heading():
            return {"heading": part.text}
        case Items():
            return {"items": list(part.lines)}
        case Headline():
            return {"headline": {"number": part.number, "quantity": part.quantity}}
        case Table():
            rows = [[cell.text for cell in row] for row in part.rows]
            return {"table": {"caption": part.caption, "heads": list(part.heads), "rows": rows}}
        case Figure():
            words = {"caption": part.caption, "shows": part.sheet.text}
            return {"figure": words | {"legend": [word for _, word in part.legend]}}
