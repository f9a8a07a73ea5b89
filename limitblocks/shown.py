"""What every result and model shows of itself, and how results are saved.

The rooms that draw and write are above this one; they are looked up when they are asked for, so that results
know no report and no file format.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, fields, is_dataclass
from enum import Enum
from importlib import import_module
from math import floor, log10
from pathlib import Path
from typing import Any

import numpy as np

from limitblocks.arrays import Sealed

#: In files, where the key is not the field's name.
KEYS = {"digest": "model_digest", "limit": "backward_error_limit"}


def many(number: int, word: str, words: str = "") -> str:
    """Return "1 block" or "2 blocks"; `words` where the plural takes more than an s."""
    return f"{number} {word if number == 1 else words or word + 's'}"


def counted(words: Iterable[str]) -> dict[str, int]:
    """Return how often each word occurs that is not empty, the most frequent first."""
    return dict(Counter(filter(None, words)).most_common())


def rounded_down(ratio: float) -> str:
    """Return a ratio to three digits, never more than there is: neither .9996 is 1.00 nor 1 - 1e-13."""
    digits = 2 - floor(log10(abs(ratio))) if ratio else 2
    scale = 10.0**digits
    least = floor(ratio * scale * (1 + 1e-12)) / scale  # 3 is 3 where it is .3 / .1
    return f"{min(least, 0.999) if ratio < 1.0 else least:.{max(digits, 0)}f}"


def compared(ratio: float, form: str) -> str:
    """Return a ratio as text in a form such as ".3f", rounded down where it would be one that it is below."""
    text = format(ratio, form)
    return rounded_down(ratio) if ratio < 1.0 <= float(text) else text


def coordinate(value: float) -> str:
    """Return a coordinate in m as text: four digits, and each millimetre however far from the origin."""
    return f"{round(value, 3):.15g}" if abs(value) >= 1.0 else f"{round(value, 6) + 0.0:.4g}"


def coordinates(point: Sequence[float]) -> str:
    """Return a point in m as text."""
    return f"({', '.join(map(coordinate, point))})"


def kept(result: Any, *names: str) -> dict[str, Any]:
    """Return what a file keeps of a result under these names: plain numbers, lists and text."""
    return {KEYS.get(name, name): _plain(getattr(result, name)) for name in names}


def _plain(value: Any) -> Any:
    if hasattr(value, "to_dict"):
        return value.to_dict()
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, list | tuple):
        return [_plain(one) for one in value]
    if isinstance(value, dict):
        return dict(value)
    if is_dataclass(value):
        return kept(value, *(part.name for part in fields(value)))
    return value.value if isinstance(value, Enum) else value


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

    def _line(self, *parts: str) -> str:
        """Return the parts of its line as one, with a word where only a file says so."""
        return "; ".join((*parts, *("as a file says, not checked",) * self.from_file))


def _notebook() -> Any:
    return import_module("limitblocks.notebook")
