"""A report: one document, and its formats HTML, PDF, Markdown, JSON and text."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from functools import cached_property
from pathlib import Path
from typing import Any
from urllib.parse import quote

from limitblocks.drawing.picture import Picture, mechanism_picture
from limitblocks.errors import sequence_of
from limitblocks.evidence.interface_states import interface_states
from limitblocks.io import strict_json
from limitblocks.kinds import KINDS
from limitblocks.model import Model, checked_model
from limitblocks.reports import files
from limitblocks.reports.answer import answer, verdict
from limitblocks.reports.as_json import as_dict
from limitblocks.reports.chapters import document
from limitblocks.reports.claims import checked
from limitblocks.reports.document import Document
from limitblocks.reports.facts import facts
from limitblocks.reports.interfaces import interface_rows
from limitblocks.reports.labels import Labels
from limitblocks.reports.markdown import markdown
from limitblocks.reports.page import page
from limitblocks.reports.pdf import pdf
from limitblocks.reports.scene import in_scene, scene
from limitblocks.reports.section import Section
from limitblocks.reports.sections import drawn, section
from limitblocks.reports.terminal import text
from limitblocks.shown import many


@dataclass(frozen=True, eq=False)
class Report:
    """Results of analyses of one model, to be filed and shown; made by :func:`limitblocks.report`.

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

    @property
    def title(self) -> str:
        """Title of the report."""
        return self.document.title

    @cached_property
    def facts(self) -> dict[str, Any]:
        """What the model is, in numbers and words."""
        return facts(self.model)

    @cached_property
    def drawn(self) -> Section | None:
        """The section whose mechanism is drawn: one says enough."""
        return drawn(self.results, self.sections)

    @cached_property
    def picture(self) -> Picture | None:
        """The static drawing of that mechanism, for print and where no 3D graphics are to be had."""
        rates = self.drawn.rates if self.drawn else None
        if rates is None or self.drawn is None:
            return None
        drawn = self.results[self.sections.index(self.drawn)]
        states = interface_states(self.model, drawn).state if in_scene(drawn) else ()
        return mechanism_picture(self.model, rates, states)

    @cached_property
    def document(self) -> Document:
        """What all formats show."""
        made = self.sections, self.labels, self.date, self.facts, self.drawn, self.picture
        return document(self.model, self.results, *made)

    @cached_property
    def scene(self) -> dict[str, Any]:
        """What the viewer shows."""
        return scene(self.model, self.results, self.title)

    def to_dict(self) -> dict[str, Any]:
        """Return plain numbers, lists and text, SI units; see :func:`limitblocks.files.report_schema`."""
        found = answer(self.sections)
        demand = self.labels.demand
        said = verdict(found, demand) if demand is not None else None
        return {
            **as_dict(self.document),
            "answer": {"load_factor": found.load_factor, "certified": found.certified},
            "demand": demand,
            "ratio": said.ratio if said else None,
            "model": self.facts,
            "results": [result.to_dict() for result in self.results],
            "interfaces": [interface_rows(self.model, result) for result in self.results],
        }

    @property
    def json(self) -> str:
        """The content as JSON text."""
        return strict_json.text(self.to_dict())

    @cached_property
    def html(self) -> str:
        """The report as one HTML document without references to other files."""
        return page(self.document, self.scene, self._chosen)

    @property
    def markdown(self) -> str:
        """The report as Markdown; of drawings it has the words."""
        return markdown(self.document)

    @property
    def text(self) -> str:
        """The report as on a terminal."""
        return text(self.document)

    def __repr__(self) -> str:
        of = many(len(self.results), "result")
        return f"<report {self.title!r}: {of}; save it as .html, .pdf, .md or .json>"

    def __str__(self) -> str:
        found = answer(self.sections)
        number = "" if found.load_factor is None else f"{found.number} "
        return f"report {self.title!r}: {number}{found.quantity(self.model)}"

    @property
    def _chosen(self) -> int:
        """Place in the viewer of the result that is drawn."""
        moving = [one for one, result in zip(self.sections, self.results, strict=True) if in_scene(result)]
        return moving.index(self.drawn) if self.drawn in moving else 0

    def pdf(self, file: str | Path, *, overwrite: bool | None = None) -> Path:
        """Write the report as PDF, whatever the suffix, and return its path; see :meth:`save`.

        Raises
        ------
        MissingDependency
            reportlab is not installed.
        """
        return self._write(file, ".pdf", overwrite)

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
        return self._write(file, files.suffix(file), overwrite)

    def _write(self, file: str | Path, kind: str, overwrite: bool | None) -> Path:
        made: dict[str, Callable[[], str | bytes]] = {
            ".html": lambda: self.html,
            ".json": lambda: self.json + "\n",
            ".md": lambda: self.markdown,
            ".pdf": lambda: pdf(self.document),
        }
        return files.save(file, made[kind](), kind, overwrite)


def report(
    model: Model,
    *results: Any,
    title: str = "",
    author: str = "",
    project: str = "",
    notes: str = "",
    demand: float | None = None,
    failed: Sequence[str] = (),
) -> Report:
    """Return a report on `model` and the results of its analyses.

    Parameters
    ----------
    model : Model
        The structure.
    *results
        What the analyses of this model returned, such as :class:`limitblocks.results.Bounds`, or what
        :func:`limitblocks.read_result` read, which is checked first.
    title : str
        Title; by default the name of the model.
    author, project, notes : str
        Who made it, for what, and anything else to be written on it.
    demand : float, optional
        Load factor that the structure is required to carry. The report then says how many times this
        demand the load factor is; it says nothing of compliance with a code.
    failed : sequence of str
        Analyses that gave no answer, a sentence each with why: warnings beside the load factor to design
        with.

    Raises
    ------
    LimitBlocksError
        A result is of an unknown kind or belongs to another model, or the demand is no finite number > 0.
    """
    checked_model(model)
    labels = Labels(title, author, project, notes, demand, sequence_of("failed", failed, str))
    made = Report(model, tuple(checked(model, result) for result in results), labels=labels)
    made.sections  # noqa: B018 # refuses unknown results here, where the user sees which call is wrong
    return made


def report_schema() -> dict[str, Any]:
    """Return the JSON Schema of the report as JSON."""
    text = (Path(__file__).parent / "schema.json").read_text(encoding="utf-8")
    schema: dict[str, Any] = json.loads(text)
    for word in KINDS:
        plain = {"type": "object", "properties": {"analysis": {"const": word}}, "required": ["analysis"]}
        schema["$defs"].setdefault(word, plain)
    kinds = [{"$ref": f"#/$defs/{quote(word)}"} for word in KINDS]
    schema["properties"]["results"]["items"]["oneOf"] = kinds
    return schema
