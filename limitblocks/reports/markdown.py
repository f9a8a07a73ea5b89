"""The report as Markdown, for a repository, a wiki or a message."""

from __future__ import annotations

import re
from collections.abc import Iterator

from limitblocks.reports.document import Document, Figure, Heading, Headline, Items, Part, Table, Text

MARK = "<!-- limitblocks report -->"
_SPECIAL = re.compile(r"([\\`*_{}\[\]<>#|~$]|&(?=[#\w]))")  # an & alone is no entity
_LIST = re.compile(r"^(\s*)([-+]|\d+[.)])(?=\s|$)")  # what would begin a list at the start of a line


def markdown(document: Document) -> str:
    """Return the report as GitHub-flavoured Markdown; nothing in a name acts as markup."""
    return "\n\n".join(_paragraphs(document)) + "\n"


def escaped(text: str) -> str:
    """Return `text` so that Markdown shows it as it is, on one line."""
    line = _SPECIAL.sub(r"\\\1", " ".join(text.split()))
    return _LIST.sub(r"\1\\\2", line)


def written(part: Part) -> str:
    """Return a part as Markdown."""
    match part:
        case Text():
            return f"**Warning:** {escaped(part.text)}" if part.warning else escaped(part.text)
        case Heading():
            return f"### {escaped(part.text)}"
        case Items():
            return "\n".join(f"- {escaped(line)}" for line in part.lines)
        case Headline():
            return f"**{escaped(part.number)}** {escaped(part.quantity)}"
        case Figure():
            legend = ", ".join(escaped(word) for _, word in part.legend)
            colours = f" (colours: {legend})" if legend else ""
            return f"*Figure.* {escaped(part.sheet.text)} {escaped(part.caption)}{colours}"
        case Table():
            return _table(part)


def _paragraphs(document: Document) -> Iterator[str]:
    yield MARK
    yield f"# {escaped(document.title)}"
    about = (*document.about, ("Date", document.dated))
    yield "\n".join(f"- {escaped(name)}: {escaped(value)}" for name, value in about)
    yield from (escaped(line) for line in document.notes.splitlines() if line.strip())
    for chapter in document.chapters:
        yield f"## {escaped(chapter.title)}"
        yield from map(written, chapter.parts)


def _table(table: Table) -> str:
    rule = ["---:" if k in table.right else "---" for k in range(len(table.heads))]
    rows = [[escaped(cell.text) for cell in row] for row in table.rows]
    lines = [[escaped(head) for head in table.heads], rule, *rows]
    return f"{escaped(table.caption)}:\n\n" + "\n".join(f"| {' | '.join(line)} |" for line in lines)
