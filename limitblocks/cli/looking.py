"""The verb `look`: what is in a file of another program, before anything is asked."""

from __future__ import annotations

import json
import shlex
from typing import TYPE_CHECKING, cast

import typer

from limitblocks.cli.errors import clean_errors
from limitblocks.cli.options import AsJson, BlocksFile, Layers, Thickness, TwistedFaces, Units, Up
from limitblocks.errors import few

if TYPE_CHECKING:
    from limitblocks.geometry.twisted import Twisted
    from limitblocks.io.look import Look, SeenBlock

_MOST_ROWS = 24


def look(
    file: BlocksFile,
    units: Units = None,
    thickness: Thickness = None,
    layers: Layers = [],  # noqa: B006 # typer wants a list, and nothing changes it
    up: Up = None,
    twisted: TwistedFaces = None,
    as_json: AsJson = False,
) -> None:
    """Print what is in a file of any format: blocks, layers, units, likely supports, what is wrong."""
    with clean_errors():
        from limitblocks.io.look import look as looked
        from limitblocks.reports.terminal import print_table, print_warnings
        from limitblocks.reports.words import together

        faces = cast("Twisted | None", twisted)
        seen = looked(file, units=units, up=up, twisted=faces, thickness=thickness, layers=layers or None)
        if as_json:
            typer.echo(json.dumps(seen.to_dict()))
            return
        print_table(f"{seen.file}: {seen.format}", (), _rows(seen))
        shown = seen.blocks[:_MOST_ROWS]
        left = len(seen.blocks) - len(shown)
        more = f"; the first {len(shown)}, --json lists the other {left}" if left else ""
        print_table(f"\nBlocks (m, m³){more}", _heads(seen), [_row(seen, block) for block in shown])
        if seen.faults:
            print_table(f"\nNo blocks ({len(seen.faults)})", (), [("-", fault) for fault in seen.faults])
        for note in together(seen.notes):
            typer.echo(f"note: {note}")
        print_warnings(seen.warnings)
        typer.echo(f"\nNext: {_next(seen, units, up, twisted, thickness, layers)}")


def _rows(seen: Look) -> list[tuple[str, str]]:
    from limitblocks.shown import coordinate, many  # here, to keep --help quick

    low, high = seen.bounding_box
    volumes = sorted(block.volume for block in seen.blocks)
    spread = f"{volumes[0]:.3g} to {volumes[-1]:.3g}, median {volumes[len(volumes) // 2]:.3g} m³"
    bad = f", and {many(len(seen.faults), 'fault')}" if seen.faults else ""
    rows = [
        ("Blocks", f"{len(seen.blocks)}{bad}"),
        ("Layers", _times(seen.layers)),
        ("Materials", _times(seen.materials)),
        *([("Groups", _times(seen.groups))] if seen.groups else []),
        *([("Colours", _times(seen.colours))] if seen.colours else []),
        ("Unit of length", seen.units),
        ("Up", seen.up),
        ("Size", " × ".join(f"{side:.4g}" for side in seen.size) + " m"),
        ("Heights", f"from Z = {coordinate(low[2])} to {coordinate(high[2])} m"),
        ("Volume", f"{seen.volume:.4g} m³; of a block {spread}"),
        ("Contacts", seen.contacts),
    ]
    if seen.marked_supports:
        rows.append(
            ("Supports", f"{len(seen.marked_supports)} as the file says: {few(seen.marked_supports)}")
        )
    rows += [("Likely supports", str(one)) for one in seen.likely_supports]
    return rows


def _heads(seen: Look) -> tuple[str, ...]:
    words = [word for word, known in (("Layer", seen.layers), ("Material", seen.materials)) if known]
    return ("Name", *words, "Size", "Volume", "Bottom", "Top")


def _row(seen: Look, block: SeenBlock) -> tuple[str, ...]:
    from limitblocks.shown import coordinate

    words = [word for word, known in ((block.layer, seen.layers), (block.material, seen.materials)) if known]
    size = " × ".join(f"{side:.3g}" for side in block.size)
    return block.name, *words, size, f"{block.volume:.3g}", coordinate(block.bottom), coordinate(block.top)


def _next(
    seen: Look,
    units: str | None,
    up: str | None,
    twisted: str | None,
    thickness: float | None,
    layers: list[str],
) -> str:
    """Return the command that makes a model of the file, with numbers to be put right by the user.

    Where twisted faces are what is wrong with most solids that are no blocks, it looks once more.
    """
    if seen.format == "limitblocks model":
        return f"limitblocks info {shlex.quote(seen.file)}"
    bent = not twisted and 2 * sum("twisted faces" in one for one in seen.faults) > len(seen.faults)
    words = ["limitblocks", "look" if bent else "import", seen.file]
    for option, given, known in (("--units", units, seen.units), ("--up", up, seen.up)):
        stated, _, source = known.partition(", ")
        words += [option, stated.lower()] if given or source.startswith("guessed") else []
    words += ["--twisted", twisted] if twisted else []
    if bent:
        return shlex.join([*words, "--twisted", "triangulate"])
    words += ["--thickness", f"{thickness:g}"] if thickness else []
    words += [part for layer in layers for part in ("--layers", layer)]
    words += ["--skip-bad"] if seen.faults else []
    words += ["--heal"] if any("--heal" in one for one in seen.warnings) else []  # refused without it
    words += ["--gap", f"{seen.touching:.2g}"] if seen.touching else []
    if not seen.marked_supports:
        chosen = seen.likely_supports[0].chosen_by if seen.likely_supports else ("NAME",)
        words += [part for one in chosen for part in ("--supports", one)]
    words += ["--friction", "0.6", "--unit-weight", "20e3", "--live", "1,0,0"]
    return shlex.join(words)


def _times(counts: dict[str, int]) -> str:
    return ", ".join(f"{word} × {count}" for word, count in counts.items()) or "none"
