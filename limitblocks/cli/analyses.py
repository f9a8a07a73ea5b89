"""The analyses, imported when they are asked for, and their progress."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from importlib import import_module
from typing import TYPE_CHECKING, Any

import typer

from limitblocks.cli.progress import of_iterations, of_places, of_points, of_settlement, of_stages
from limitblocks.errors import SolveError, UnlimitedLoad

if TYPE_CHECKING:
    from limitblocks.model import Model


def _analysis(
    verb: str,
    home: str,
    name: str,
    progress: Callable[[str], AbstractContextManager[Any]],
    tells: bool = True,
) -> Callable[..., Any]:
    """The function `name` of a module as the verb that shows its progress, or the time if it tells none."""

    def run(model: Model, **settings: Any) -> Any:
        solve = getattr(import_module(f"limitblocks.{home}"), name)
        with progress(verb) as show:
            return solve(model, **settings, **({"progress": show} if tells else {}))

    return run


stability = _analysis("stability", "analysis.stability", "stability", of_stages, tells=False)
bounds = _analysis("bounds", "analysis.bounds", "bounds", of_stages)
nonassociated = _analysis("nonassociated", "analysis.nonassociated.loop", "nonassociated", of_iterations)
load_factor_range = _analysis("range", "analysis.load_factor_range.run", "load_factor_range", of_iterations)
path = _analysis("path", "analysis.nonassociated.load_path", "load_path", of_iterations)
settlement = _analysis("settle", "practice.settlement", "settlement", of_stages, tells=False)
settlement_to_collapse = _analysis("settle", "practice.collapse", "settlement_to_collapse", of_settlement)
least_ties = _analysis("least-ties", "practice.repair", "least_ties", of_stages, tells=False)
least_masses = _analysis("least-masses", "practice.repair", "least_masses", of_stages, tells=False)
adequacy = _analysis("adequacy", "practice.adequacy", "adequacy", of_stages, tells=False)
capacity = _analysis("capacity", "practice.capacity", "capacity_curve", of_points)
vehicle = _analysis("vehicle", "practice.worst_position", "worst_position", of_places)


def bounds_if_any(model: Model, needed: bool, **asked: float) -> Any:
    """The bounds; None, with a warning, where dilating joints jam and other analyses are to come."""
    try:
        return bounds(model, **asked)
    except UnlimitedLoad as error:
        if needed:
            raise
        typer.echo(f"warning: no bounds: {error}", err=True)
        return None


def each(
    model: Model, asked: Mapping[str, tuple[Callable[..., Any], Mapping[str, Any]]]
) -> tuple[list[Any], dict[str, SolveError]]:
    """The results of analyses with their settings, by name, best states among them, and why others have none.

    None is asked for after one that the user stopped.
    """
    from limitblocks.evidence.ending import Status

    found: list[Any] = []
    failed: dict[str, SolveError] = {}
    for word, (solve, settings) in asked.items():
        try:
            result = solve(model, **settings)
        except SolveError as error:
            failed[word], result = error, getattr(error, "result", None)
        except KeyboardInterrupt:
            if not found:
                raise
            failed[word] = SolveError("interrupted before there was anything to write")
            break
        found += [] if result is None else [result]
        if getattr(result, "status", None) is Status.INTERRUPTED:
            break
    return found, failed
