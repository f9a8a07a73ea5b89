"""The report in a browser, if there is one: Chromium with WebGL in software."""

import re
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from browsers import FLAGS, FOUND, SOFTWARE, needed, watch
from renderings import pages
from stones import model_of, portal_stones
from viewer_page import Image, card, drawn, shades, show, slide

import limitblocks as lb
from limitblocks.practice import reinforced, tie

playwright = pytest.importorskip("playwright.sync_api", reason="the package playwright is not installed")
pytestmark = needed
HOSTILE = "</script><img src=x onerror=alert(1)>"
FORMULA = "=cmd|A1"


@pytest.fixture(scope="module")
def model():
    blocks = portal_stones(FORMULA, HOSTILE)
    return model_of(blocks, ["ground"], lb.OrdunaLourenco(0.6), name=HOSTILE)


@pytest.fixture(scope="module")
def results(model):
    return lb.bounds(model), lb.load_path(model)


@pytest.fixture(scope="module")
def file(model, results, tmp_path_factory):
    return lb.report(model, *results).save(tmp_path_factory.mktemp("report") / "portal.html")


@pytest.fixture(scope="module")
def chromium():
    with playwright.sync_playwright() as driver:
        yield driver.chromium


@pytest.fixture(scope="module")
def open_page(chromium, file):
    """The report, once for all tests, with what went wrong in it and what it asked for."""
    browser = chromium.launch(executable_path=FOUND, args=[*FLAGS, *SOFTWARE])
    page = browser.new_page(viewport={"width": 800, "height": 600}, color_scheme="light")
    page.set_default_timeout(10_000)
    watch(page)
    page.goto(file.as_uri())
    page.wait_for_selector("#viewer[data-ready]")
    yield page
    browser.close()


@pytest.fixture
def page(open_page, file):
    """The report as it was opened, and the assurance that nothing went wrong or out."""
    open_page.emulate_media(media="screen")
    open_page.locator("canvas").press("Escape")
    open_page.locator("[name=result]").select_option("0")
    show(open_page, "structure")
    show(open_page, "mechanism")
    open_page.locator("[data-view=iso]").click()
    yield open_page
    # the software renderer complains of screenshots
    assert [fault for fault in open_page.faults if "GPU stall due to ReadPixels" not in fault] == []
    assert [url for url in open_page.requests if not url.startswith("blob:")] == [file.as_uri()]


def test_structure_is_drawn_in_every_mode(page):
    pictures = []
    for mode in ("structure", "mechanism", "forces", "states"):
        show(page, mode)
        pictures.append(drawn(page))
        assert shades(pictures[-1]) > 20, mode
    for one, other in pairwise(pictures):
        assert (np.abs(one - other).sum(axis=2) > 30).mean() > 0.01


def test_mechanism_moves_with_the_slider_and_comes_back(page):
    show(page, "mechanism")
    pictures = {}
    for motion in (0, 50, 100):
        slide(page, "motion", motion)
        pictures[motion] = drawn(page)
    slide(page, "motion", 0)
    assert (drawn(page) == pictures[0]).all()
    changed = {motion: (np.abs(pictures[motion] - pictures[0]).sum(axis=2) > 30).sum() for motion in pictures}
    assert 500 < changed[50] < changed[100]
    page.locator("[name=play]").click()
    assert page.locator("[name=play]").inner_text() == "Pause"
    motion = page.locator("[name=motion]")
    seen = {motion.input_value() for _ in range(20) if not page.wait_for_timeout(30)}
    assert len(seen) > 2
    page.locator("[name=play]").click()
    assert page.locator("[name=play]").inner_text() == "Play"


