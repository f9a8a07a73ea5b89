"""JSON text in, with one clean line for every way it can be wrong, and out, as every program reads it."""

from __future__ import annotations

import json
import re
from collections import Counter
from functools import partial
from math import isfinite
from pathlib import Path
from typing import Any, NoReturn

import numpy as np

from limitblocks.errors import ModelError

#: Largest file accepted, bytes.
LARGEST_FILE = 100_000_000
#: Most that one file, and one object in it, may have; in memory they are many times their text.
_MOST = {"lists and objects": 3_000_000, "keys": 5_000_000, "values": 8_000_000}
_MOST_KEYS = 250_000
_KEY = re.compile(r'"((?:[^"\\]|\\.)*)"\s*:')
_OUTSIDE_STRINGS = re.compile(r'"(?:[^"\\]|\\.)*"|NaN|-?Infinity')


def plain_bytes(path: Path, expected: str) -> bytes:
    """Return the content of the file at `path`; `expected` says what it should hold.

    Raises
    ------
    ModelError
        It cannot be read, is not a plain file, is empty or too large.
    """
    try:
        if path.exists() and not path.is_file():  # reading a pipe or a device may never end
            wrong = (
                "is a folder; name a file in it"
                if path.is_dir()
                else f"is not a file; name a file of {expected}"
            )
            raise ModelError(wrong)
        with path.open("rb") as stream:
            data = stream.read(LARGEST_FILE + 1)
    except OSError as error:
        raise ModelError(f"cannot be read: {error.strerror or error}") from None
    except ValueError as error:  # a null character in the name
        raise ModelError(f"cannot be read: {error}") from None
    if len(data) > LARGEST_FILE:
        raise ModelError(f"is larger than {LARGEST_FILE / 1e6:.0f} MB, the most that is read")
    if not data.strip():
        raise ModelError(f"is empty; expected {expected}")
    return data


def read_text(path: Path) -> str:
    """Return the text of the file at `path`.

    Raises
    ------
    ModelError
        The file cannot be read, is not a plain file, is empty, too large or not UTF-8.
    """
    data = plain_bytes(path, "JSON")
    try:
        text = data.decode("utf-8-sig")  # editors on Windows write a byte order mark
    except UnicodeDecodeError as error:
        if data.startswith((b"\xff\xfe", b"\xfe\xff")):  # as the shell of Windows writes
            raise ModelError("is UTF-16 text; save it as UTF-8") from None
        raise ModelError(f"is not UTF-8 text: byte {error.start} cannot be decoded") from None
    if not text.strip():  # a byte order mark alone
        raise ModelError("is empty; expected JSON")
    return text


def parse(text: str) -> Any:
    """Return the value of JSON `text`, without the NaN, infinities and duplicate keys that Python lets pass.

    Raises
    ------
    ModelError
        The text is not JSON, nests too deeply, or has a key twice in one object.
    """
    counts = text.count("[") + text.count("{"), text.count(":"), text.count(",")
    for (word, most), count in zip(_MOST.items(), counts, strict=True):
        if count > most:
            raise ModelError(f"has about {count} {word}; at most {most} are read")
    try:
        return json.loads(text, parse_constant=partial(_refuse_constant, text), object_pairs_hook=_unique)
    except json.JSONDecodeError as error:
        raise ModelError(f"line {error.lineno}, column {error.colno}: not JSON: {error.msg}") from None
    except RecursionError:
        raise ModelError("not as expected: the JSON nests too deeply") from None
    except ValueError as error:  # a whole number of thousands of digits
        raise ModelError(f"not JSON: {error}") from None


def text(value: Any) -> str:
    """Return `value` as JSON text; a dictionary with a line a key. NaN and infinities become null."""
    value = finite(value)
    if not isinstance(value, dict):
        return json.dumps(value, allow_nan=False)
    lines = (f" {json.dumps(key)}: {json.dumps(part, allow_nan=False)}" for key, part in value.items())
    return "{\n" + ",\n".join(lines) + "\n}"


def finite(value: Any) -> Any:
    """Return `value` with null for NaN and infinities; numbers of numpy are those of Python."""
    value = value.item() if isinstance(value, np.generic) else value
    if isinstance(value, dict):
        return {key: finite(part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [finite(part) for part in value]
    return None if isinstance(value, float) and not isfinite(value) else value


def _refuse_constant(text: str, word: str) -> NoReturn:
    start = next(one.start() for one in _OUTSIDE_STRINGS.finditer(text) if one[0] == word)
    where = f"line {text.count(chr(10), 0, start) + 1}, column {start - text.rfind(chr(10), 0, start)}"
    key = ""
    for one in _KEY.finditer(text, 0, start):
        key = f"{one[1]}: "
    raise ModelError(f"{where}: not JSON: {key}{word} is not a number; all numbers must be finite")


def _unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    if len(pairs) > _MOST_KEYS:
        raise ModelError(f"an object has {len(pairs)} keys; at most {_MOST_KEYS} are read")
    members = dict(pairs)
    if len(members) < len(pairs):
        twice = Counter(key for key, _ in pairs).most_common(1)[0][0]
        raise ModelError(f"key {twice!r} appears twice in one object; keep one of them")
    return members
