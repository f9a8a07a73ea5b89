"""What every result and model shows of itself, and how results are saved.

The rooms that draw and write are above this one; they are looked up when they are asked for, so that results
know no report and no file format.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path
from typing import Any

from limitblocks.arrays import Sealed


def many(number: int, word: str, words: str = "") -> str:
    """Return "1 block" or "2 blocks"; `words` where the plural takes more than an s."""
    return f"{number} {word if number == 1 else words or word + 's'}"


def coordinate(value: float) -> str:
    """Return a coordinate in m as text: four digits, and each millimetre however far from the origin."""
    return f"{round(value, 3):.15g}" if abs(value) >= 1.0 else f"{round(value, 6) + 0.0:.4g}"


def coordinates(point: Sequence[float]) -> str:
    """Return a point in m as text."""
    return f"({', '.join(map(coordinate, point))})"


class Shown(Sealed):
    """A line as its repr; in a notebook a small table and a picture."""

    def __repr__(self) -> str:
        return f"<{self}>"

    def _repr_html_(self) -> str:
        return str(_notebook().html(self))


class Viewed(Shown):
    """Something with blocks that move: it can be looked at from all sides."""

    def view(self, model: Any = None, *, height: int = 560) -> Any:
        """Return the interactive viewer of reports, which Jupyter and VS Code show below the cell.

        It needs no network and no extension.

        Parameters
        ----------
        model : Model, optional
            The structure; needed where the model of the result is not in memory any more.
        height : int
            Of the viewer, pixels.

        Raises
        ------
        ModelError
            The model is not known, or the result belongs to another one.
        """
        return _notebook().view(self, model, height)


class Tabular(Shown):
    """Something with rows."""

    def to_frame(self, model: Any = None) -> Any:
        """Return a pandas table: rows of their own where there are, else a row an interface.

        Rows of interfaces say what each does at collapse and what it carries, in SI units.

        Parameters
        ----------
        model : Model, optional
            The structure; needed where the model of the result is not in memory any more.

        Raises
        ------
        MissingDependency
            pandas is not installed.
        ModelError
            The model is not known, or the result belongs to another one.
        """
        return _notebook().frame(self, model)


class Saved(Tabular):
    """Something that a file keeps."""

    def save(self, file: str | Path, *, overwrite: bool = False) -> Path:
        """Write the result to a JSON file and return its path; :func:`limitblocks.read_result` reads it.

        Raises
        ------
        LimitBlocksError
            If the file exists and `overwrite` is false, or it cannot be written.
        """
        path: Path = import_module("limitblocks.io.result_file").write_result(self, file, overwrite=overwrite)
        return path


@dataclass(frozen=True, eq=False, repr=False)
class Result(Viewed, Saved):
    """What an analysis of one model returned.

    Attributes
    ----------
    from_file : bool
        Whether it was read: then all that it says of itself, its status and residuals too, is what the file
        says and no evidence. Reports and :func:`limitblocks.check_mcp` judge its numbers anew.
    """

    from_file: bool = field(default=False, kw_only=True)

    @property
    def _as_read(self) -> str:
        """What a line of it ends with."""
        return "; as a file says, not checked" if self.from_file else ""


def _notebook() -> Any:
    return import_module("limitblocks.notebook")
