"""Where a Chromium is that tests may use, and how it is started."""

import os
import shutil

import pytest

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
FOUND = os.environ.get("LIMITBLOCKS_BROWSER") or next(filter(None, map(shutil.which, NAMES)), None)
SOFTWARE = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
FLAGS = ["--no-sandbox", "--disable-quic", "--no-first-run"]
needed = pytest.mark.skipif(
    not FOUND,
    reason=f"no browser: none of {', '.join(NAMES)} is on the PATH and LIMITBLOCKS_BROWSER is not set",
)


def watch(page):
    """Keep what goes wrong in a page and what it asks for."""
    page.faults, page.requests = [], []
    page.on("console", lambda message: page.faults.append(message.text))
    page.on("pageerror", lambda error: page.faults.append(str(error)))
    page.on("dialog", lambda dialog: (page.faults.append("dialog"), dialog.dismiss()))
    page.on("request", lambda request: page.requests.append(request.url))
