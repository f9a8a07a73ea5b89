"""The report as Markdown, for a repository, a wiki or a message."""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import singledispatch
from itertools import chain

from limitblocks.reports.content import Bullets, Figure, Heading, Headline, Part
from limitblocks.reports.section import Table

MARK = "<!-- limitblocks report -->"
_SPECIAL = re.compile(r"([\\`*_{}\[\]<>#|~$&])")
_LIST = re.compile(r"^(\s*)([-+]|\d+[.)])(?=\s|$)")  # what would begin a list at the start of a line


def markdown(parts: Iterable[Part]) -> str:
    """Return the parts as GitHub-flavoured Markdown; nothing in a name acts as markup."""
    return "\n\n".join(chain([MARK], (text for text in map(_written, parts) if text))) + "\n"


def escaped(text: str) -> str:
    """Return `text` so that Markdown shows it as it is, on one line."""
    line = _SPECIAL.sub(r"\\\1", " ".join(text.split()))
    return _LIST.sub(r"\1\\\2", line)


@singledispatch
def _written(part: Part) -> str:
    return escaped(str(part))


@_written.register
def _(part: Heading) -> str:
    return f"{'#' * part.level} {escaped(part.text)}"


@_written.register
def _(part: Headline) -> str:
    return f"**{escaped(part.number)}** {escaped(part.quantity)}"


@_written.register
def _(part: Bullets) -> str:
    return "\n".join(f"- {escaped(line)}" for line in part.lines)


@_written.register
def _(_part: Figure) -> str:
    return ""


@_written.register
def _(part: Table) -> str:
    rule = ["---:" if head.startswith(("Value", "Load factor")) else "---" for head in part.heads]
    lines = [part.heads, rule, *part.rows]
    cells = [[cell if cells is rule else escaped(cell) for cell in cells] for cells in lines]
    table = "\n".join(f"| {' | '.join(row)} |" for row in cells)
    return f"{escaped(part.caption)}:\n\n{table}"
