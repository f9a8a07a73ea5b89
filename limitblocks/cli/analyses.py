"""The analyses, imported when they are asked for, and their progress."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager
from importlib import import_module
from typing import TYPE_CHECKING, Any

import typer

from limitblocks.cli.progress import of_iterations, of_stages
from limitblocks.errors import UnlimitedLoad

if TYPE_CHECKING:
    from limitblocks.evidence.stability_result import Stability
    from limitblocks.model import Model


def stability(model: Model) -> Stability:
    """Does it stand under its dead loads."""
    from limitblocks.analysis.stability import stability as solve

    with of_iterations("stability"):
        return solve(model)


def _analysis(
    verb: str, home: str, name: str, progress: Callable[[str], AbstractContextManager[Any]]
) -> Callable[..., Any]:
    """The function `name` of a module of `limitblocks.analysis`, as the verb that shows its progress."""

    def run(model: Model, **settings: Any) -> Any:
        solve = getattr(import_module(f"limitblocks.analysis.{home}"), name)
        with progress(verb) as show:
            return solve(model, **settings, progress=show)

    return run


bounds = _analysis("bounds", "bounds", "bounds", of_stages)
nonassociated = _analysis("nonassociated", "nonassociated.loop", "nonassociated", of_iterations)
load_factor_range = _analysis("range", "load_factor_range.run", "load_factor_range", of_iterations)
path = _analysis("path", "nonassociated.load_path", "load_path", of_iterations)


def bounds_if_any(model: Model, asked: dict[str, float], needed: bool) -> list[Any]:
    """The bounds; none, with a warning, where dilating joints jam and other analyses are to come."""
    try:
        return [bounds(model, **asked)]
    except UnlimitedLoad as error:
        if needed:
            raise
        typer.echo(f"warning: no bounds: {error}", err=True)
        return []
