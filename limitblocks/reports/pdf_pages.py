"""What stands above and below every page of the PDF."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import Any

from reportlab.pdfgen.canvas import Canvas

_SIDE, _FOOT, _SIZE = 51.0, 25.0, 7.0  # points
_LONGEST = 90  # letters of the title above a page


def numbered(title: str, digest: str, date: datetime) -> type[Canvas]:
    """Return a canvas that writes title, hash and "page k of n", known only when all pages are there.

    The file is dated as the report is, whenever it is saved.
    """

    class Numbered(Canvas):  # type: ignore[misc] # reportlab has no types
        def __init__(self, *args: Any, **settings: Any) -> None:
            super().__init__(*args, **settings)
            self._pages: list[dict[str, Any]] = []
            self.setDateFormatter(lambda *_: f"{date.astimezone(UTC):D:%Y%m%d%H%M%SZ}")

        def showPage(self) -> None:
            self._pages.append(dict(self.__dict__))
            self._startPage()

        def save(self) -> None:
            for number, state in enumerate(self._pages, start=1):
                self.__dict__.update(state)
                _margins(self, title, digest, f"Page {number} of {len(self._pages)}")
                super().showPage()
            super().save()

    return Numbered


def _margins(canvas: Canvas, title: str, digest: str, number: str) -> None:
    wide, tall = canvas._pagesize
    canvas.setFont("Helvetica", _SIZE)
    canvas.drawString(
        _SIDE, tall - _FOOT - _SIZE, title if len(title) <= _LONGEST else f"{title[:_LONGEST]}..."
    )
    canvas.drawRightString(wide - _SIDE, tall - _FOOT - _SIZE, "limitblocks report")
    canvas.drawString(_SIDE, _FOOT, f"Model {digest}")
    canvas.drawRightString(wide - _SIDE, _FOOT, number)
