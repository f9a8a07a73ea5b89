"""A report: one HTML file that needs nothing else, and the same content as JSON, Markdown and PDF."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from datetime import datetime
from functools import cached_property
from pathlib import Path
from typing import Any

from limitblocks.evidence.associated import Bounds
from limitblocks.evidence.load_path_result import LoadPath
from limitblocks.evidence.results import Nonassociated
from limitblocks.io import strict_json
from limitblocks.io.result_file import versions
from limitblocks.model import Model
from limitblocks.reports import files
from limitblocks.reports.comparison import comparison
from limitblocks.reports.content import content
from limitblocks.reports.facts import assumptions, facts
from limitblocks.reports.interfaces import interface_rows
from limitblocks.reports.labels import Labels
from limitblocks.reports.markdown import markdown
from limitblocks.reports.page import page
from limitblocks.reports.picture import Picture, mechanism_picture
from limitblocks.reports.section import Section
from limitblocks.reports.sections import section

REPORT_SCHEMA_VERSION = 1
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
    labels : Labels
        What was asked for beside the results.
    """

    model: Model
    results: tuple[Any, ...]
    date: datetime = field(default_factory=lambda: datetime.now().astimezone())
    labels: Labels = field(default_factory=Labels)

    @cached_property
    def sections(self) -> tuple[Section, ...]:
        """What the report says of each result."""
        return tuple(section(self.model, result) for result in self.results)

    def to_dict(self) -> dict[str, Any]:
        """Return the content as plain numbers, lists and text, SI units; see :func:`report_schema`."""
        return {
            "format": files.FORMAT,
            "schema_version": REPORT_SCHEMA_VERSION,
            "title": self.title,
            "date": self.date.isoformat(timespec="seconds"),
            "versions": versions(),
            "model": facts(self.model),
            "assumptions": assumptions(self.model),
            "comparison": [list(row) for row in comparison(self.results)],
            "warnings": [warning for one in self.sections for warning in one.warnings],
            "results": [result.to_dict() for result in self.results],
            "interfaces": [interface_rows(self.model, result) for result in self.results],
        }

    @property
    def json(self) -> str:
        """The content as JSON text."""
        return strict_json.text(self.to_dict())

    @property
    def title(self) -> str:
        """Title of the report."""
        return self.labels.title or self.model.name or "Limit analysis of a rigid-block structure"

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

    @property
    def markdown(self) -> str:
        """The report as Markdown, without drawings."""
        return markdown(content(self))

    def pdf(self, file: str | Path, *, overwrite: bool | None = None) -> Path:
        """Write the report as PDF, whatever the suffix, and return its path; see :meth:`save`.

        Raises
        ------
        MissingDependency
            reportlab is not installed.
        """
        return files.save(self, file, ".pdf", overwrite)

    def save(self, file: str | Path, *, overwrite: bool | None = None) -> Path:
        """Write the report as its suffix says, .html, .json, .md or .pdf, and return its path.

        Parameters
        ----------
        file : str or Path
            Name of the file.
        overwrite : bool, optional
            Whether to replace a file that exists; by default only one that limitblocks wrote.

        Raises
        ------
        LimitBlocksError
            The suffix is none of these, the file exists and may not be replaced, or it cannot be written.
        MissingDependency
            reportlab, which a PDF needs, is not installed.
        """
        return files.save(self, file, files.suffix(file), overwrite)


def report(
    model: Model,
    *results: Any,
    title: str = "",
    author: str = "",
    project: str = "",
    notes: str = "",
    demand: float | None = None,
) -> Report:
    """Return a report on `model` and the results of its analyses.

    Parameters
    ----------
    model : Model
        The structure.
    *results
        What the analyses of this model returned, such as :class:`limitblocks.results.Bounds`.
    title : str
        Title; by default the name of the model.
    author, project, notes : str
        Who made it, for what, and anything else to be written on it.
    demand : float, optional
        Load factor that the structure is required to carry. The report then says how many times this
        demand the load factor is; it says nothing of compliance with a code.

    Raises
    ------
    LimitBlocksError
        A result is of an unknown kind or belongs to another model, or the demand is no finite number > 0.
    """
    made = Report(model, results, labels=Labels(title, author, project, notes, demand))
    made.sections  # noqa: B018 # refuses unknown results here, where the user sees which call is wrong
    return made


def report_schema() -> dict[str, Any]:
    """Return the JSON Schema of the report as JSON."""
    text = (Path(__file__).parent / "schema.json").read_text(encoding="utf-8")
    schema: dict[str, Any] = json.loads(text)
    return schema
