"""What models and results show of themselves, in a line, in a notebook and in a real kernel."""

import builtins
import gc
import html
import importlib
import re
import symtable
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.io.result_file import result_text

ROOT = Path(__file__).parents[1]
MODEL = lb.structures.block(lb.PointContact(0.3), width=0.5, height=1.0)
BOUNDS, FOUND, PATH = lb.bounds(MODEL), lb.nonassociated(MODEL), lb.load_path(MODEL)
CHECK, STATES = lb.check_mcp(MODEL, FOUND), lb.interface_states(MODEL, FOUND)
SHOWN = {
    "model": MODEL,
    "bounds": BOUNDS,
    "nonassociated": FOUND,
    "path": PATH,
    "step": PATH.steps[0],
    "stability": lb.stability(MODEL),
    "check": CHECK,
    "states": STATES,
    "diagnosis": lb.diagnose(MODEL),
    "range": lb.load_factor_range(MODEL, paths=1, mechanisms=0),
    "report": lb.report(MODEL, BOUNDS),
    "residuals": FOUND.residuals,
    "backward error": FOUND.backward_error,
    "view": FOUND.view(),
}
COLLAPSING = {"bounds": BOUNDS, "nonassociated": FOUND, "path": PATH}


@pytest.mark.parametrize("thing", SHOWN.values(), ids=SHOWN)
def test_repr_is_one_short_line(thing):
    assert "\n" not in repr(thing)
    assert len(repr(thing)) < 600
    assert "\n" not in str(thing)
    assert len(str(thing)) < 600


@pytest.mark.parametrize("name", sorted(SHOWN.keys() - {"report", "view"}))
def test_html_is_well_formed_and_small(name):
    text = SHOWN[name]._repr_html_()
    ET.fromstring(text)
    assert len(text) < 20_000
    assert "<script" not in text


def test_a_notebook_asks_about_what_is_hardly_meant():
    """A friction of 30 changed nothing to be seen: the block overturns at b/h, proven."""
    steep = lb.structures.block(lb.PointContact(30), width=0.5, height=1.0)
    found = lb.bounds(steep)
    assert abs(found.upper - 0.5) < 1e-6
    for one in (steep, found):
        assert "friction is 30: degrees? tan 30 deg = 0.577" in one._repr_html_()
    assert "Warning" not in MODEL._repr_html_() + BOUNDS._repr_html_()


@pytest.mark.parametrize("name", ["model", "bounds", "nonassociated", "path", "range"])
def test_html_has_a_picture(name):
    assert f"<title>{MODEL.free_blocks[0].name}</title>" in SHOWN[name]._repr_html_()


def test_blocks_of_a_file_are_a_line(tmp_path):
    """Of a survey of a thousand blocks, too."""
    file = lb.files.write_blocks(
        lb.structures.wall(lb.PointContact(0.6), length=4.0, courses=8), tmp_path / "a.obj"
    )
    found = lb.files.read_blocks(file)
    assert repr(found) == f"<{len(found.blocks)} blocks, 1 support>"
    assert str(replace(found, guesses=("mm", "y"))) == f"{len(found.blocks)} blocks, 1 support, 2 guesses"
    for one in (found, lb.files.look(file)):
        assert len(repr(one)) < 200
        assert f"{len(found.blocks)} blocks" in one._repr_html_()


def test_residuals_are_asked_for_by_name():
    assert FOUND.residuals["equilibrium"] == FOUND.residuals.to_dict()["equilibrium"]
    assert list(FOUND.residuals.to_frame()["residual"]) == list(FOUND.residuals.to_dict())
    with pytest.raises(
        lb.ModelError, match="there is no residual 'equilbrium'; there are equilibrium, yield, "
    ):
        FOUND.residuals["equilbrium"]


def test_a_large_model_has_a_table_alone(monkeypatch):
    monkeypatch.setattr("limitblocks.notebook._MOST_BLOCKS", len(MODEL.blocks) - 1)
    for thing in (MODEL, FOUND):
        assert "<table" in thing._repr_html_()
        assert "<svg" not in thing._repr_html_()


