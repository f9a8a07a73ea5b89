"""Forces and displaced blocks of a result, for the programs that the blocks came from."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

from limitblocks.drawing.arrows import picture
from limitblocks.errors import ModelError, path_of
from limitblocks.io import formats
from limitblocks.io.imported import one_line, plain
from limitblocks.model import Model, checked_model
from limitblocks.written import write


def write_forces(
    model: Model, file: str | Path, result: Any, *, scale: float | None = None, overwrite: bool = False
) -> Path:
    """Write a model with contact forces and displaced blocks of a result, and return the path of the file.

    Each force is what block i exerts on block j, in N, at the centre of pressure (at the centroid without
    pressure); block i feels the opposite. Blocks are displaced as by
    :func:`limitblocks.files.write_animation`. A result without displacement rates has forces only; of a load
    path, its collapse is written. The suffix says the format, see docs/files.md:

    .3dm (Rhino): layers "blocks", "displaced" and "forces", arrows as lines with an arrowhead, a text with
    the scale. .json (COMPAS): the assembly of `write_blocks`, with "displaced" at its nodes and "interfaces"
    at its edges. .glb: nodes "blocks" in glass, "displaced" and "forces".

    Parameters
    ----------
    model : Model
    file : str or Path
    result : any result with `load_factor` and `stress_resultants` (m, 6); `displacement_rates` (n, 6) or none
    scale : float, optional
        Length of the arrow of 1 N, m; left out, 1 m is a round number of N such that the longest arrow is
        at most 15 % of the diagonal of the structure. It is written to the file.
    overwrite : bool
        Replace the file if it exists.

    Raises
    ------
    LimitBlocksError
        The file exists and `overwrite` is false, or it cannot be written.
    MissingDependency
        The format needs a package that is not installed.
    ModelError
        The suffix is unknown, the scale is not above 0, the result has no forces or belongs to another model.
    """
    model, path = checked_model(model), path_of(file)
    if path.suffix.lower() not in formats.FORCES:
        known = ", ".join(formats.FORCES)
        raise ModelError(
            f"{path}: suffix {path.suffix!r} takes no forces; expected one of {known}, or .vtu of write_vtu"
        )
    shown = picture(model, result, scale)
    shown = replace(
        shown,
        blocks=plain(shown.blocks, shown.fixed),
        displaced=plain(shown.displaced, shown.fixed) if shown.displaced else (),
        names=tuple(map(one_line, shown.names)),
    )
    return write(path, formats.module(path.suffix).with_forces(shown), overwrite)
