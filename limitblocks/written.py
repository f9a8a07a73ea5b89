"""Files out: a file is the old one or the new one at any moment, and every failure is one line."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import asdict, fields, is_dataclass
from pathlib import Path
from typing import Any
from uuid import uuid4

import numpy as np

from limitblocks.errors import LimitBlocksError, ModelError, path_of

_FLOATS = ("float", str(float), "float | None")  # kinds of fields, as they are annotated


def refuse_existing(files: Iterable[Path], overwrite: bool) -> None:
    """Raise LimitBlocksError where one of `files` exists and `overwrite` is false."""
    for path in files:
        if not overwrite and os.path.exists(path):
            raise _exists(path)


def write(file: str | Path, data: bytes | str, overwrite: bool) -> Path:
    """Write `data`, text as UTF-8, to `file` and return its path.

    All goes to a new file in the same folder, which then takes the name: who reads meanwhile, and whatever
    stops the writer, finds the old file or the new one. Devices and pipes are written to directly.

    Raises
    ------
    LimitBlocksError
        The file exists and `overwrite` is false, or it cannot be written.
    """
    path = path_of(file)
    try:
        if isinstance(data, str):
            data = data.encode("utf-8")
        if path.exists() and not path.is_file():
            path.write_bytes(data)
        else:
            _put(path, data, overwrite)
    except FileExistsError:
        raise _exists(path) from None
    except UnicodeEncodeError as error:
        place = ascii(error.object[error.start : error.start + 1])
        raise LimitBlocksError(f"cannot write {path}: {place} in a name is half a character") from None
    except (OSError, ValueError) as error:
        raise LimitBlocksError(f"cannot write {path}: {getattr(error, 'strerror', None) or error}") from None
    return path


def tagged(settings: Any) -> dict[str, Any]:
    """Return a frozen dataclass as a dictionary with its class name under `type`."""
    if not is_dataclass(settings) or isinstance(settings, type):
        raise ModelError(f"{settings!r} cannot be written to a file: it is not a dataclass")
    values = {"type": type(settings).__name__} | asdict(settings)
    return values | {f.name: _plain(f.type, values[f.name]) for f in fields(settings)}


def _plain(kind: Any, value: Any) -> Any:
    """A value of a field as JSON has it; friction=1 and friction=1.0 are one model."""
    value = value.item() if isinstance(value, np.generic) else value
    return float(value) if str(kind) in _FLOATS and value is not None else value


def _exists(path: Path) -> LimitBlocksError:
    return LimitBlocksError(f"{path} exists; give another name or overwrite=True")


def _put(path: Path, data: bytes, overwrite: bool) -> None:
    """Write a new file beside `path` and give it its name."""
    if not overwrite and os.path.lexists(path):
        raise FileExistsError
    target = Path(os.path.realpath(path)) if overwrite else path  # a link stays a link
    fresh = target.with_name(f".{uuid4().hex}.tmp")
    try:
        with fresh.open("xb") as stream:
            stream.write(data)
            stream.flush()
            os.fsync(stream.fileno())  # the name must not reach the disk before the content
        if overwrite:
            if target.exists():
                shutil.copymode(target, fresh)
            os.replace(fresh, target)
        else:
            _named(fresh, target)
    finally:
        with suppress(OSError):
            fresh.unlink(missing_ok=True)


def _named(fresh: Path, target: Path) -> None:
    """Give a new file its name unless that is taken."""
    try:
        os.link(fresh, target)
    except FileExistsError:
        raise
    except OSError:  # a file system without links: another writer may come between
        if os.path.lexists(target):
            raise FileExistsError from None
        os.replace(fresh, target)
