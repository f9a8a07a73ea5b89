"""The command line: the verbs of the library on model files.

Exit codes: 0 done, 1 a check failed or the structure does not stand by itself, 2 the model (or the usage) is
wrong, 3 no solution found, 130 interrupted, 141 nobody reads what is printed any more.
"""

from __future__ import annotations

import errno
import os
import sys
from contextlib import suppress
from io import TextIOWrapper
from typing import Any

import typer
from typer.core import TyperGroup
from typer.main import get_group

from limitblocks.cli import adding, bridges, documents, practice, repairs, verbs
from limitblocks.cli.errors import Verbs
from limitblocks.cli.examples import examples
from limitblocks.cli.importing import import_blocks
from limitblocks.cli.looking import look
from limitblocks.cli.options import Version
from limitblocks.cli.studies import studies
from limitblocks.cli.vectors import Command


class _New(TyperGroup):
    """The commands of `new`, imported when one of them is asked for, so that --help is quick."""

    @property
    def commands(self) -> Any:
        """The commands by name."""
        from limitblocks.cli.new import new

        return get_group(new).commands

    @commands.setter
    def commands(self, given: Any) -> None:
        """What typer knows of the group: no command yet."""


app = typer.Typer(
    cls=Verbs,
    help="Limit analysis of structures made of rigid blocks, with evidence for every answer.",
    no_args_is_help=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

_new = typer.Typer(
    cls=_New,
    help="Write the model file of a parametric structure.",
    no_args_is_help=True,
    rich_markup_mode=None,
)
for _name, _group in {"study": studies, "new": _new, "examples": examples}.items():
    app.add_typer(_group, name=_name)


PIPE_CLOSED = 141  # as shells say it: 128 and the number of the signal


def main() -> None:
    """Run the command line."""
    for stream in (sys.stdout, sys.stderr):  # a letter that the console lacks is no reason to crash
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="replace")
    try:
        app(prog_name="limitblocks")
    except SystemExit as end:
        if isinstance(end.__context__, BrokenPipeError):  # typer makes it 1, a check failed
            _say_no_more()
            sys.exit(PIPE_CLOSED)
        raise
    except OSError as error:
        if error.filename is not None:
            raise
        _say_no_more()
        if error.errno == errno.EINVAL:  # as Windows says that nobody reads any more
            sys.exit(PIPE_CLOSED)
        with suppress(OSError):  # stderr may be as full
            typer.echo(f"error: cannot write what there is to print: {error.strerror}", err=True)
        sys.exit(2)


def _say_no_more() -> None:
    """Print to nowhere what is left to print: leaving tries once more."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


@app.callback(invoke_without_command=True)
def _start(version: Version = False) -> None:
    if version:
        from limitblocks import __version__

        typer.echo(f"limitblocks {__version__}")
        raise typer.Exit


app.command()(verbs.stability)
app.command()(verbs.bounds)
app.command()(verbs.sensitivities)
app.command()(verbs.nonassociated)
app.command()(verbs.path)
app.command("range")(verbs.load_factor_range)
app.command(cls=Command)(practice.settle)
app.command(cls=Command)(practice.capacity)
app.command()(practice.verify)
app.command()(practice.adequacy)
app.command(cls=Command)(repairs.least_ties)
app.command(cls=Command)(repairs.least_masses)
app.command()(bridges.vehicle)
app.command(cls=Command)(bridges.backfill)
app.command(cls=Command)(adding.tie)
app.command(cls=Command)(adding.strip)
app.command(cls=Command)(adding.dowel)
app.command()(adding.uplift)
app.command()(verbs.check)
app.command()(documents.info)
app.command()(documents.report)
app.command()(documents.export)
app.command()(look)
app.command("import", cls=Command)(import_blocks)
app.command()(documents.schema)
