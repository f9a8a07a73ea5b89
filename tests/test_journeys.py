"""From one's own file to the document that is filed, with the commands of the manual and nothing else."""

from itertools import product

import pytest
from browsers import FLAGS, FOUND, SOFTWARE, needed, watch
from typer.testing import CliRunner

from limitblocks.cli import app

AUTHOR, TITLE, PROJECT = "A. Engineer", "Pier at the mill", "Mill bridge 7"
FRICTION, WIDTH, HEIGHT, DEMAND = 0.6, 0.5, 1.0, 0.4
EXPECTED = min(FRICTION, WIDTH / HEIGHT)  # it rocks about its lower edge before it slides
FACES = ((1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4))
VERDICT = "the load factor 0.5000 is 1.25 times the demand 0.4: the demand is reached"


def box(name, low, high, first):
    """A box of an OBJ file, in mm; corners are counted through the file, from 1."""
    corners = [f"v {x} {y} {z}" for x, y, z in product(*zip(low, high, strict=True))]
    return "\n".join([f"o {name}", *corners, *(f"f {' '.join(str(first + k) for k in f)}" for f in FACES)])


def told(*arguments):
    done = CliRunner().invoke(app, [str(one) for one in arguments], env={"COLUMNS": "200"})
    assert done.exit_code == 0, (arguments, done.output)
    return done.stdout


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A pier of two stones on a slab: look, import, non-associated analysis, report as PDF and as HTML."""
    folder = tmp_path_factory.mktemp("engineer")
    stones = (
        ("ground", (-1000, -1000, -200), (1000, 1000, 0)),
        ("lower", (-250, -250, 0), (250, 250, 500)),
        ("upper", (-250, -250, 500), (250, 250, 1000)),
    )
    text = "\n".join(box(*stone, 8 * k) for k, stone in enumerate(stones))
    (folder / "pier.obj").write_text(f"{text}\n", encoding="utf-8")
    assert "ground" in told("look", folder / "pier.obj", "--units", "mm")
    made = ("--friction", FRICTION, "--unit-weight", "20e3", "--live", "1,0,0", "--supports", "ground")
    told("import", folder / "pier.obj", "--units", "mm", *made)
    told("nonassociated", folder / "pier.json", "--output", folder / "solved.json")
    labels = ("--title", TITLE, "--author", AUTHOR, "--project", PROJECT, "--demand", DEMAND)
    for suffix in ("pdf", "html"):
        output = ("--output", folder / f"filed.{suffix}")
        told("report", folder / "pier.json", folder / "solved.json", *labels, *output)
    return folder


def test_the_pdf_has_what_an_authority_asks_for(folder):
    pypdf = pytest.importorskip("pypdf", reason="the package pypdf is not installed")
    sheets = [sheet.extract_text() for sheet in pypdf.PdfReader(folder / "filed.pdf").pages]
    text = " ".join(" ".join(sheets).split())
    for said in (TITLE, AUTHOR, PROJECT, f"{EXPECTED:.4f}", VERDICT, "certified"):
        assert said in text
    assert all(f"Page {k} of {len(sheets)}" in sheet for k, sheet in enumerate(sheets, start=1))


@needed
def test_the_page_opens_with_number_verdict_and_author(folder):
    playwright = pytest.importorskip("playwright.sync_api", reason="the package playwright is not installed")
    with playwright.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=FOUND, args=[*FLAGS, *SOFTWARE])
        page = browser.new_page(viewport={"width": 1000, "height": 800})
        watch(page)
        page.goto((folder / "filed.html").as_uri())
        page.wait_for_selector("#viewer[data-ready]", timeout=20_000)
        number = page.locator(".headline.main .number")
        assert number.inner_text() == f"{EXPECTED:.4f}"
        size = "one => parseFloat(getComputedStyle(one).fontSize)"
        assert number.evaluate(size) > 1.5 * page.locator("main p").last.evaluate(size)
        for said in (TITLE, AUTHOR, PROJECT, VERDICT):
            assert page.get_by_text(said).first.is_visible(), said
        assert page.title() == TITLE
        assert page.faults == []
        assert page.requests == [(folder / "filed.html").as_uri()]
        browser.close()
