"""The documentation builds without a warning and without network, and says what the package says."""

import inspect
import re
import shlex
import shutil
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path

import pytest
import typer.main
from sybil import Sybil
from sybil.parsers.markdown import CodeBlockParser, PythonCodeBlockParser
from typer.testing import CliRunner

import limitblocks as lb
from limitblocks import cli
from limitblocks.io import read_materials

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"
LOADS = {"src", "srcset", "poster", "data", "background"}


def build(source, target):
    command = [sys.executable, "-m", "sphinx", "-b", "html", "-W", "--keep-going", "-q", source, target]
    return subprocess.run(command, capture_output=True, text=True, check=False)


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    pytest.importorskip("sphinx")
    folder = tmp_path_factory.mktemp("docs")
    source = shutil.copytree(DOCS, folder / "source", ignore=shutil.ignore_patterns("__pycache__"))
    (source / "added-later.md").write_text("# A page that nobody lists\n", encoding="utf-8")
    (source / "lessons").mkdir()
    lessons = "# Lessons\n\n```{toctree}\n:hidden:\n\none\n```\n"
    (source / "lessons" / "index.md").write_text(lessons, encoding="utf-8")
    (source / "lessons" / "one.md").write_text("# Lesson\n", encoding="utf-8")
    done = build(source, folder / "site")
    assert (done.returncode, done.stderr) == (0, "")
    return folder / "site"


class Addresses(HTMLParser):
    """What a browser would load to show a page."""

    def __init__(self, text):
        super().__init__()
        self.found = []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.found += [value for name, value in attrs if name in LOADS and value]
        if tag == "link":
            self.found += [value for name, value in attrs if name == "href" and value]


def remote(text):
    written = re.findall(r"(?:url\(|@import|import\(|from)\s*[\"']?([^\"')\s]*//[^\"')\s]*)", text)
    loaded = Addresses(text).found if "<html" in text else []
    return [address for address in [*loaded, *written] if re.match(r"(https?:)?//", address)]


def test_no_page_loads_a_remote_address(site):
    files = [file for file in site.rglob("*") if file.suffix in {".html", ".css", ".js"}]
    assert len(files) > 20
    assert {file.name: result for file in files if (result := remote(file.read_text(encoding="utf-8")))} == {}


@pytest.mark.parametrize(
    "text",
    [
        '<html><script src="https://cdn.example/mathjax.js"></script></html>',
        '<html><link rel="stylesheet" href="//fonts.example/css"></html>',
        "@font-face { src: url('https://fonts.example/a.woff2') }",
    ],
)
def test_a_remote_address_is_seen(text):
    assert remote(text)
    assert not remote('<html><a href="https://example.org">a link loads nothing</a></html>')


def test_every_page_is_listed(site):
    index = (site / "index.html").read_text(encoding="utf-8")
    pages = [file.relative_to(DOCS).with_suffix(".html").as_posix() for file in DOCS.rglob("*.md")]
    assert [page for page in pages if page != "index.html" and f'href="{page}"' not in index] == []
    assert 'href="added-later.html"' in index
    assert 'href="lessons/index.html"' in index


def test_every_public_name_is_documented(site):
    text = (site / "api.html").read_text(encoding="utf-8")
    modules = [lb, *(part for part in [getattr(lb, name) for name in lb.__all__] if inspect.ismodule(part))]
    things = [
        (module, name, getattr(module, name)) for module in modules for name in getattr(module, "__all__", ())
    ]
    names = [
        f"{module.__name__}.{name}"
        for module, name, thing in things
        if not inspect.ismodule(thing) and (module is lb or getattr(lb, name, None) is not thing)
    ]
    assert len(names) > 50
    assert [name for name in names if f'id="{name}"' not in text] == []
    assert [
        module.__name__ for module in modules if f'id="{module.__name__.replace(".", "-")}"' not in text
    ] == []


def commands(command, path):
    yield path, command
    for name, part in getattr(command, "commands", {}).items():
        yield from commands(part, f"{path} {name}")


