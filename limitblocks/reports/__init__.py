"""Results as files an engineer keeps: HTML, JSON, Markdown and PDF; no mechanics."""

from limitblocks.reports.report import Report, report, report_schema

__all__ = ["Report", "report", "report_schema"]
