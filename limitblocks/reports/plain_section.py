"""What a report says of a result that has no section of its own."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from limitblocks.evidence.residuals import TOLERANCE
from limitblocks.model import Model
from limitblocks.reports.document import Table
from limitblocks.reports.section import Section
from limitblocks.reports.words import cut

_LEFT_OUT = ("analysis", "model_digest", "tolerance")


def plain_section(_model: Model, result: Any) -> Section:
    """Return the numbers, texts, rows and residuals that the result says of itself.

    Its title is the attribute `title` or else the word of its kind, its meaning the attribute `meaning` or
    else its line; `load_factor` is the headline if it has one. `rows()` become a table, `residuals`, held
    against `tolerance`, the checks, and `displacement_rates` a drawing.
    """
    said = result.to_dict()
    word, factor = str(said["analysis"]), getattr(result, "load_factor", None)
    residuals, tolerance = getattr(result, "residuals", None), getattr(result, "tolerance", TOLERANCE)
    rows = result.rows() if hasattr(result, "rows") else []
    return Section(
        title=getattr(result, "title", word.capitalize()),
        meaning=getattr(result, "meaning", str(result)),
        headline=word if factor is None else cut(factor),
        quantity=str(result) if factor is None else "load factor α",
        values=tuple(_values(said)),
        judged=(residuals, tolerance) if residuals else None,
        rates=getattr(result, "displacement_rates", None),
        parts=(_table(rows),) if rows else (),
    )


def _values(said: dict[str, Any]) -> Iterator[tuple[str, str, str]]:
    for key, value in said.items():
        if key not in _LEFT_OUT and isinstance(value, str | int | float):
            yield _head(key), _cell(value), ""


def _table(rows: list[dict[str, Any]]) -> Table:
    keys = list(dict.fromkeys(key for row in rows for key in row))
    numbers = [all(isinstance(row.get(key), int | float) for row in rows) for key in keys]
    right = tuple(k for k, number in enumerate(numbers) if number)
    cells = [[_cell(row.get(key, "")) for key in keys] for row in rows]
    return Table.of("Rows", tuple(map(_head, keys)), cells, right=right)


def _head(key: str) -> str:
    return key.replace("_", " ").capitalize()


def _cell(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.6g}" if isinstance(value, float) else str(value)
