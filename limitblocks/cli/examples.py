"""`limitblocks examples`: the lessons that come with the package."""

from __future__ import annotations

import ast
import runpy
import sys
from importlib.resources import files
from pathlib import Path
from typing import Annotated

import typer

from limitblocks.cli.errors import clean_errors
from limitblocks.cli.options import Force
from limitblocks.errors import LimitBlocksError

examples = typer.Typer(
    help="Lessons: list them, run one, read one.", no_args_is_help=True, rich_markup_mode=None
)
Name = Annotated[str, typer.Argument(help="Name or number of an example.", show_default=False)]


def folder() -> Path:
    """Return the folder of the examples: in an installed package, or beside it in a checkout."""
    package = Path(str(files("limitblocks")))
    return next(path for path in (package / "examples", package.parent / "examples") if path.is_dir())


def available() -> dict[str, Path]:
    """Return the examples by name, in order."""
    return {file.stem: file for file in sorted(folder().glob("*.py")) if not file.stem.startswith("_")}


def summary(file: Path) -> str:
    """Return the first line of an example's docstring."""
    doc = ast.get_docstring(ast.parse(file.read_text(encoding="utf-8"))) or ""
    return doc.split("\n", 1)[0]


def find(name: str) -> Path:
    """Return the example of that name or number.

    Raises
    ------
    LimitBlocksError
        If there is none.
    """
    known = available()
    stem = name.removesuffix(".py")
    numbered = {stem.split("_")[0].lstrip("0"): stem for stem in known}
    stem = stem if stem in known else numbered.get(stem.lstrip("0"), stem)
    if stem not in known:
        from limitblocks.io.faults import near

        raise LimitBlocksError(f"no example {name!r}{near(name, known)}; see limitblocks examples list")
    return known[stem]


@examples.command("list")
def list_examples() -> None:
    """Print the names of the examples and what each is about."""
    with clean_errors():
        known = available()
        width = max(map(len, known))
        for name, file in known.items():
            typer.echo(f"{name:{width}}  {summary(file)}")


@examples.command()
def run(name: Name, force: Force = False) -> None:
    """Run an example; its picture, or model and report, go to the folder `output` here, by its name."""
    with clean_errors():
        file = find(name)
        there = sorted(Path("output").glob(f"{file.stem}.*"))
        if there and not force:
            raise LimitBlocksError(f"{there[0]} exists; move it, or replace it with --force")
        before = _written()
        sys.path.insert(0, str(file.parent))  # as `python FILE` does
        words, sys.argv = sys.argv, [str(file)]
        try:
            runpy.run_path(str(file), run_name="__main__")
        except ModuleNotFoundError as error:
            from limitblocks.io.packages import missing

            raise missing(str(error.name), file.stem) from None
        finally:
            sys.argv = words
            sys.path.remove(str(file.parent))
        for path, _ in sorted(_written() - before):
            typer.echo(path)


def _written() -> set[tuple[Path, int]]:
    """What is in the folder of pictures, with when it was written."""
    return {(path, path.stat().st_mtime_ns) for path in Path("output").glob("*") if path.is_file()}


@examples.command()
def show(name: Name) -> None:
    """Print an example, to read it or to keep it in a file of your own."""
    with clean_errors():
        typer.echo(find(name).read_text(encoding="utf-8"), nl=False)
