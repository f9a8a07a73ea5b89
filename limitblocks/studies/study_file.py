"""The file of a study: its head, rows that are there already, and rows as they are done."""

from __future__ import annotations

import hashlib
import json
import logging
import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from limitblocks.arrays import Array
from limitblocks.errors import LimitBlocksError, ModelError
from limitblocks.model import Model
from limitblocks.studies.pool import FAILURES

_log = logging.getLogger("limitblocks")

Row = dict[str, Any]


def head_of(
    parameters: Mapping[str, Any],
    values: Array,
    sampler: str,
    seed: int,
    analysis: str,
    settings: Mapping[str, Any],
    indices: bool,
) -> Row:
    """What tells one study from another: the first line of its file."""
    own = hashlib.sha256(np.ascontiguousarray(values).tobytes()).hexdigest()
    return {
        "study": list(parameters), "sampler": sampler, "seed": int(seed), "analysis": analysis,
        "settings": {key: repr(value) for key, value in settings.items()}, "indices": indices,
        "rows": len(values), "values": own,
    }  # fmt: skip


def _other(there: Any, here: Row) -> str:
    """Whose file it is, in words."""
    if not isinstance(there, dict) or "study" not in there:
        return "no study"
    words = {"study": "parameters", "rows": "number of samples", "values": "intervals or distributions"}
    differs = [key for key in here if there.get(key) != here[key]]
    differs = [key for key in differs if key != "values"] or differs  # the values follow all others
    said = ", ".join(
        words.get(key, key) + f" {there.get(key)!r} there, {here[key]!r} here" * (key != "values")
        for key in differs
    )
    return f"another study: {said}"


def kept_rows(file: Path | None, head: Row) -> dict[int, Row]:
    """Rows that a file of this study has; what was cut off at its end is cut off the file, too."""
    if file is None or _is_new(file):
        return {}
    written = file.read_bytes()
    first, *lines = written.split(b"\n")
    if not lines and json.dumps(head).encode().startswith(first):
        os.truncate(file, 0)
        return {}
    if (there := _parsed(first)) != head:
        raise ModelError(f"{file} is of {_other(there, head)}; name another file or remove it")
    if lines and _parsed(lines[-1]) is None:
        os.truncate(file, written.rindex(b"\n"))
    rows = {}
    for row in map(_parsed, lines):
        if isinstance(row, dict) and {"row", "load_factor", "mode", "error"} <= set(row):
            number = row["load_factor"]
            rows[int(row["row"])] = row | {"load_factor": np.nan if number is None else float(number)}
    return rows


def ask_of_maker(
    file: Path | None,
    kept: Mapping[int, Row],
    maker: Callable[..., Model],
    samples: Sequence[dict[str, float]],
) -> None:
    """Log a warning where the maker has changed since a row was kept; no error, as processors differ."""
    known = next((k for k, row in kept.items() if row.get("model")), None)
    if known is None:
        return
    try:
        own = maker(**samples[known]).digest
    except FAILURES:
        own = ""
    if own != kept[known]["model"]:
        _log.warning(
            "%s: row %d is of another model than the maker makes now; has it changed? A new file begins anew",
            file, known,
        )  # fmt: skip


def _parsed(line: bytes) -> Any:
    try:
        return json.loads(line)
    except ValueError:
        return None


def _is_new(file: Path) -> bool:
    """Whether nothing is in the file: a process that was killed may leave it empty."""
    return not file.exists() or file.stat().st_size == 0


def keep(file: Path | None, head: Row, row: Row) -> None:
    """Add a row to the file, after its head where it is new; each on a line of its own."""
    if file is None:
        return
    new = _is_new(file)
    number = row["load_factor"]
    written = row | {"load_factor": None if np.isnan(number) else str(number) if np.isinf(number) else number}
    try:
        with file.open("a", encoding="utf-8") as stream:
            if new:
                stream.write(json.dumps(head))
            stream.write("\n" + json.dumps(written))
            stream.flush()
    except OSError as error:
        raise LimitBlocksError(f"cannot write {file}: {error.strerror}") from None