def test_pointing_at_a_block_opens_its_card(page, model):
    """Along a line at half height the eye meets the left leg, the opening, then the right leg."""
    show(page, "structure")
    page.locator("[data-view=front]").click()
    area = page.locator("canvas").bounding_box()
    met = []
    for share in np.linspace(0.05, 0.95, 31):
        page.mouse.click(area["x"] + share * area["width"], area["y"] + 0.5 * area["height"])
        name, data = card(page)
        met += [] if met and met[-1] == name else [name]
        if name:
            assert data["Weight"] == "20 kN"
            page.keyboard.press("Escape")
    assert met == [None, FORMULA, None, "right", None]


def test_a_click_before_the_next_frame_meets_what_will_be_seen(page):
    """A slow renderer has not drawn the front yet; the legs stand a quarter of its width from the middle."""
    page.evaluate(
        """() => {
          [held, frame] = [[], requestAnimationFrame];
          requestAnimationFrame = (then) => held.push(then);
        }"""
    )
    page.locator("[data-view=front]").click()
    area = page.locator("canvas").bounding_box()
    met = []
    for share in (0.5, 0.7):
        page.mouse.click(area["x"] + share * area["width"], area["y"] + 0.5 * area["height"])
        met.append(card(page)[0])
    page.evaluate("() => { requestAnimationFrame = frame; held.forEach((then) => frame(then)); }")
    assert met == [None, "right"]


def test_interface_card_says_what_the_result_says(page, model, results):
    show(page, "states")
    page.locator("[name=find]").fill(f"{FORMULA}|{HOSTILE}")
    page.locator("[name=find]").press("Enter")
    name, data = card(page)
    k = [interface.name for interface in model.interfaces].index(name)
    Q = results[0].stress_resultants[k]
    for component, value in zip(("V1", "V2", "N"), Q[:3], strict=True):
        number, unit = data[component].split()[:2]
        assert float(number) * {"kN": 1e3, "N": 1.0}[unit] == pytest.approx(value, rel=1e-3, abs=1e-2)
    interface = model.interfaces[k]
    e = np.array([-Q[4], Q[3]]) / Q[2] @ interface.axes[:2]
    centre = [float(number) for number in data["Centre of pressure"].removesuffix(" m").split(", ")]
    assert centre == pytest.approx(interface.centroid + e, abs=1e-3)
    page.locator(".card .links button").last.click()
    assert card(page)[0] == HOSTILE


def test_load_path_is_walked_step_by_step(page, results):
    page.locator("[name=result]").select_option(label="Load path")
    path = results[1]
    assert page.locator("[name=step]").get_attribute("max") == str(len(path.steps) - 1)
    slide(page, "step", 0)
    assert f"step 0 of {len(path.steps) - 1}: load factor 0" in page.locator(".label").inner_text()
    slide(page, "step", len(path.steps) - 1)
    assert f"{path.load_factor:.6g}" in page.locator(".label").inner_text()


def test_keys_turn_and_pick(page):
    page.locator("canvas").focus()
    before = drawn(page)
    page.keyboard.press("ArrowLeft")
    assert (drawn(page) != before).any()
    page.keyboard.press("n")
    assert card(page)[0] == "ground"
    page.keyboard.press("n")
    assert card(page)[0] == FORMULA
    page.keyboard.press("Escape")
    assert card(page)[0] is None
    page.keyboard.press("0")
    assert (drawn(page) == before).all()


def test_table_sorts_by_key_and_says_so(page):
    table = page.locator("table.sortable").first
    head = table.locator("thead th", has_text="N, kN")
    column = page.evaluate("(head) => head.cellIndex", head.element_handle())

    def numbers():
        return [
            float(text) for text in table.locator(f"tbody tr > :nth-child({column + 1})").all_inner_texts()
        ]

    before = numbers()
    assert len(set(before)) > 1
    head.locator("button").focus()
    page.keyboard.press("Enter")
    assert numbers() == sorted(before, reverse=True)
    assert head.get_attribute("aria-sort") == "descending"
    page.keyboard.press("Enter")
    assert numbers() == sorted(before)
    assert head.get_attribute("aria-sort") == "ascending"


