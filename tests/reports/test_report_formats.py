import builtins
import json
import re
import time
from dataclasses import replace
from datetime import datetime, timedelta, timezone

import jsonschema
import pytest

import limitblocks as lb
from limitblocks.cli import app
from limitblocks.reports import pdf
from limitblocks.reports.document import Chapter, Heading, Headline, Items, Table, Text
from limitblocks.reports.markdown import escaped, written
from limitblocks.reports.words import at_least

JOINT = lb.OrdunaLourenco(0.6)


@pytest.fixture(scope="module")
def model():
    return lb.structures.arch(JOINT, radius=2.0, thickness=0.4, voussoirs=9)


@pytest.fixture(scope="module")
def report(model):
    path = lb.load_path(model)
    check = lb.check_mcp(model, path.collapse)
    return lb.report(model, lb.bounds(model), path.collapse, path, check, lb.stability(model))


def test_schema_describes_the_json_of_every_result(report):
    schema = lb.files.report_schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    content = json.loads(report.json, parse_constant=pytest.fail)
    jsonschema.validate(content, schema)
    assert content["schema_version"] == 2
    kinds = ["bounds", "nonassociated", "path", "check", "stability"]
    assert [one["analysis"] for one in content["results"]] == kinds
    assert [len(one) for one in content["interfaces"]] == [10, 10, 10, 0, 0]
    for broken in ({"schema_version": 1}, {"results": [{}]}, {"extra": 1}, {"format": "another"}):
        with pytest.raises(jsonschema.ValidationError):
            jsonschema.validate(content | broken, schema)


def test_markdown_says_what_the_page_says(report, model):
    text = report.markdown
    for part in (
        f"# {model.name}",
        "## Side by side",
        "## Associated bounds",
        "## Load path",
        at_least(report.results[0].lower),
        f"{report.results[0].gap:.1e}",
        "Interfaces that do not stick: 4 of 10",
        model.digest,
        lb.__version__,
        "(31.0 degrees)",
    ):
        assert part in text, part
    for table in re.findall(r"(?:^\|.*\n)+", text, re.MULTILINE):
        widths = {len(re.findall(r"(?<!\\)\|", line)) for line in table.splitlines()}
        assert len(widths) == 1, table


@pytest.mark.parametrize(
    "text", ["a|b", "# a", "- a", "1. a", "<img src=x>", "`a`", "[a](b)", "*a*", "a\n# b", "a\\"]
)
def test_names_are_no_markup_in_markdown(text):
    line = escaped(text)
    assert "\n" not in line
    assert not re.search(r"(?<!\\)(?:\\\\)*[|#<>`*\[\]]", line)
    assert not re.match(r"[-+]|\d+\.", line)
    assert " ".join(text.split()) == re.sub(r"\\(.)", r"\1", line)


def test_parts_have_their_markdown():
    table = Table.of("Caption", ("Name", "Value"), (("a", "1"),), right=(1,))
    parts = [Heading("A"), Headline("0.5", "load factor"), Items(("x", "y")), Text("text"), table]
    assert list(map(written, parts)) == [
        "### A",
        "**0.5** load factor",
        "- x\n- y",
        "text",
        "Caption:\n\n| Name | Value |\n| --- | ---: |\n| a | 1 |",
    ]
    assert written(Text("text", warning=True)) == "**Warning:** text"


def test_pdf_holds_title_and_pages(report, tmp_path):
    data = report.pdf(tmp_path / "arch.pdf").read_bytes()
    assert data.startswith(b"%PDF-")
    assert b"/Title (arch of 9 voussoirs)" in data
    pages = re.search(rb"/Count (\d+)", data)
    assert 2 <= int(pages[1]) <= 8
    assert report.pdf(tmp_path / "arch.pdf").exists()  # its own file may be replaced
    (tmp_path / "other.pdf").write_bytes(b"%PDF-1.4 somebody else's")
    with pytest.raises(lb.LimitBlocksError, match="not written by limitblocks"):
        report.save(tmp_path / "other.pdf")


def test_every_text_can_be_printed(report):
    assert pdf.marked("a<b> & α ≤ 2 – Orduña") == "a&lt;b&gt; &amp; <greek>a</greek> &lt;= 2 – Orduña"
    assert pdf.marked("石") == r"\u77f3"  # the standard fonts lack it: its code, not a box
    name = "<b>&\x00石" + "x" * 300
    table = Table.of("<i>", ("Interface", "State"), ((name, name),))
    parts = (Heading(name), Headline(name, name), Items((name,)), table, Text(name))
    document = replace(report.document, title=name, chapters=(Chapter(name, parts),))
    assert pdf.pdf(document).startswith(b"%PDF-")


def test_pdf_names_the_package_it_needs(report, tmp_path, monkeypatch):
    real = builtins.__import__

    def without(name, *rest):
        if name.startswith("reportlab"):
            raise ImportError(name)
        return real(name, *rest)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(lb.errors.MissingDependency, match=r"reportlab.*pip install 'reportlab>=4"):
        report.save(tmp_path / "arch.pdf")
    assert not (tmp_path / "arch.pdf").exists()


@pytest.mark.parametrize("suffix", [".html", ".json", ".md", ".pdf", ".HTML"])
def test_suffix_chooses_the_format(report, tmp_path, suffix):
    file = report.save(tmp_path / f"arch{suffix}")
    start = {".html": b"<!doctype", ".json": b"{", ".md": b"<!-- limitblocks", ".pdf": b"%PDF-"}
    assert file.read_bytes().startswith(start[suffix.lower()])
    assert report.save(file) == file
    with pytest.raises(lb.LimitBlocksError, match="exists"):
        report.save(file, overwrite=False)


@pytest.mark.parametrize("suffix", [".html", ".json", ".md", ".pdf"])
def test_a_report_saved_later_is_the_same_file(suffix, tmp_path, monkeypatch):
    monkeypatch.delenv("SOURCE_DATE_EPOCH", raising=False)
    model = lb.structures.column(lb.PointContact(0.7), count=1, width=0.5, height=1.0)
    evening = datetime(2026, 12, 31, 23, 30, 5, tzinfo=timezone(timedelta(hours=-1)))
    report = replace(lb.report(model, lb.bounds(model)), date=evening)
    now = report.save(tmp_path / f"now{suffix}").read_bytes()
    with monkeypatch.context() as patch:
        patch.setattr(time, "time", lambda: 2e9)
        assert report.save(tmp_path / f"later{suffix}").read_bytes() == now
    if suffix == ".pdf":  # ISO 32000-1, 7.9.4: the date in universal time
        assert re.findall(rb"Date \((.*?)\)", now) == [b"D:20270101003005Z"] * 2


@pytest.mark.parametrize("name", ["arch.docx", "arch"])
def test_unknown_suffix_is_refused(report, tmp_path, name):
    with pytest.raises(lb.LimitBlocksError, match=r"\.html, \.json, \.md, \.pdf"):
        report.save(tmp_path / name)


def test_command_line_writes_the_format_asked_for(model, tmp_path):
    from typer.testing import CliRunner

    file = model.save(tmp_path / "arch.json")
    done = CliRunner().invoke(app, ["report", str(file), "-o", str(tmp_path / "arch.md")])
    assert done.exit_code == 0, done.output
    assert (tmp_path / "arch.md").read_text(encoding="utf-8").startswith("<!-- limitblocks report -->")
    refused = CliRunner().invoke(app, ["report", str(file), "-o", str(tmp_path / "arch.docx")])
    assert refused.exit_code == 2
    assert not (tmp_path / "arch.docx").exists()