def test_names_cannot_break_out_of_the_html():
    stones = [replace(MODEL.blocks[0], name="<b>"), MODEL.blocks[1]]
    old = MODEL.blocks[0].name
    joins = [
        replace(i, **{k: "<b>" for k in ("block_i", "block_j") if getattr(i, k) == old})
        for i in MODEL.interfaces
    ]
    supports = ["<b>" if name == old else name for name in MODEL.supports]
    evil = lb.Model(stones, supports, joins, MODEL.dead, MODEL.live, name="<script>")
    for text in (evil._repr_html_(), lb.bounds(evil)._repr_html_(), evil.view()._repr_html_()):
        assert "<script" not in text
        assert "<b>" not in text


@pytest.mark.parametrize("name", COLLAPSING)
def test_collapse_is_a_state_of_one_kind(name):
    collapse = COLLAPSING[name].collapse
    assert collapse.load_factor == pytest.approx(0.3, rel=1e-6)  # slides at the friction
    assert collapse.stress_resultants.shape == (len(MODEL.interfaces), 6)
    assert collapse.displacement_rates.shape == (len(MODEL.blocks), 6)
    assert collapse.collapse is collapse
    states = lb.interface_states(MODEL, collapse)
    assert states.state == lb.interface_states(MODEL, COLLAPSING[name]).state == ("slide",)


@pytest.mark.parametrize("name", ["model", *COLLAPSING])
def test_view_is_a_frame_that_needs_no_network(name):
    frame = SHOWN[name].view(height=400)._repr_html_()
    assert frame.startswith("<iframe ")
    assert "height: 400px" in frame
    page = html.unescape(re.search(r'srcdoc="([^"]*)"', frame)[1])
    assert page.startswith("<!doctype html>")
    assert "default-src 'none'" in page
    assert not re.search(r"(src|href)\s*=\s*[\"'](https?:)?//", page)
    assert ('value="mechanism"' in page) == (name != "model")


@pytest.mark.parametrize("kept", [0, 1])
def test_result_finds_its_model_when_an_equal_one_is_gone(kept):
    models = [lb.structures.block(lb.PointContact(0.41), width=0.5, height=1.0) for _ in range(2)]
    found = lb.bounds(models[0])
    assert models[0].digest == models[1].digest
    models[1 - kept] = None
    gc.collect()
    assert len(found.to_frame()) == 1


def test_result_without_its_model_asks_for_it():
    other = lb.structures.block(lb.PointContact(0.4), width=0.5, height=1.0)
    alone = replace(FOUND, digest="0" * 64)
    assert alone._repr_html_().count("<td>") > 0
    with pytest.raises(lb.ModelError, match="not in memory any more; give it"):
        alone.view()
    with pytest.raises(lb.ModelError, match="belongs to model"):
        FOUND.view(other)
    assert "<iframe" in FOUND.view(MODEL)._repr_html_()


@pytest.mark.parametrize("name", COLLAPSING)
def test_what_was_saved_is_read_reported_and_saved_again(name, tmp_path):
    file = COLLAPSING[name].save(tmp_path / "result.json")
    with pytest.raises(lb.LimitBlocksError, match="exists"):
        COLLAPSING[name].save(file)
    read = lb.read_result(file)
    again = lb.read_result(read.save(tmp_path / "again.json"), MODEL)
    assert type(again) is type(read) is type(COLLAPSING[name])
    assert result_text(again) == result_text(read) == result_text(COLLAPSING[name])
    report = lb.report(MODEL, read)
    assert "read from a file" in report.markdown
    assert [one["title"] for one in report.scene["results"]] == [COLLAPSING[name].title]
    assert [row["state"] for row in report.to_dict()["interfaces"][0]] == ["slide"]
    assert "0.3000" in str(lb.report(MODEL, read))
    assert "<iframe" in read.view()._repr_html_()
    assert "<svg" in read._repr_html_()


