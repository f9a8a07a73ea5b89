"""What each rendering of a report says, as text."""

import json
import re
from html import unescape
from io import BytesIO

import pytest

from limitblocks.reports import terminal
from limitblocks.reports.pdf import GREEK, latin, pdf


def squeezed(text):
    """The text without white space, which every format puts elsewhere."""
    return re.sub(r"\s+", "", text)


def pages(data):
    pypdf = pytest.importorskip("pypdf", reason="the package pypdf is not installed")
    return [page.extract_text() for page in pypdf.PdfReader(BytesIO(data)).pages]


def in_html(report):
    html = re.sub(r"<(script|style)[^>]*>.*?</\1>", "", report.html, flags=re.DOTALL)
    return unescape(re.sub(r"<[^>]+>", " ", html))


def in_json(report):
    def strings(value):
        if isinstance(value, dict):
            return [text for key, part in value.items() for text in (key, *strings(part))]
        if isinstance(value, list):
            return [text for part in value for text in strings(part)]
        return [str(value)]

    return " ".join(strings(json.loads(report.json)))


def in_pdf(report):
    """The pages less what stands above and below each of them."""
    margins = rf"Model {report.model.digest}|Page \d+ of \d+|limitblocks report\n|^{report.title}\n"
    return plain(" ".join(re.sub(margins, "", page) for page in pages(pdf(report.document))))


RENDERINGS = {
    "html": in_html,
    "json": in_json,
    "markdown": lambda report: re.sub(r"\\(.)", r"\1", report.markdown),
    "terminal": lambda report: terminal.text(report.document, width=2000),
    "pdf": in_pdf,
}


def plain(text):
    """Greek letters, which a PDF has in a font of their own, as letters of that font."""
    return text.translate(str.maketrans(GREEK))


def missing(report, rendering):
    """The facts of a report that a rendering of it does not say."""
    said = squeezed(RENDERINGS[rendering](report))
    facts = report.document.facts()
    if rendering == "pdf":
        return [fact for fact in facts if squeezed(latin(plain(fact))) not in said]
    return [fact for fact in facts if squeezed(fact) not in said]
