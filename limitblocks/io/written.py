"""Files out: nothing of the user's is overwritten by chance, and every failure is one line."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from limitblocks.errors import LimitBlocksError


def refuse_existing(files: Iterable[Path], overwrite: bool) -> None:
    """Raise LimitBlocksError where one of `files` exists and `overwrite` is false."""
    for path in files:
        if not overwrite and path.exists():
            raise LimitBlocksError(f"{path} exists; give another name or overwrite=True")


def write(path: Path, data: bytes, overwrite: bool) -> Path:
    """Write `data` to the file at `path` and return the path.

    Raises
    ------
    LimitBlocksError
        The file exists and `overwrite` is false, or it cannot be written.
    """
    try:
        with path.open("wb" if overwrite else "xb") as stream:
            stream.write(data)
    except FileExistsError:
        raise LimitBlocksError(f"{path} exists; give another name or overwrite=True") from None
    except (OSError, ValueError) as error:
        raise LimitBlocksError(f"cannot write {path}: {getattr(error, 'strerror', None) or error}") from None
    return path
