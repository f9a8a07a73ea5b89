"""Style and scripts of the HTML report, and the policy that lets these and nothing else run."""

from __future__ import annotations

import base64
import hashlib
import json
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any

from limitblocks.io import strict_json

FOLDER = Path(__file__).parent
_STYLES = ("report.css", "viewer/viewer.css")
_SCRIPTS = (
    "theme",
    "scene",
    "palette",
    "bodies",
    "letters",
    "ties",
    "contacts",
    "stage",
    "triad",
    "card",
    "marker",
    "legend",
    "player",
    "viewer",
    "panel",
    "table",
    "main",
)


@cache
def style() -> str:
    """Return the style sheet of the page."""
    return "".join((FOLDER / name).read_text(encoding="utf-8") for name in _STYLES)


@cache
def scripts() -> tuple[str, str]:
    """Return three.js with its licence, and the viewer: two scripts to be put into the page as they are."""
    folder = FOLDER / "viewer"
    licence = (folder / "three.LICENSE.txt").read_text(encoding="utf-8").strip()
    three = (folder / "three.min.js").read_text(encoding="utf-8")
    own = "\n".join((folder / f"{name}.js").read_text(encoding="utf-8") for name in _SCRIPTS)
    return f"/*!\n{licence}\n*/\n{three}", f'(() => {{\n"use strict";\n{own}}})();\n'


def printed(title: str, digest: str) -> str:
    """Return the style of printed pages: title above, hash and number of the page below."""
    above = f"@top-left {{ content: {_quoted(title)}; }}"
    below = f"@bottom-left {{ content: {_quoted(f'Model {digest}')}; }}"
    number = '@bottom-right { content: "Page " counter(page) " of " counter(pages); }'
    brand = '@top-right { content: "limitblocks report"; }'
    return f"@page {{ {above} {brand} {below} {number} }}"


def policy(styles: Sequence[str]) -> str:
    """Return the Content-Security-Policy: nothing from anywhere but these styles and the scripts."""
    allowed = " ".join(map(_hash, styles))
    hashes = " ".join(_hash(script) for script in scripts())
    return (
        f"default-src 'none'; script-src {hashes}; style-src {allowed}; base-uri 'none'; form-action 'none'"
    )


def json_in_html(value: Any) -> str:
    """Return JSON that no name in it can break out of its script element."""
    text = json.dumps(strict_json.finite(value), allow_nan=False, separators=(",", ":"))
    return text.replace("&", "\\u0026").replace("<", "\\u003c").replace(">", "\\u003e")


def _quoted(text: str) -> str:
    """Return a CSS string: every character that is no letter or digit by its number."""
    shown = "".join(c if c.isascii() and c.isalnum() else f"\\{ord(c):06x}" for c in " ".join(text.split()))
    return f'"{shown}"'


def _hash(text: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"
