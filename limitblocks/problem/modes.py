"""Failure modes of yield rows, in the paper's words, and what each lets an interface do.

Slack and yield are those of ties and dowels.
"""

from __future__ import annotations

from enum import StrEnum


class Mode(StrEnum):
    """Failure mode of a yield row; the value is the paper's word."""

    SLIP = "slip"
    TWIST = "twist"
    SLIP_TWIST = "slip-twist"
    MOMENT_TWIST = "moment-twist"
    HINGE = "hinge"
    CRUSH = "crush"
    OPEN = "open"
    SLACK = "slack"
    YIELD = "yield"

    @property
    def opens(self) -> bool:
        """Whether one side lifts (hinging, crushing, opening of a point): the flow is associated."""
        return self in (Mode.HINGE, Mode.CRUSH, Mode.OPEN)

    @property
    def slides(self) -> bool:
        """Whether it slides."""
        return self in (Mode.SLIP, Mode.SLIP_TWIST)
