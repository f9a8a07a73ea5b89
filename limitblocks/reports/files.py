"""Writing a report to a file, by its suffix, without harm to the files of others."""

from __future__ import annotations

from pathlib import Path

from limitblocks.errors import LimitBlocksError, path_of
from limitblocks.io.faults import REPORT
from limitblocks.reports.markdown import MARK
from limitblocks.reports.pdf import CREATOR
from limitblocks.written import write

#: Suffixes of the formats, and what is in files of ours and in no others.
MARKS = {
    ".html": b'<meta name="generator" content="limitblocks ',
    ".json": f'"format": "{REPORT}"'.encode(),
    ".md": MARK.encode(),
    ".pdf": f"/Creator ({CREATOR})".encode(),
}
_MARK_WITHIN = 4096  # bytes from the start of the file, except in a PDF


def suffix(file: str | Path) -> str:
    """Return the suffix of a report file in small letters.

    Raises
    ------
    LimitBlocksError
        It is none of the formats of reports.
    """
    ending = path_of(file).suffix.lower()
    ending = ".html" if ending == ".htm" else ending
    if ending not in MARKS:
        known = ", ".join(MARKS)
        raise LimitBlocksError(
            f"{file}: a report cannot be written as {ending or 'no suffix'!r}; use {known}"
        )
    return ending


def save(file: str | Path, data: str | bytes, kind: str, overwrite: bool | None) -> Path:
    """Write a report in the format of suffix `kind` to a file; see :meth:`Report.save`."""
    path = path_of(file)
    if overwrite is None and path.is_file():
        if not _ours(path, kind):
            raise LimitBlocksError(
                f"{path} exists and was not written by limitblocks; give another name or overwrite=True"
            )
        overwrite = True
    return write(path, data, bool(overwrite))


def _ours(path: Path, kind: str) -> bool:
    """Whether `path` is a report of ours, by the mark in it."""
    try:
        with path.open("rb") as stream:
            return MARKS[kind] in stream.read(-1 if kind == ".pdf" else _MARK_WITHIN)
    except OSError:
        return False
