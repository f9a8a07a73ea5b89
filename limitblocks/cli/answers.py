"""Solve, write and print: what every verb that analyses does with its answer."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from limitblocks.cli.errors import INTERRUPTED, interrupts, refuse_existing
from limitblocks.errors import NotConverged

if TYPE_CHECKING:
    from limitblocks.model import Model


def answer(
    solve: Callable[..., Any],
    file: Path,
    as_json: bool,
    output: Path | None,
    force: bool,
    filed: Path | None = None,
    beside: Sequence[Any] = (),
    animation: Path | None = None,
    **settings: Any,
) -> Any:
    """Solve the model in `file`, write and print the result; write the best state where it stopped early.

    A report goes to `filed`, with the results `beside` this one, which may come about while it is solved;
    its motion goes to `animation`.
    After Ctrl-C what there is until then is written, and the exit code is 130.
    """
    from limitblocks.io import read, write_result

    refuse_existing(output, force, file)
    if filed:
        from limitblocks.reports.files import suffix

        suffix(filed)  # before the analysis, not after it
        refuse_existing(filed, force, file, option="--report")
    if animation:
        from limitblocks.io.formats.gltf.writer import animation_path

        refuse_existing(animation_path(animation), force, file, option="--animation")
    model = read(file)
    try:
        with interrupts() as stopped:
            result = solve(model, **settings)
    except NotConverged as error:
        if output and error.result is not None:
            write_result(error.result, output, overwrite=force)
            typer.echo(f"the best state found, not a solution, is in {output}", err=True)
        if stopped:
            typer.echo(f"error: {error}", err=True)
            raise typer.Exit(INTERRUPTED) from None
        raise
    if output:
        write_result(result, output, overwrite=force)
    if filed:
        from limitblocks.reports import report

        report(model, result, *beside).save(filed, overwrite=force)
    if animation:
        from limitblocks.io import write_animation

        write_animation(model, animation, result, overwrite=force)
    show(model, result, as_json)
    if stopped:
        raise typer.Exit(INTERRUPTED)
    return result


def show(model: Model, result: Any, as_json: bool) -> None:
    """Print a result as tables, or as JSON and nothing else."""
    from limitblocks.io.result_file import result_text
    from limitblocks.reports.terminal import print_result

    if as_json:
        typer.echo(result_text(result))
    else:
        print_result(model, result)
