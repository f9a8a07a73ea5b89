"""Results as files an engineer keeps: self-contained HTML and JSON; no mechanics."""

from limitblocks.report.report import Report, report

__all__ = ["Report", "report"]
