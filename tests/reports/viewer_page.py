"""The page of a report as a reader sees it: its picture, its card, its controls."""

import base64
from io import BytesIO

import numpy as np
import pytest

Image = pytest.importorskip("PIL.Image", reason="the package pillow is not installed")


def drawn(page):
    """Pixels of the picture, without what lies over it and the frame of the focus."""
    page.evaluate(
        """() => {
          for (const over of document.querySelectorAll(".stage > :not(canvas)")) over.style.opacity = 0;
          return new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
        }"""
    )
    page.locator("canvas").scroll_into_view_if_needed()
    area = page.evaluate(
        """() => {
          const { x, y, width, height } = document.querySelector("canvas").getBoundingClientRect();
          return { x: x + scrollX + 8, y: y + scrollY + 8, width: width - 16, height: height - 16, scale: 1 };
        }"""
    )
    # not by playwright, which puts a style into the page that the page's policy refuses
    session = page.context.new_cdp_session(page)
    png = base64.b64decode(session.send("Page.captureScreenshot", {"clip": area})["data"])
    session.detach()
    page.evaluate(
        "() => { for (const over of document.querySelectorAll('.stage > *')) over.style.opacity = ''; }"
    )
    with Image.open(BytesIO(png)) as image:
        return np.asarray(image.convert("RGB")).astype(int)


def shades(pixels):
    """How many colours there are."""
    return len(np.unique(pixels @ (65536, 256, 1)))


def show(page, mode):
    page.locator(f"input[name=mode][value={mode}]").check()


def slide(page, name, value):
    page.locator(f"input[name={name}]").evaluate(
        "(input, value) => { input.value = value; input.dispatchEvent(new Event('input')); }", str(value)
    )


def card(page):
    """Name and data of the card that is open, or None."""
    if not page.locator(".card").is_visible():
        return None, {}
    terms, values = page.locator(".card dt").all_inner_texts(), page.locator(".card dd").all_inner_texts()
    return page.locator(".card .name").inner_text(), dict(zip(terms, values, strict=True))
