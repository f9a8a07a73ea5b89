"""Models and results in a notebook: a small table with a picture, the viewer, pandas tables."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from html import escape
from typing import Any

from limitblocks.drawing.picture import mechanism_picture
from limitblocks.errors import MissingDependency, ModelError
from limitblocks.evidence.interface_states import interface_states
from limitblocks.io.result_file import versions
from limitblocks.model import Model, model_of
from limitblocks.reports.facts import fact_rows, facts
from limitblocks.reports.page import drawing, viewer_page
from limitblocks.reports.scene import in_scene, scene
from limitblocks.reports.sections import section

_MOST_ROWS = 8
_MOST_ANSWERS = 8  # of a range, in one viewer
# The style goes into a page of somebody else's: nothing of it may reach beyond the class.
_STYLE = """
.limitblocks { display: flex; flex-wrap: wrap; gap: 1.5em; align-items: flex-start; }
.limitblocks table { border-collapse: collapse; font-size: 90%; }
.limitblocks td { text-align: left; padding: .15em .8em .15em 0; border: 0; }
.limitblocks svg { width: 340px; max-height: 340px; }
.limitblocks svg path { stroke: #4d4943; stroke-width: 1.5; fill: #ece6da; }
.limitblocks svg .moving path { fill: #c3daee; }
.limitblocks svg .support path { fill: #a8a39b; }
.limitblocks svg .ghost path, .limitblocks svg .outline path { fill: none; stroke: #999; stroke-dasharray: 5 5; }
.limitblocks svg .axis path, .limitblocks svg .live path { fill: none; stroke-width: 3; }
.limitblocks svg .live path { stroke: #d55e00; }
.limitblocks svg text { font: 26px sans-serif; fill: currentColor; }
.limitblocks svg text.end { text-anchor: end; }
"""


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
        frame = f'width="100%" height="{self.height}" style="border: 0" allowfullscreen'
        return f'<iframe title="{escape(self.scene["title"])}" {frame} srcdoc="{escape(self.html)}"></iframe>'

    def __repr__(self) -> str:
        return f"<view of {self.scene['title']!r}; a notebook shows it>"


def view(thing: Any, model: Model | None, height: int) -> View:
    """Return the viewer of a model, or of a result of it."""
    if isinstance(thing, Model):
        return View(scene(thing, (), thing.name or "Structure"), height)
    known = _model(thing, model)
    answers = getattr(thing, "answers", (thing,))[:_MOST_ANSWERS]
    shown = [one for one in (_in_viewer(answer) for answer in answers) if in_scene(one)]
    return View(scene(known, shown, known.name or "Structure"), height)


def html(thing: Any) -> str:
    """Return a small table and a picture; of a result without its model the line that print writes."""
    if isinstance(thing, Model):
        rates = [[0.0] * 6] * len(thing.blocks)
        return _figure(str(thing), fact_rows(facts(thing)), _picture(thing, rates))
    known = model_of(thing)
    said = None
    return str(said)


def frame(thing: Any, model: Model | None) -> Any:
    """Return the rows of a result, or those of what its interfaces do and carry, as a pandas table."""
    try:
        import pandas as pd
    except ImportError:
        raise MissingDependency(
            "to_frame needs the package pandas; install it by: pip install 'limitblocks[tables]'"
        ) from None
    rows = getattr(thing, "rows", None)
    return pd.DataFrame((rows or interface_states(_model(thing, model), thing.collapse).rows)())
