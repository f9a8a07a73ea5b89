"""One document, five renderings: what it says, that all of them say it, and the number that is large."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest
from markupsafe import escape
from renderings import RENDERINGS, missing, pages, squeezed
from stones import model_of

import limitblocks as lb
from limitblocks.evidence.ending import Status
from limitblocks.reports.answer import Answer, answer
from limitblocks.reports.document import Chapter, Table
from limitblocks.reports.facts import fact_rows
from limitblocks.reports.interfaces import relative_motion
from limitblocks.reports.markdown import escaped
from limitblocks.reports.pdf import pdf

HOSTILE = '</style><script>alert("1")</script> } @page {'
WORDS = ("unit weight", "acceleration", "safety", "sensitivity", "author")


@pytest.fixture(scope="module")
def house():
    return lb.structures.facade(
        lb.OrdunaLourenco(0.6), length=2.4, courses=3, return_length=1.6, openings=(), direction=(0, 1, 0)
    )


@pytest.fixture(scope="module")
def results(house):
    return lb.bounds(house), lb.nonassociated(house), lb.stability(house)


@pytest.fixture(scope="module")
def report(house, results):
    check = lb.check_mcp(house, results[1])
    about = {"author": "A. <Mason> & Daughter", "project": "12|3 *Church* Lane", "notes": "one\ntwo"}
    return lb.report(house, *results, check, title="The house", demand=0.1, **about)


def down(value, decimals=4):
    """The text of a number, cut."""
    return f"{np.floor(value * 10**decimals) / 10**decimals:.{decimals}f}"


@pytest.mark.parametrize("rendering", RENDERINGS)
def test_every_fact_is_in_every_rendering(rendering, report):
    assert len(list(report.document.facts())) > 300
    assert missing(report, rendering) == []


@pytest.mark.parametrize("rendering", RENDERINGS)
def test_report_of_a_house_has_the_words_an_authority_looks_for(rendering, house):
    said = RENDERINGS[rendering](lb.report(house)).lower()
    for word in WORDS:
        assert squeezed(word) in squeezed(said), word


def test_the_large_number_is_the_least_certified_one_without_dilatancy(house, results):
    bounds, solved, _ = results
    assert solved.load_factor < bounds.lower
    found = answer(lb.report(house, bounds, solved).sections)
    assert (found.load_factor, found.certified) == (solved.load_factor, True)
    html = lb.report(house, bounds, solved).html
    assert re.search(r'class="number">([^<]*)<', html)[1] == down(solved.load_factor)
    higher = replace(solved, load_factor=1.5 * solved.load_factor)
    least = answer(lb.report(house, higher, bounds, solved).sections)
    assert least.load_factor == solved.load_factor
    assert "least of the 2 certified" in least.reason


def test_what_is_not_certified_is_an_upper_estimate_and_says_so(house, results):
    bounds, solved, stands = results
    stalled = replace(solved, status=Status.OUT_OF_STEPS)
    found = answer(lb.report(house, stalled, bounds).sections)
    assert (found.load_factor, found.certified) == (bounds.upper, False)
    made = lb.report(house, stalled, bounds)
    assert "real friction dilates less than associated flow assumes" in made.markdown
    assert f"≤ {-float(down(-bounds.upper)):.4f}" in made.html
    assert answer(lb.report(house, stalled, stands).sections).load_factor is None
    assert "no load factor to design with" in lb.report(house, stands).html


def test_an_acceleration_is_said_where_the_live_load_is_one(house, results):
    said = answer(lb.report(house, *results).sections).quantity(house)
    factor = results[1].load_factor
    assert "a horizontal acceleration along +Y" in said
    assert f"{down(factor)} g" in said
    assert f"{down(factor * 9.80665, 3)} m/s²" in said
    twice = replace(house, live=2.0 * house.live)
    assert f"{2.0 * 0.5:#.4g} g" in Answer(0.5, True, "").quantity(twice)
    again = replace(house, live=0.5 * house.live + 1.5 * house.live)  # of each mass twice its weight
    assert f"{2.0 * 0.5:#.4g} g" in Answer(0.5, True, "").quantity(again)
    block = house.free_blocks[0]
    tank = lb.loads.added_mass(block.name, block.centroid.tolist(), weight=1e3)
    still = replace(house, dead=lb.self_weight([tank]))  # weighs, and nothing pushes it
    assert " g = " not in Answer(0.5, True, "").quantity(still)
    moved = replace(still, live=lb.mass_proportional((0, 1, 0), [tank]))
    assert f"{0.5:#.4g} g" in Answer(0.5, True, "").quantity(moved)
    uneven = replace(moved, live=moved.live + lb.mass_proportional((0, 1, 0)))  # 2 of all but the tank
    across = replace(house, live=house.live + lb.mass_proportional((1, 0, 0)))
    for one in (uneven, across):
        assert " g = " not in Answer(0.5, True, "").quantity(one)
    pushed = replace(
        house, live=house.live + lb.loads.force(house.free_blocks[0].name, (1e3, 0, 0), (0, 0, 0))
    )
    assert " g = " not in Answer(0.5, True, "").quantity(pushed)


def test_a_demand_is_in_json_and_a_wrong_one_is_refused(house, report, results):
    content = json.loads(report.json)
    assert content["demand"] == 0.1
    assert content["ratio"] == results[1].load_factor / 0.1
    assert json.loads(lb.report(house).json)["ratio"] is None
    assert "not compared" in lb.report(house, demand=0.1).markdown
    for wrong in (0.0, -1.0, np.inf, np.nan):
        with pytest.raises(lb.LimitBlocksError, match=r"demand is .*, expected a load factor > 0"):
            lb.report(house, demand=wrong)


def test_labels_are_text_and_nothing_else(house):
    made = lb.report(house, title=HOSTILE, author=HOSTILE, project=HOSTILE, notes=HOSTILE).html
    plain = lb.report(house, title="x", author="x", project="x", notes="x").html
    for tag in ("<script", "</script", "<style", "</style"):
        assert made.count(tag) == plain.count(tag)
    assert '@top-left { content: "\\00003c' in made  # its < in a style, by its number
    assert made.count(escape(HOSTILE)) == 5  # title of the window and of the page, author, project, notes
    assert HOSTILE in json.loads(re.search(r'id="scene">(.*?)</script>', made, re.DOTALL)[1])["title"]


def test_a_saved_result_is_reported(house, results, tmp_path):
    for result, name in ((results[1], "solved"), (results[0], "bounds")):
        file = tmp_path / f"{name}.json"
        lb.files.write_result(result, file)
        made = lb.report(house, lb.read_result(file, house))
        assert down(result.load_factor) in made.html
    assert answer(lb.report(house, lb.read_result(tmp_path / "solved.json", house)).sections).certified
    changed = json.loads((tmp_path / "solved.json").read_text())
    changed["load_factor"] *= 1.1
    (tmp_path / "solved.json").write_text(json.dumps(changed))
    made = lb.report(house, lb.read_result(tmp_path / "solved.json", house))
    assert not answer(made.sections).certified
    assert "FAIL" in made.markdown


def test_joints_that_move_most_come_first():
    """A block that slides by 1 and turns by w about Z: its corners move by |(1, 0) + w x r|."""
    blocks = [lb.Block.box("ground", (4, 4, 1), (0, 0, -0.5)), lb.Block.box("a", (1, 1, 1), (0, 0, 0.5), 1e3)]
    model = model_of(blocks, ["ground"], lb.PointContact(0.5))
    w = 0.3
    rates = np.array([np.zeros(6), [1, 0, 0, 0, 0, w]])
    corners = [np.hypot(1.0 - w * y, w * x) for x in (-0.5, 0.5) for y in (-0.5, 0.5)]
    assert relative_motion(model, rates) == pytest.approx([max(corners)])
    assert relative_motion(model, np.zeros((2, 6))) == pytest.approx([0.0])


def test_every_page_has_its_number_the_title_and_the_hash(report):
    sheets = pages(pdf(report.document))
    titles = {chapter.title for chapter in report.document.chapters}
    assert len(sheets) > 2
    for k, sheet in enumerate(sheets, start=1):
        assert f"Page {k} of {len(sheets)}" in sheet
        assert report.model.digest in sheet
        assert "The house" in sheet
        lines = [line for line in sheet.splitlines() if not re.match("Model |Page |limitblocks report", line)]
        assert lines[-1] not in titles  # no heading is left alone at the end of a page


def test_tables_repeat_their_heads_on_every_page(report):
    table = Table.of("Long", ("First head", "Second head"), [(f"row {k}", "x") for k in range(200)])
    sheets = pages(pdf(replace(report.document, chapters=(Chapter("Long", (table,)),))))
    assert len(sheets) > 2
    assert all("First head" in sheet for sheet in sheets if "row " in sheet)


def test_a_report_of_a_structure_that_falls_begins_with_it():
    thin = lb.structures.arch(lb.PointContact(0.6), radius=5.0, thickness=0.4, voussoirs=15)
    first = lb.report(thin, lb.stability(thin)).text.split("Picture")[0][:600]
    assert "falls" in first
    assert "Stability under the dead loads" in first


def test_a_load_factor_is_not_shown_without_the_self_stress_that_it_needs():
    """A block between two walls is held only where it is wedged: the head of the report says so."""
    stones = [
        lb.Block.box("left", (1, 1, 1), (-1, 0, 0)),
        lb.Block.box("right", (1, 1, 1), (1, 0, 0)),
        lb.Block.box("held", (1, 1, 1), (0, 0, 0), unit_weight=20e3),
    ]
    model = model_of(stones, ["left", "right"], lb.PointContact(0.6), (0, 1, 0))
    chapter = lb.report(model, lb.stability(model)).text
    assert "stands only by self-stress" in chapter[:600]
    assert "with a margin of 1 of the largest dead load tied to an interface" in " ".join(chapter.split())


def test_what_to_know_of_the_number_stands_beside_it(house, results):
    """A remark of the answer, and a backward error larger than what is known of friction: 20 %."""
    result = results[1]
    error = result.backward_error
    told = replace(result, remarks=("another way led here",))
    far = replace(told, backward_error=replace(error, limits=replace(error.limits, value=1.3, where="a|b")))
    near = replace(told, backward_error=replace(error, limits=replace(error.limits, value=0.19)))
    for one, said in ((told, 1), (near, 1), (far, 2)):
        head = lb.report(house, one, results[0], demand=0.1).document.chapters[0]
        warned = [part.text for part in head.parts if getattr(part, "warning", False)]
        assert len(warned) == said
        assert warned[0] == "Another way led here."
    assert "backward error 1.3e+00 (limits at a|b)" in warned[1]
    lowest = replace(told, load_factor=result.load_factor / 2, remarks=("lower",))
    head = lb.report(house, told, lowest).document.chapters[0]
    assert [part.text for part in head.parts if getattr(part, "warning", False)] == ["Lower."]


def test_an_empty_report_says_so_in_a_line(house):
    assert str(lb.report(house, title="The house")) == "report 'The house': no load factor to design with"


def test_one_block_is_one_block():
    facts = dict(fact_rows(lb.report(lb.structures.block(lb.PointContact(0.5), width=1.0, height=1.0)).facts))
    assert facts["Unit weight 20 kN/m³"].startswith("1 block, ")


def test_no_name_of_an_interface_is_broken_over_lines_as_text():
    model = lb.structures.wall(lb.PointContact(0.6), length=1.6, courses=5)
    found = lb.bounds(model)
    states = lb.interface_states(model, found)
    moving = [name for name, state in zip(states.names, states.state, strict=True) if state != "stick"]
    lines = lb.report(model, found).text.splitlines()
    assert moving
    for name in moving:
        assert any(line.startswith(f"{name} ") for line in lines), name


def test_an_ampersand_is_escaped_in_markdown_where_it_would_begin_an_entity_alone(house):
    assert "Orduña & Lourenço (2005)" in lb.report(house).markdown
    assert escaped("A & B, R&amp;D, &#38;") == r"A & B, R\&amp;D, \&\#38;"
