"""Tables of results: rows of plain numbers and text, as lines of text and CSV."""

from __future__ import annotations

import csv
import io
from abc import abstractmethod
from collections.abc import Iterable
from math import inf, isnan, nan
from pathlib import Path
from typing import Any, ClassVar

from limitblocks.errors import ModelError
from limitblocks.shown import Saved
from limitblocks.written import write


class Rows(Saved):
    """A result that is a table; `units` has those of the columns that have one, by name."""

    units: ClassVar[dict[str, str]] = {}

    @abstractmethod
    def rows(self) -> list[dict[str, Any]]:
        """Return rows of the same keys, plain numbers and text."""

    def table(self) -> str:
        """Return the rows as lines of text in columns."""
        rows = self.rows()
        cells = [[*map(self.head, rows[0])]] + [row_in_short(row) for row in rows]
        widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
        lines = [[cell.ljust(width) for cell, width in zip(line, widths, strict=True)] for line in cells]
        return "\n".join("  ".join(line).rstrip() for line in lines)

    def head(self, name: str) -> str:
        """Return the name of a column with its unit."""
        return f"{name}, {self.units[name]}" if name in self.units else name

    def write_csv(self, file: str | Path, *, overwrite: bool = False) -> Path:
        """Write the rows to a CSV file (UTF-8, commas, a line of names first) and return its path.

        Raises
        ------
        LimitBlocksError
            If the file exists and `overwrite` is false, or it cannot be written.
        """
        return write_csv(self.rows(), file, overwrite=overwrite)


def refuse_column(parameter: str, columns: Iterable[str]) -> None:
    """Raise ModelError where a parameter has the name of a column of results: one would hide the other."""
    if parameter in columns:
        raise ModelError(
            f"a parameter has the name {parameter!r} of a column of the results; give it another one"
        )


def write_csv(rows: list[dict[str, Any]], file: str | Path, *, overwrite: bool = False) -> Path:
    """Write rows of the same keys to a CSV file and return its path; see :meth:`Rows.write_csv`."""
    stream = io.StringIO(newline="")
    writer = csv.DictWriter(stream, list(rows[0]))
    writer.writeheader()
    writer.writerows(rows)
    return write(file, stream.getvalue(), overwrite)


def in_short(value: Any) -> str:
    """Return a cell as text, numbers with six digits; a word where there is none, or no limit to it."""
    if not isinstance(value, float):
        return str(value)
    return "none" if isnan(value) else "unlimited" if value == inf else f"{value:.6g}"


def row_in_short(row: dict[str, Any]) -> list[str]:
    """Return the cells of a row of a study as text, residuals with two digits as everywhere."""
    residual = row.get("worst_residual", nan)
    said = {} if isnan(residual) else {"worst_residual": f"{residual:.1e}"}
    return [said.get(name) or in_short(value) for name, value in row.items()]