def test_every_command_is_documented_with_its_options(site):
    text = (site / "command-line.html").read_text(encoding="utf-8")
    for path, command in commands(typer.main.get_command(cli.app), "limitblocks"):
        assert f">{path}<" in text, path
        assert all(
            option in text for parameter in command.params for option in parameter.opts if "-" in option
        )


def test_maths_is_in_the_page_and_needs_no_script(site):
    text = (site / "theory.html").read_text(encoding="utf-8")
    assert text.count("<math") > 20
    assert "$" not in re.sub(r"<[^>]*>|<script.*?</script>", "", text[text.index("<article") :])


def test_the_theory_cites_every_equation_of_the_paper():
    text = (DOCS / "theory.md").read_text(encoding="utf-8")
    cited = re.findall(r"\((\d+)\)(?:-\((\d+)\))?|Eqs? (\d+)-(\d+)", text)
    numbers = [(int(a or c), int(b or d or a)) for a, b, c, d in cited]
    assert {n for first, last in numbers for n in range(first, last + 1)} >= set(range(1, 60))


def test_a_fault_breaks_the_build(tmp_path):
    pytest.importorskip("sphinx")
    source = tmp_path / "source"
    source.mkdir()
    for name in ("conf.py", "generated.py"):
        shutil.copy(DOCS / name, source)
    page = "# Page\n\n[missing](missing.md), [no heading](index.md#heading) and $\\nonsense{$\n"
    (source / "index.md").write_text(page, encoding="utf-8")
    done = build(source, tmp_path / "site")
    assert done.returncode != 0
    assert "missing.md" in done.stderr
    assert "id not found in doc 'index': 'heading'" in done.stderr
    assert "maths" in done.stderr


def test_getting_started_runs_in_an_empty_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    ran = []

    def evaluate(example):
        for line in example.parsed.splitlines():
            done = CliRunner().invoke(cli.app, line.split()[1:])
            assert done.exit_code == 0, (line, done.output)
            ran.append(line.split()[1])

    page = Sybil([CodeBlockParser("sh", evaluate), PythonCodeBlockParser()]).parse(
        DOCS / "getting-started.md"
    )
    for example in page.examples():
        example.evaluate()
    assert ran[:6] == ["new", "info", "bounds", "nonassociated", "check", "report"]
    for name in ("wall.html", "own.html"):
        assert (tmp_path / name).stat().st_size > 10_000


def test_from_a_drawing_to_a_report(tmp_path, monkeypatch):
    """Five commands in an empty folder; the printed output of `look` is what it prints."""
    monkeypatch.chdir(tmp_path)
    said, tables = {}, []

    def table(example):
        tables.append(example.parsed)
        (tmp_path / "stones.toml").write_text(tables[0], encoding="utf-8")

    def printed(example):
        shown = [line.rstrip() for line in said["look"].splitlines() if line.strip()]
        assert shown == [line for line in example.parsed.splitlines() if line.strip()]

    def command(example):
        for line in example.parsed.splitlines():
            done = CliRunner().invoke(cli.app, shlex.split(line)[1:], env={"COLUMNS": "120"})
            assert done.exit_code == 0, (line, done.output)
            said[line.split()[1]] = done.output

    evaluators = {"sh": command, "toml": table, "text": printed}
    parsers = [CodeBlockParser(word, evaluate) for word, evaluate in evaluators.items()]
    page = Sybil([*parsers, PythonCodeBlockParser()]).parse(DOCS / "from-a-drawing.md")
    for example in page.examples():
        example.evaluate()
    (tmp_path / "all.toml").write_text("\n".join(tables), encoding="utf-8")
    assert len(read_materials(tmp_path / "all.toml").pairs) == 1
    assert list(said) == ["look", "import", "info", "bounds", "report"]
    assert "granite|limestone: the weaker of both, friction 0.6 (limestone)" in said["import"]
    assert (tmp_path / "portal.html").stat().st_size > 10_000
