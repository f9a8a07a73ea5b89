import base64
import hashlib
import json
import re
from dataclasses import replace
from html.parser import HTMLParser

import numpy as np
import pytest
from stones import model_of, portal_stones

import limitblocks as lb
from limitblocks.drawing import painter, picture
from limitblocks.evidence.backward_error import MEANINGS, BackwardError
from limitblocks.evidence.residuals import Residual
from limitblocks.problem import Turning
from limitblocks.reports.facts import facts
from limitblocks.reports.words import at_most


def portal(name="lintel", joint=None):
    blocks = portal_stones(lintel=name)
    return model_of(blocks, ["ground"], joint or lb.OrdunaLourenco(0.6), name=f"Portal {name}")


def grid(across, up, slide):
    """Boxes stacked in columns on a base, with displacement rates that slide every block."""
    blocks = [lb.Block.box("base", (across + 2, 3, 1), (across / 2, 0, -0.5))]
    blocks += [
        lb.Block.box(f"b{i}.{k}", (1, 1, 1), (i + 0.5, 0, k + 0.5), 1e3)
        for i in range(across)
        for k in range(up)
    ]
    model = model_of(blocks, ["base"], lb.PointContact(0.5))
    rates = np.zeros((len(blocks), 6))
    rates[1:, 0] = slide
    return model, rates


def nonassociated(bounds):
    names = ("stress_resultants", "generalised_stresses", "displacement_rates", "flow_multipliers")
    names += ("dead_load_stresses",)
    state = {name: getattr(bounds, name) for name in (*names, "residuals", "digest")}
    return lb.results.Nonassociated(
        load_factor=0.2,
        frictionless=0.1,
        associated=0.3,
        backward_error=BackwardError(*(Residual(name, 1e-9, "") for name in MEANINGS), (), 1e-9, None),
        status=lb.results.Status.CONVERGED,
        how="tracked path",
        history=(),
        dilatancy=0.0,
        turning=Turning.CENTROID,
        remarks=(),
        tolerance=1e-8,
        **state,
    )


class Checked(HTMLParser):
    """Gathers text, tags and open elements."""

    VOID = frozenset({"meta", "path", "line", "circle", "input"})

    def __init__(self, html):
        super().__init__()
        self.tags, self.open, self.text = [], [], ""
        self.feed(html)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.text += data


def without_scripts(html):
    """The page without the text of its scripts, which is no markup."""
    return re.sub(r"(<script[^>]*>).*?(</script>)", r"\1\2", html, flags=re.DOTALL)


@pytest.fixture(scope="module")
def model():
    return portal()


@pytest.fixture(scope="module")
def bounds(model):
    return lb.bounds(model)


@pytest.fixture(scope="module")
def html(model, bounds):
    return lb.report(model, bounds).html


def test_report_says_what_an_engineer_files(html, model, bounds):
    page = Checked(without_scripts(html))
    assert page.open == []
    text = " ".join(page.text.split())
    for part in (
        "Portal lintel",
        f"{bounds.lower:#.4g}",
        at_most(bounds.upper),
        f"{bounds.gap:.1e}",
        "64 kN",
        "friction coefficient 0.6 (31.0 degrees)",
        "Coulomb's circle",
        "Real joints dilate less",
        model.digest,
        lb.__version__,
        np.__version__,
        *(entry.meaning for entry in bounds.residuals.entries),
    ):
        assert part in text
    assert html.count('class="pass">pass') == len(bounds.residuals.entries)


def test_report_refers_to_nothing_outside(html):
    # names of XML vocabularies, which nobody fetches
    names = {"http://www.w3.org/2000/svg", "http://www.w3.org/1999/xhtml"}
    assert set(re.findall(r"(?:https?|wss?)://[^\"'<\s]+", html)) == names
    assert not re.search(r"\b(src|href|style)=|@import|url\(|<link|\bon\w+=", without_scripts(html))
    assert "default-src 'none'" in html


