"""A report: one HTML file that needs nothing else, and the same content as JSON."""

from __future__ import annotations

from dataclasses import dataclass, field
from datetime import datetime
from functools import cached_property
from pathlib import Path
from typing import Any

from limitblocks.analysis.bounds import Bounds
from limitblocks.analysis.results import LoadPath, Nonassociated
from limitblocks.errors import LimitBlocksError
from limitblocks.io import strict_json
from limitblocks.io.result_file import versions
from limitblocks.model import Model
from limitblocks.report.comparison import comparison
from limitblocks.report.facts import assumptions, facts
from limitblocks.report.page import page
from limitblocks.report.picture import Picture, mechanism_picture
from limitblocks.report.sections import Section, section

_MARK = '<meta name="generator" content="limitblocks '
_MARK_WITHIN = 4096  # bytes from the start of the file
_DRAWN = (Nonassociated, LoadPath, Bounds)  # the mechanism of the first kind there is; one says enough


@dataclass(frozen=True, eq=False)
class Report:
    """Results of analyses of one model, to be filed and shown; made by :func:`report`.

    Attributes
    ----------
    model : Model
        The structure.
    results : tuple
        Results of its analyses.
    date : datetime
        When the report was made.
    """

    model: Model
    results: tuple[Any, ...]
    date: datetime = field(default_factory=lambda: datetime.now().astimezone())

    @cached_property
    def sections(self) -> tuple[Section, ...]:
        """What the report says of each result."""
        return tuple(section(self.model, result) for result in self.results)

    def to_dict(self) -> dict[str, Any]:
        """Return the content as plain numbers, lists and text; SI units."""
        return {
            "title": self.title,
            "date": self.date.isoformat(timespec="seconds"),
            "versions": versions(),
            "model": facts(self.model),
            "assumptions": assumptions(self.model),
            "comparison": [list(row) for row in comparison(self.results)],
            "results": [result.to_dict() for result in self.results],
        }

    @property
    def json(self) -> str:
        """The content as JSON text."""
        return strict_json.text(self.to_dict())

    @property
    def title(self) -> str:
        """Title of the report."""
        return self.model.name or "Limit analysis of a rigid-block structure"

    @cached_property
    def html(self) -> str:
        """The report as one HTML document without references to other files."""
        return page(self)

    @cached_property
    def drawn(self) -> Section | None:
        """The section whose mechanism is drawn: one says enough."""
        kinds = {type(result): made for result, made in zip(self.results, self.sections, strict=True)}
        return next((kinds[kind] for kind in _DRAWN if kind in kinds), None)

    @cached_property
    def picture(self) -> Picture | None:
        """The static drawing of that mechanism, for print and where no 3D graphics are to be had."""
        rates = self.drawn.rates if self.drawn else None
        return None if rates is None else mechanism_picture(self.model, rates)

    def save(self, file: str | Path, *, overwrite: bool | None = None) -> Path:
        """Write the report as HTML and return its path.

        Parameters
        ----------
        file : str or Path
            Name of the file.
        overwrite : bool, optional
            Whether to replace a file that exists; by default only one that limitblocks wrote.

        Raises
        ------
        LimitBlocksError
            The file exists and may not be replaced, or it cannot be written.
        """
        path, html = Path(file), self.html
        try:
            if overwrite or (overwrite is None and _ours(path)):
                path.write_text(html, encoding="utf-8")
            else:
                with path.open("x", encoding="utf-8") as stream:
                    stream.write(html)
        except FileExistsError:
            said = "exists" if overwrite is False else "exists and was not written by limitblocks"
            raise LimitBlocksError(f"{path} {said}; give another name or overwrite=True") from None
        except OSError as error:
            raise LimitBlocksError(f"cannot write {path}: {error.strerror}") from None
        return path


def report(model: Model, *results: Any) -> Report:
    """Return a report on `model` and the results of its analyses.

    Parameters
    ----------
    model : Model
        The structure.
    *results
        What the analyses of this model returned, such as :class:`limitblocks.Bounds`.

    Raises
    ------
    LimitBlocksError
        A result is of an unknown kind or belongs to another model.
    """
    made = Report(model, results)
    made.sections  # noqa: B018 # refuses unknown results here, where the user sees which call is wrong
    return made


def _ours(path: Path) -> bool:
    """Whether `path` is a report of ours, by the mark in its head."""
    if not path.is_file():
        return False
    with path.open("rb") as stream:
        return _MARK.encode() in stream.read(_MARK_WITHIN)