def test_csv_holds_every_interface(page, model, results):
    import csv

    with page.expect_download() as download:
        page.locator("button[data-csv='0']").click()
    with open(download.value.path(), newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    names = [interface.name for interface in model.interfaces]
    assert [row["interface"].removeprefix("'") for row in rows] == names
    assert not any(cell.startswith("=") for row in rows for cell in row.values())
    N = np.array([float(row["N (N)"]) for row in rows])
    assert np.allclose(N, results[0].stress_resultants[:, 2], rtol=1e-5, atol=1e-2)
    centres = [[float(row[f"centre of pressure {axis} (m)"]) for axis in "XYZ"] for row in rows]
    assert np.allclose(centres, lb.interface_states(model, results[0]).centre_of_pressure, atol=1e-5)
    places = [[float(row[f"centroid {axis} (m)"]) for axis in "XYZ"] for row in rows]
    assert np.allclose(places, [interface.centroid for interface in model.interfaces], atol=1e-5)


def test_picture_is_saved_as_png(page):
    with page.expect_download() as download:
        page.locator("[name=png]").click()
    with Image.open(download.value.path()) as image:
        assert image.format == "PNG"
        assert shades(np.asarray(image.convert("RGB")).astype(int)) > 20


def test_on_a_phone_the_legend_comes_below_the_picture(page):
    page.set_viewport_size({"width": 390, "height": 844})
    try:
        picture, legend, triad = (page.locator(one).bounding_box() for one in ("canvas", ".legend", ".triad"))
    finally:
        page.set_viewport_size({"width": 800, "height": 600})
    assert legend["y"] >= picture["y"] + picture["height"] - 1
    assert triad["y"] + triad["height"] <= picture["y"] + picture["height"]


def test_dark_and_light_are_switched(page):
    def brightness():
        colour = page.evaluate("getComputedStyle(document.body).backgroundColor")
        return sum(map(int, re.findall(r"\d+", colour)[:3]))

    assert brightness() == 3 * 255
    light = drawn(page)
    page.locator("#theme").click()
    assert brightness() < 150
    assert drawn(page)[:40, -40:].mean() < 60 < light[:40, -40:].mean()
    assert page.locator("#theme").get_attribute("aria-pressed") == "true"
    page.locator("#theme").click()
    assert (drawn(page) == light).all()


def test_print_shows_the_drawing_in_place_of_the_canvas(page):
    assert page.locator("canvas").is_visible()
    assert not page.locator("figure.static").is_visible()
    page.emulate_media(media="print")
    assert not page.locator("canvas").is_visible()
    assert page.locator("figure.static svg").is_visible()


def test_printed_pages_have_number_title_and_hash_and_no_head_alone(page, model, results):
    page.emulate_media(media="print")
    sheets = pages(page.pdf(prefer_css_page_size=True))
    titles = [chapter.title for chapter in lb.report(model, *results).document.chapters]
    assert len(sheets) > 3
    for k, sheet in enumerate(sheets, start=1):
        assert f"Page {k} of {len(sheets)}" in sheet
        assert model.digest in sheet
        assert sheet.count("alert(1)") > 0  # the title, which is hostile, above
        margins = "Model [0-9a-f]{64}|Page |limitblocks"
        lines = [line for line in sheet.splitlines() if not re.match(margins, line)]
        assert lines[-1] not in titles
    assert page.locator("table.sortable").count() == 2
    for sheet in sheets:  # rows never stand without their heads
        if re.search(r"(?<!-)hinge", sheet) and "Orduña" not in sheet:
            assert re.search("Utilisation|Begins to", sheet)


def test_sentences_in_tables_stay_readable_on_a_phone_and_on_paper(open_page, model, tmp_path):
    """Values of words wrap: they left the sentence beside them one letter a line."""
    page = open_page.context.browser.new_page(viewport={"width": 390, "height": 844})
    solved = lb.nonassociated(model)
    long = replace(solved, how=f"{solved.how}, {'words that say the way, ' * 4}")
    page.goto(lb.report(model, long).save(tmp_path / "long.html").as_uri())
    cells = "[...document.querySelectorAll('table:not(.sortable) td:not([class])')]"
    narrowest = f"Math.min(...{cells}.filter(cell => cell.offsetWidth).map(cell => cell.clientWidth))"
    assert page.evaluate(narrowest) >= 8 * 0.9 * 16
    page.emulate_media(media="print")
    page.set_viewport_size({"width": 672, "height": 990})  # A4 less its margins, CSS pixels
    assert page.evaluate(narrowest) >= 8 * 16
    page.close()


def test_model_without_results_is_shown(open_page, model, tmp_path):
    page = open_page.context.browser.new_page()
    watch(page)
    page.goto(lb.report(model).save(tmp_path / "model.html").as_uri())
    page.wait_for_selector("#viewer[data-ready]")
    page.locator("canvas").press("n")
    page.locator("canvas").press(" ")
    assert card(page)[0] == "ground"
    assert page.locator("[name=mode]").count() == 1
    assert not page.locator("[name=play]").is_visible()
    assert page.faults == []
    page.evaluate(
        """() => {
          const foreign = document.createElement("script");
          foreign.textContent = "window.ran = true";
          document.body.append(foreign);
        }"""
    )
    assert page.evaluate("window.ran") is None  # the policy is in force
    assert "Content Security Policy" in page.faults[0]
    page.close()


def test_without_webgl_the_drawing_remains(chromium, file):
    browser = chromium.launch(executable_path=FOUND, args=[*FLAGS, "--disable-3d-apis"])
    page = browser.new_page()
    page.goto(file.as_uri())
    assert page.locator("#no-webgl").is_visible()
    assert page.locator("figure.static svg").is_visible()
    assert not page.locator("#viewer").is_visible()
    here, place, after = (
        page.locator(one).first.bounding_box()["y"]
        for one in ("figure.static", "#no-webgl", "section:has(> #no-webgl) ~ section")
    )
    assert place < here < after  # where the picture would be
    browser.close()


def test_ties_are_seen_in_the_colour_of_their_state(chromium, tmp_path):
    """One yields (#a6093d), one goes slack (#b9b4ab): in the mechanism, in the legend, in their cards."""
    wall = lb.structures.block(lb.PointContact(0.6), width=0.2, height=1.0)
    (block,), (support,) = wall.free_blocks, wall.supports
    at = block.centroid + np.array([0.0, 0.0, 0.4])
    rods = [
        tie(block.name, at, support, at + np.array([x, 0.0, 0.0]), area=1e-4, strength=1e6) for x in (-1, 1)
    ]
    model = reinforced(wall, *rods)
    file = lb.report(model, lb.nonassociated(model)).save(tmp_path / "tied.html")
    browser = chromium.launch(executable_path=FOUND, args=[*FLAGS, *SOFTWARE])
    page = browser.new_page(viewport={"width": 800, "height": 600}, color_scheme="light")
    watch(page)
    page.goto(file.as_uri())
    page.wait_for_selector("#viewer[data-ready]")
    for mode in ("mechanism", "states"):
        show(page, mode)
        pixels = drawn(page)
        for colour in ((0xA6, 0x09, 0x3D), (0xB9, 0xB4, 0xAB)):
            assert (np.abs(pixels - colour).max(axis=-1) <= 3).sum() > 30, (mode, colour)
    show(page, "mechanism")
    assert {"tie: yield", "tie: slack"} <= set(page.locator(".legend li").all_inner_texts())
    page.locator("input[type=search]").fill("tie")
    page.locator("input[type=search]").press("Enter")
    assert card(page)[1]["State"] == "yield (Y)"
    assert [fault for fault in page.faults if "GPU stall due to ReadPixels" not in fault] == []
    browser.close()