def test_content_security_policy_lets_style_and_scripts_pass_and_nothing_else(html):
    def digest(text):
        return "'sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() + "'"

    styles = re.findall(r"<style>(.*?)</style>", html, flags=re.DOTALL)
    scripts = re.findall(r"<script>(.*?)</script>", html, flags=re.DOTALL)
    (policy,) = re.findall(r'Content-Security-Policy" content="([^"]*)"', html)
    assert policy.split("; ") == [
        "default-src 'none'",
        f"script-src {' '.join(map(digest, scripts))}",
        f"style-src {' '.join(map(digest, styles))}",
        "base-uri 'none'",
        "form-action 'none'",
    ]
    assert len(scripts) == 2
    assert re.findall(r"<script ([^>]*)>", html) == ['type="application/json" id="scene"']


def test_report_can_be_read_aloud(html):
    page = Checked(without_scripts(html))
    attributes = dict(page.tags)
    assert attributes["html"]["lang"] == "en"
    labels = attributes["svg"]["aria-labelledby"].split()
    assert {attrs.get("id") for tag, attrs in page.tags if tag in ("title", "desc")} >= set(labels)
    assert all("scope" in attrs for tag, attrs in page.tags if tag == "th")
    assert [tag for tag, _ in page.tags].count("h1") == 1


def test_failed_residual_is_told_apart(model, bounds):
    html = lb.report(model, replace(bounds, tolerance=1e-20)).html
    assert 'class="fail">FAIL' in html
    assert "looser than the usual" in lb.report(model, replace(bounds, tolerance=1e-3)).html
    assert "looser than the usual" not in lb.report(model, lb.check_mcp(model, bounds, tolerance=1e-6)).html
    assert "looser than the usual" in lb.report(model, lb.check_mcp(model, bounds, tolerance=1e-5)).html


@pytest.mark.parametrize(
    "name",
    ['<script>alert("1")</script>&', "</script><img src=x onerror=alert(1)>", "<!--<script>", "]]>\u2028'"],
)
def test_names_are_escaped(name, html):
    model = portal(name)
    report = lb.report(model, lb.bounds(model))
    other = report.html
    assert other.count("<script") == html.count("<script")
    assert other.count("</script") == html.count("</script")
    assert "<img" not in other
    page = Checked(without_scripts(other))
    assert page.open == []
    assert name in page.text
    (data,) = re.findall(r'id="scene">(.*?)</script>', other, flags=re.DOTALL)
    assert not re.search("[<>&]", data)
    assert name in json.loads(data)["blocks"]["name"]


def test_report_without_results_describes_the_model(model):
    html = lb.report(model).html
    assert "64 kN" in html
    assert re.findall('<svg class="([a-z]+)"', html) == ["views"]


def test_json_holds_the_same_content(model, bounds):
    content = json.loads(lb.report(model, bounds).json)
    assert content["model"]["digest"] == model.digest
    assert content["results"][0]["lower"] == bounds.lower
    assert content["answer"] == {"load_factor": bounds.upper, "certified": False}


def test_two_thousand_blocks_stay_under_three_megabytes(bounds):
    model, rates = grid(50, 40, 1.0)
    random = np.random.default_rng(1)
    full = replace(
        bounds,
        stress_resultants=-1e4 * random.random((len(model.interfaces), 6)),
        generalised_stresses=random.random(model.problem.F.shape[1]),
        displacement_rates=rates * random.random(rates.shape),
        flow_multipliers=random.random(model.problem.F.shape[0]),
        digest=model.digest,
    )
    end = nonassociated(full)
    steps = [
        lb.results.PathStep(
            0.1 * k, end.stress_resultants, k * end.displacement_rates, (), {"yield": 0.0}, "step"
        )
        for k in range(20)
    ]
    report = lb.report(model, full, end, lb.results.LoadPath(tuple(steps), end))
    assert len(report.picture.blocks) == 2001
    assert len(report.html.encode()) < 3e6


