"""The same sections as tables on a terminal."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from rich.console import Console
from rich.table import Table
from rich.text import Text

from limitblocks.model import Model
from limitblocks.reports.sections import section

_TO_THE_RIGHT = ("Value", "Step", "Load factor")


def print_result(model: Model, result: Any) -> None:
    """Print what a report says of `result`, without the drawings."""
    said = section(model, result)
    headline = f"\n  [bold]{said.headline}[/bold]  {said.quantity}, {said.title}\n"
    Console(soft_wrap=True).print(headline, highlight=False)
    print_table("", ("Quantity", "Value", "From"), said.values)
    checks = [
        (name, f"{value:.1e}", meaning, "pass" if passed else "fail")
        for name, value, meaning, passed in said.checks
    ]
    title = f"\nResiduals, each at most {said.tolerance:.1e}"
    print_table(title, ("Residual", "Value", "Meaning", "Check"), checks)
    if said.steps:
        print_table(f"\n{said.steps.caption}", said.steps.heads, said.steps.rows)
    print_warnings(said.warnings)


def print_warnings(warnings: Iterable[str]) -> None:
    """Print a line for each warning."""
    for warning in warnings:
        Console(soft_wrap=True).print(f"warning: {warning}", style="yellow", markup=False, highlight=False)


def print_table(title: str, heads: tuple[str, ...], rows: Any) -> None:
    """Print rows of text in columns; without heads, the first column is the name of each row."""
    table = Table(
        title=Text(title) if title else None,
        title_justify="left",
        show_header=bool(heads),
        box=None,
        pad_edge=False,
    )
    for head in heads:
        table.add_column(head, justify="right" if head in _TO_THE_RIGHT else "left", overflow="fold")
    if not heads:
        table.add_column(no_wrap=True)
        table.add_column(overflow="fold")
    for row in rows:
        table.add_row(*(Text(cell) for cell in row))  # Text: a name in brackets is not markup
    Console().print(table)
