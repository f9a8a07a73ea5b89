"""Models and results in a notebook: a small table with a picture, the viewer, pandas tables."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from html import escape
from typing import Any
from uuid import uuid4

import numpy as np

from limitblocks.analysis.magnitudes import questions
from limitblocks.arrays import Array
from limitblocks.drawing.picture import mechanism_picture
from limitblocks.errors import ModelError
from limitblocks.evidence.interface_states import interface_states
from limitblocks.io.packages import package
from limitblocks.io.result_file import versions
from limitblocks.model import Model, model_of
from limitblocks.reports.claims import checked
from limitblocks.reports.facts import fact_rows, facts
from limitblocks.reports.page import environment, viewer_page
from limitblocks.reports.scene import in_scene, scene
from limitblocks.reports.sections import section, shown

_MOST_ANSWERS = 8  # of a range, in one viewer
_MOST_BLOCKS = 600  # drawn: about 1 s, and .2 MB in the notebook file


@dataclass(frozen=True, eq=False)
class View:
    """The interactive viewer as a document of its own, in a frame of a notebook.

    Attributes
    ----------
    scene : dict
        What it shows.
    height : int
        Of the frame, pixels.
    """

    scene: dict[str, Any]
    height: int

    @cached_property
    def html(self) -> str:
        """The viewer as one HTML document that needs nothing else."""
        return viewer_page(self.scene, versions()["limitblocks"])

    def _repr_html_(self) -> str:
        style = f"width: 100%; height: {self.height}px; border: 0"
        frame = f'title="{escape(self.scene["title"])}" style="{style}" allow="fullscreen"'
        return f'<iframe {frame} srcdoc="{escape(self.html)}"></iframe>'

    def __repr__(self) -> str:
        return f"<view of {self.scene['title']!r}, which a notebook shows>"


def view(thing: Any, model: Model | None, height: int) -> View:
    """Return the viewer of a model, or of a result of it."""
    if isinstance(thing, Model):
        return View(scene(thing, (), _title(thing)), height)
    known = _model(thing, model)
    answers = getattr(thing, "answers", (thing,))[:_MOST_ANSWERS]
    states = (getattr(one, "solution", one) for one in answers)
    return View(scene(known, [one for one in states if in_scene(one)], _title(known)), height)


def html(thing: Any) -> str:
    """Return a small table and a picture; what print writes where there is no more to show."""
    if isinstance(thing, Model):
        still = np.zeros((len(thing.blocks), 6))
        rows = [*fact_rows(facts(thing)), *(("Warning", one) for one in questions(thing))]
        return _rendered(str(thing), rows, _drawing(thing, still))
    known = model_of(thing)
    if known is None or not shown(thing):
        return _rendered(type(thing).__name__, [(line,) for line in str(thing).split("; ")])
    said = section(known, checked(known, thing))
    rates, curve = said.rates, said.curve
    return _rendered(
        f"{said.title}: {said.headline} {said.quantity}",
        [*said.values, *(("Warning", one, "") for one in (*questions(known), *said.warnings))],
        _drawing(known, rates) if rates is not None else curve.sheet() if curve else None,
    )


def frame(thing: Any, model: Model | None) -> Any:
    """Return the rows of a result, or those of what its interfaces do and carry, as a pandas table."""
    rows = getattr(thing, "rows", None) or interface_states(_model(thing, model), thing.collapse).rows
    return package("pandas", "to_frame()").DataFrame(rows())


def _model(thing: Any, model: Model | None) -> Model:
    known = model_of(thing, model)
    if known is None:
        raise ModelError(f"the model of this {type(thing).__name__} is not in memory any more; give it")
    return known


def _title(model: Model) -> str:
    return model.name or "Structure"


def _drawing(model: Model, rates: Array) -> Any:
    if len(model.blocks) > _MOST_BLOCKS:
        return None
    return mechanism_picture(model, rates).sheet(_title(model))


def _rendered(title: str, rows: Any, drawn: Any = None) -> str:
    template = environment().get_template("notebook.html")
    return template.render(title=title, rows=rows, drawn=drawn, id=f"limitblocks-{uuid4().hex}")