def test_save_replaces_only_our_own_files(model, bounds, tmp_path):
    report, file = lb.report(model, bounds), tmp_path / "report.html"
    assert report.save(file) == file
    assert report.save(str(file)) == file
    with pytest.raises(lb.LimitBlocksError, match="exists"):
        report.save(file, overwrite=False)
    file.write_text("<html>my own page about limitblocks</html>")
    with pytest.raises(lb.LimitBlocksError, match="not written by limitblocks"):
        report.save(file)
    assert "my own page" in file.read_text()
    report.save(file, overwrite=True)
    assert file.read_text(encoding="utf-8") == report.html
    with pytest.raises(lb.LimitBlocksError, match="cannot write"):
        report.save(tmp_path / "none" / "report.html")


def test_unknown_results_and_results_of_other_models_are_refused(model, bounds):
    with pytest.raises(lb.LimitBlocksError, match="cannot show str; expected a result: Adequacy, Bounds"):
        lb.report(model, bounds, "bounds")
    with pytest.raises(lb.LimitBlocksError, match="belongs to model"):
        lb.report(portal("beam"), bounds)


def test_blocks_that_nearly_touch_are_warned_of():
    blocks = [
        lb.Block.box("ground", (4, 1, 1), (0, 0, -0.5)),
        lb.Block.box("left", (1, 1, 1), (-0.502, 0, 0.5), 2e4),
        lb.Block.box("right", (1, 1, 1), (0.502, 0, 0.5), 2e4),
    ]
    model = model_of(blocks, ["ground"], lb.PointContact(0.5))
    (warning,) = facts(model)["warnings"]
    assert "left|right" in warning
    assert facts(portal())["warnings"] == []


@pytest.mark.parametrize("slide", [0.0, 1.0])
def test_nearer_blocks_are_drawn_later(slide):
    model, rates = grid(4, 3, slide)
    order = [block.name for block in picture.mechanism_picture(model, rates).blocks]
    assert order[0] == "base"  # its top is larger and its middle nearer than most blocks, yet all stand on it
    for i in range(4):
        column = [order.index(f"b{i}.{k}") for k in range(3)]
        assert column == sorted(column)  # seen from above
    for k in range(3):
        course = [order.index(f"b{i}.{k}") for i in range(4)]
        assert course == sorted(course)  # seen from the right


def test_painting_order_survives_blocks_in_a_ring():
    # three bars, each on the next: no order is right, but all must be drawn
    sizes = (3, 0.2, 0.2), (0.2, 3, 0.2), (0.2, 0.2, 3)
    blocks = [lb.Block.box(str(k), size, np.roll((0.5, 0.0, -0.5), k)) for k, size in enumerate(sizes)]
    faces = [painter.placed(block.vertices, block.faces) for block in blocks]
    assert sorted(painter.painting_order(faces, np.ones(3) / np.sqrt(3))) == [0, 1, 2]


def test_picture_shows_what_moves_and_how_far():
    model, rates = grid(2, 2, 0.0)
    rates[4, 0] = 7.0
    drawing = picture.mechanism_picture(model, rates)
    kinds = {block.name: block.kind for block in drawing.blocks}
    assert kinds == {"base": "support", "b0.0": "still", "b0.1": "still", "b1.0": "still", "b1.1": "moving"}
    assert drawing.largest == "b1.1"
    assert [ghost.name for ghost in drawing.ghosts] == ["b1.1"]
    assert drawing.magnification * 7.0 == pytest.approx(0.08 * np.linalg.norm((4, 3, 3)))
    assert all(len(block.faces) == 3 for block in drawing.blocks)  # of a box
    numbers = [
        float(n) for block in drawing.blocks for f in block.faces for n in re.findall(r"-?[\d.]+", f.path)
    ]
    assert min(numbers) >= 0.0
    assert max(numbers) <= max(1000.0, drawing.height)
