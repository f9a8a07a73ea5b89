"""Solve, write and print: what every verb that analyses does with its answer."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import wraps
from inspect import Parameter, Signature, signature
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, get_type_hints

import typer

from limitblocks.cli.errors import INTERRUPTED, interrupts, refuse_existing
from limitblocks.cli.options import AsJson, Filed, Force, ResultFile
from limitblocks.errors import NotConverged

if TYPE_CHECKING:
    from limitblocks.model import Model


class Kept(NamedTuple):
    """What becomes of an answer: printed as JSON, written as a result, filed in a report."""

    as_json: AsJson = False
    output: ResultFile = None
    force: Force = False
    filed: Filed = None


NOTHING = Kept()


def keeping(verb: Callable[..., None]) -> Callable[..., None]:
    """Give a verb the options that the named tuple of its last parameter has, such as :class:`Kept`."""
    *own, last = signature(verb, eval_str=True).parameters.values()
    shown = [
        Parameter(
            name, Parameter.KEYWORD_ONLY, default=last.annotation._field_defaults[name], annotation=hint
        )
        for name, hint in get_type_hints(last.annotation, include_extras=True).items()
    ]

    @wraps(verb)
    def run(**given: Any) -> None:
        told = last.annotation(**{one.name: given.pop(one.name) for one in shown})
        verb(**given, **{last.name: told})

    parameters = [*(one.replace(kind=Parameter.KEYWORD_ONLY) for one in own), *shown]
    run.__signature__ = Signature(parameters)  # type: ignore[attr-defined]
    run.__annotations__ = {one.name: one.annotation for one in parameters}
    return run


def answer(
    solve: Callable[..., Any],
    file: Path,
    kept: Kept,
    beside: Sequence[Any] = (),
    animation: Path | None = None,
    **settings: Any,
) -> Any:
    """Solve the model in `file`, write and print the result; write the best state where it stopped early.

    A report goes to `kept.filed`, with the results `beside` this one, which may come about while it is
    solved; its motion goes to `animation`.
    After Ctrl-C what there is until then is written, and the exit code is 130.
    """
    from limitblocks.io import write_result

    _refuse_files(file, kept, animation)
    model = questioned(file)
    try:
        with interrupts() as stopped:
            result = solve(model, **settings)
    except NotConverged as error:
        if kept.output:
            write_result(error.result, kept.output, overwrite=kept.force)
            typer.echo(f"the best state found, not a solution, is in {kept.output}", err=True)
            if error.result.digest != model.digest:
                made = "a model made from it on the way, with design values or displaced"
                typer.echo(f"it is not of {file} but of {made}: check and report refuse it", err=True)
        if stopped:
            typer.echo(f"error: {error}", err=True)
            raise typer.Exit(INTERRUPTED) from None
        raise
    try:
        _write(model, result, kept, beside, animation)
    finally:  # a full disk does not cost the answer
        show(model, result, kept.as_json)
    if stopped:
        typer.echo("interrupted: what was found until then is above", err=True)
        raise typer.Exit(INTERRUPTED)
    return result


def _write(model: Model, result: Any, kept: Kept, beside: Sequence[Any], animation: Path | None) -> None:
    """Write the files that are asked for."""
    from limitblocks.io import write_animation, write_result

    if kept.output:
        write_result(result, kept.output, overwrite=kept.force)
    if kept.filed:
        from limitblocks.reports import report

        report(model, result, *beside).save(kept.filed, overwrite=kept.force)
    if animation:
        write_animation(model, animation, result, overwrite=kept.force)


def _refuse_files(file: Path, kept: Kept, animation: Path | None) -> None:
    """Refuse what cannot be written, before the analysis and not after it."""
    refuse_existing(kept.output, kept.force, file)
    if kept.filed:
        from limitblocks.reports.files import suffix

        suffix(kept.filed)
        refuse_existing(kept.filed, kept.force, file, kept.output, option="--report")
    if animation:
        from limitblocks.io.formats.gltf.writer import animation_path

        written = animation_path(animation)
        refuse_existing(written, kept.force, file, kept.output, kept.filed, option="--animation")


def questioned(file: Path) -> Model:
    """Return the model in a file, and ask on stderr about what is hardly meant."""
    from limitblocks.analysis.diagnosis import astray
    from limitblocks.analysis.uncarried import uncarried, uncarried_words
    from limitblocks.io import read

    model = read(file)
    ask(model, *astray(model), *uncarried_words(uncarried(model, model.tolerances)))
    return model


def ask(model: Model, *before: str) -> None:
    """Ask on stderr about what is hardly meant."""
    from limitblocks.analysis.magnitudes import questions

    for question in (*before, *questions(model)):
        typer.echo(f"warning: {question}", err=True)


def show(model: Model, result: Any, as_json: bool) -> None:
    """Print a result as tables, or as JSON and nothing else."""
    from limitblocks.io.result_file import result_text
    from limitblocks.reports.terminal import print_result

    if as_json:
        typer.echo(result_text(result))
    else:
        print_result(model, result)
