"""Commands of repair: the least ties, or the least added masses, with which a load factor is reached."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from limitblocks.cli import analyses
from limitblocks.cli.adding import Area, PullOut, Yield
from limitblocks.cli.answers import NOTHING, Kept, answer, keeping
from limitblocks.cli.errors import clean_errors, refuse_existing
from limitblocks.cli.options import ModelFile
from limitblocks.cli.vectors import places

if TYPE_CHECKING:
    from limitblocks.model import Model
    from limitblocks.practice import Repair

Ends = Annotated[
    list[Any],
    places(
        "--anchor",
        help="A block and the point that holds an end, m; twice for each tie that may be put in.",
        show_default=False,
    ),
]
Heaps = Annotated[
    list[Any],
    places(
        "--place",
        help="A block and the point where a mass may be added, m; again for more.",
        show_default=False,
    ),
]
Required = Annotated[
    float, typer.Option("--load-factor", help="Required of the live load.", show_default=False)
]
Repaired = Annotated[
    Path | None, typer.Option("--model", metavar="MODEL", help="Also write the model with what is needed.")
]


@keeping
def least_ties(
    model: ModelFile,
    anchor: Ends,
    area: Area,
    strength: Yield,
    load_factor: Required,
    pull_out: PullOut = float("inf"),
    repaired: Repaired = None,
    kept: Kept = NOTHING,
) -> None:
    """Print the least sum of tie forces with which the structure reaches a load factor.

    All ties have one cross-section, and each may get what it carries at most.
    """
    with clean_errors():
        from limitblocks.practice import tie

        if len(anchor) % 2:
            raise typer.BadParameter(f"{len(anchor)} given, expected 2 a tie", param_hint="--anchor")
        carries: Any = {"area": area, "strength": strength, "pull_out": pull_out}
        candidates = [tie(*i, *j, **carries) for i, j in zip(anchor[::2], anchor[1::2], strict=True)]
        settings: Any = {"candidates": candidates, "load_factor": load_factor}
        _repair(analyses.least_ties, model, repaired, kept, settings)


@keeping
def least_masses(
    model: ModelFile,
    place: Heaps,
    load_factor: Required,
    repaired: Repaired = None,
    kept: Kept = NOTHING,
) -> None:
    """Print the least sum of added weights with which the structure reaches a load factor."""
    with clean_errors():
        settings: Any = {"places": place, "load_factor": load_factor}
        _repair(analyses.least_masses, model, repaired, kept, settings)


def _repair(
    least: Callable[..., Repair], model: Path, repaired: Path | None, kept: Kept, settings: dict[str, Any]
) -> None:
    def solve(structure: Model, **asked: Any) -> Repair:
        found = least(structure, **asked)
        if repaired:
            found.model.save(repaired, overwrite=kept.force)
        return found

    refuse_existing(repaired, kept.force, model, kept.output, kept.filed, option="--model")
    answer(solve, model, kept, **settings)