def test_frames():
    pandas = pytest.importorskip("pandas", reason="pandas is not installed")
    states = FOUND.to_frame()
    assert isinstance(states, pandas.DataFrame)
    assert list(states["state"]) == ["slide"]
    weight = MODEL.free_blocks[0].weight
    assert states["N"][0] == pytest.approx(-weight)
    assert np.hypot(states["V1"], states["V2"])[0] == pytest.approx(0.3 * weight)
    force = np.array([FOUND.to_frame()[f"force_{axis}"][0] for axis in "XYZ"])
    assert abs(force) == pytest.approx([0.3 * weight, 0, weight])
    assert list(PATH.to_frame()["load_factor"]) == [step.load_factor for step in PATH.steps]
    assert STATES.to_frame().equals(states)
    assert list(CHECK.to_frame()["value"]) == [entry.value for entry in CHECK.residuals.entries]


def test_frame_without_pandas_says_what_to_install(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "pandas", None)
    with pytest.raises(
        lb.errors.MissingDependency, match=r"to_frame\(\): the package pandas is missing; .*pip"
    ):
        FOUND.to_frame()


@pytest.mark.parametrize("draw", ["structure", "mechanism", "polar"])
def test_axes_show_their_figure(draw):
    pytest.importorskip("matplotlib", reason="matplotlib is not installed")
    if draw == "polar":
        ax = lb.plots.polar(lb.studies.directions(MODEL, 3, workers=1))
    else:
        ax = (
            lb.plots.structure(MODEL, plane="3d") if draw == "structure" else lb.plots.mechanism(MODEL, FOUND)
        )
    assert ax._repr_png_().startswith(b"\x89PNG")
    assert ax.name == {"structure": "3d", "mechanism": "rectilinear", "polar": "polar"}[draw]


CELLS = {
    "import limitblocks as lb": set(),
    "model = lb.structures.block(lb.PointContact(0.3), width=0.5, height=1.0); model": {"text/html"},
    "model.view()": {"text/html"},
    "bounds = lb.bounds(model); bounds": {"text/html"},
    "result = lb.nonassociated(model); result": {"text/html"},
    "result.view()": {"text/html"},
    "lb.plots.mechanism(model, result)": {"image/png"},
    "report = lb.report(model, bounds, result); report": set(),
    "print(report)": set(),
}


def test_a_kernel_runs_a_notebook():
    client = pytest.importorskip("nbclient", reason="nbclient is not installed")
    nbformat = pytest.importorskip("nbformat", reason="nbformat is not installed")
    pytest.importorskip("ipykernel", reason="ipykernel is not installed")
    v4 = nbformat.v4
    notebook = v4.new_notebook(cells=[v4.new_code_cell(source) for source in CELLS])
    client.NotebookClient(notebook, timeout=120, kernel_name="python3").execute()  # raises at a traceback
    for cell, expected in zip(notebook.cells, CELLS.values(), strict=True):
        kinds = {kind for output in cell.outputs for kind in output.get("data", {})}
        assert expected <= kinds, cell.source
        lines = [output.data["text/plain"] for output in cell.outputs if "data" in output]
        assert all("\n" not in line and len(line) < 600 for line in lines), cell.source
    assert notebook.cells[-1].outputs[0].text.count("\n") == 1


@pytest.mark.parametrize("lesson", sorted((ROOT / "examples").glob("[0-9]*.py")), ids=lambda file: file.stem)
def test_the_notebook_of_a_lesson_knows_every_name_it_uses(lesson, monkeypatch):
    pytest.importorskip("nbformat", reason="nbformat is not installed")
    monkeypatch.syspath_prepend(str(ROOT / "scripts"))
    cells = importlib.import_module("lessons").notebook(lesson).cells
    waiting = [symtable.symtable("\n".join(c.source for c in cells if c.cell_type == "code"), "", "exec")]
    known = {one.get_name() for one in waiting[0].get_symbols() if one.is_assigned() or one.is_imported()}
    known |= set(dir(builtins)) | {"__file__"}
    used = set()
    while waiting:
        table = waiting.pop()
        waiting += table.get_children()
        outermost = table.get_type() == "module"
        used |= {
            s.get_name() for s in table.get_symbols() if s.is_referenced() and (outermost or s.is_global())
        }
    assert used <= known
