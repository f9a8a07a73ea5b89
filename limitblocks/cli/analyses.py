"""The analyses, imported when they are asked for, and their progress."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import typer

from limitblocks.cli.progress import of_iterations, of_stages
from limitblocks.errors import UnlimitedLoad

if TYPE_CHECKING:
    from limitblocks.evidence.associated import Bounds
    from limitblocks.evidence.load_path_result import LoadPath
    from limitblocks.evidence.range_result import LoadFactorRange
    from limitblocks.evidence.results import Nonassociated
    from limitblocks.evidence.stability_result import Stability
    from limitblocks.model import Model


def stability(model: Model) -> Stability:
    """Does it stand under its dead loads."""
    from limitblocks.analysis.stability import stability as solve

    with of_iterations("stability"):
        return solve(model)


def bounds(model: Model, **settings: Any) -> Bounds:
    """Associated bounds."""
    from limitblocks.analysis.bounds import bounds as solve

    with of_stages("bounds") as show:
        return solve(model, **settings, progress=show)


def bounds_if_any(model: Model, asked: dict[str, float], needed: bool) -> list[Any]:
    """The bounds; none, with a warning, where dilating joints jam and other analyses are to come."""
    try:
        return [bounds(model, **asked)]
    except UnlimitedLoad as error:
        if needed:
            raise
        typer.echo(f"warning: no bounds: {error}", err=True)
        return []


def nonassociated(model: Model, **settings: Any) -> Nonassociated:
    """Solution without dilatancy, or with little."""
    from limitblocks.analysis.nonassociated.loop import nonassociated as solve

    with of_iterations("nonassociated") as show:
        return solve(model, **settings, progress=show)


def load_factor_range(model: Model, **settings: Any) -> LoadFactorRange:
    """Certified load factors and how far they reach."""
    from limitblocks.analysis.load_factor_range.run import load_factor_range as solve

    with of_iterations("range") as show:
        return solve(model, **settings, progress=show)


def path(model: Model, **settings: Any) -> LoadPath:
    """States from the permanent loads to collapse."""
    from limitblocks.analysis.nonassociated.load_path import load_path as solve

    with of_iterations("path") as show:
        return solve(model, **settings, progress=show)
