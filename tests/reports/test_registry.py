"""The registry of results: a new analysis is a module and one entry; each kind is saved and read."""

import json
import re
from dataclasses import dataclass, replace
from importlib import import_module
from xml.etree import ElementTree as ET

import facades
import jsonschema
import numpy as np
import pytest
from chapters import chapter, rows
from renderings import RENDERINGS
from typer.testing import CliRunner

import limitblocks as lb
from limitblocks.arrays import Array
from limitblocks.cli import app
from limitblocks.io.result_file import result_text
from limitblocks.kinds import KINDS, Kind, kind_of
from limitblocks.practice import (
    Deck,
    PartialFactors,
    Spectrum,
    Vehicle,
    adequacy,
    capacity_curve,
    settlement,
    verification,
    worst_position,
)
from limitblocks.shown import Result, kept

MODEL = facades.beam()


@dataclass(frozen=True, eq=False, repr=False)
class Heaviest(Result):
    """A toy analysis: the heaviest blocks."""

    names: tuple[str, ...]
    weights: Array
    total: float
    digest: str

    @property
    def displacement_rates(self):
        return np.tile([0.0, 0.0, -1.0, 0.0, 0.0, 0.0], (len(MODEL.blocks), 1))

    def rows(self):
        return [
            {"block": name, "weight": w} for name, w in zip(self.names, self.weights.tolist(), strict=True)
        ]

    def to_dict(self):
        return {"analysis": "heaviest blocks"} | kept(self, "names", "weights", "total", "digest")

    def __str__(self):
        return self._line(f"{self.total:.6g} N on {len(self.names)} blocks")


def heaviest(model):
    weights = np.array([block.weight for block in model.free_blocks])
    return Heaviest(tuple(b.name for b in model.free_blocks), weights, float(weights.sum()), model.digest)


@pytest.fixture
def toy(monkeypatch):
    """The one place that knows of the analysis."""
    monkeypatch.setitem(KINDS, "heaviest blocks", Kind(home=f"{__name__}:Heaviest"))
    return heaviest(MODEL)


def test_a_new_analysis_needs_its_class_and_one_entry(toy, tmp_path):
    """4 m x .5 m x 1 m at 20 kN/m3: 40 kN, in all five renderings, saved, read back and in a notebook."""
    for rendering in RENDERINGS.values():
        said = rendering(lb.report(MODEL, toy))
        assert "Heaviest blocks" in said
        assert "40000" in said
    file = toy.save(tmp_path / "toy.json")
    read = lb.read_result(file)
    assert (type(read), read.from_file, read.names) == (Heaviest, True, toy.names)
    assert result_text(read) == result_text(toy)
    for rendering in RENDERINGS.values():
        said = rendering(lb.report(MODEL, read))
        assert "read from a file" in re.sub(r"\s+", " ", said)
    html = toy._repr_html_()
    ET.fromstring(html)
    assert "40000" in html
    assert "<title>beam</title>" in html  # its displacement rates as a picture
    assert toy.to_frame()["weight"].tolist() == [40e3]
    assert repr(toy) == "<40000 N on 1 blocks>"
    report = json.loads(lb.report(MODEL, toy).json)
    jsonschema.validate(report, lb.files.report_schema())
    (row,) = (
        part["table"]["rows"]
        for chapter in report["chapters"]
        for part in chapter["parts"]
        if part.get("table", {}).get("caption") == "Rows"
    )
    assert row == [["beam", "40000"]]


def test_a_new_analysis_is_reported_by_the_command_line(toy, tmp_path):
    model, result = MODEL.save(tmp_path / "model.json"), toy.save(tmp_path / "toy.json")
    done = CliRunner().invoke(app, ["report", str(model), str(result), "-o", str(tmp_path / "a.md")])
    assert done.exit_code == 0, done.output
    assert "## Heaviest blocks, as a file says" in (tmp_path / "a.md").read_text(encoding="utf-8")


def test_an_unknown_kind_and_a_part_of_a_known_one_are_refused(toy, tmp_path):
    file = toy.save(tmp_path / "toy.json")
    said = json.loads(file.read_text(encoding="utf-8"))
    del said["total"]
    file.write_text(json.dumps(said), encoding="utf-8")
    with pytest.raises(lb.ModelError, match="holds a heaviest blocks that is not all there"):
        lb.read_result(file)
    with pytest.raises(
        lb.LimitBlocksError, match=r"a report cannot show dict; expected a result: .*Heaviest"
    ):
        lb.report(MODEL, {})
    with pytest.raises(lb.LimitBlocksError, match="this Heaviest belongs to model"):
        lb.report(MODEL, replace(toy, digest="0" * 64))


def test_every_entry_names_what_is_there():
    for word, kind in KINDS.items():
        for home in (kind.home, kind.section, kind.read, kind.judge, kind.document):
            module, _, name = home.partition(":")
            assert not home or hasattr(import_module(module), name), f"{word}: {home}"
    assert kind_of(3) is None


@pytest.fixture(scope="module")
def practised():
    facade = facades.facade()
    site = Spectrum(a_g=0.25 * 9.81, S=1.2, F0=2.5, T_C=0.5)
    solved = lb.nonassociated(facade)
    curve = capacity_curve(facade, control=("wall", (0.25, 0.5, 5.0)), steps=3)
    verified = verification(facade, solved, site, q=2.0, curve=curve)
    return {
        "capacity curve": (facade, curve),
        "verification": (facade, verified),
        "adequacy": (facade, adequacy(facade, PartialFactors(1.0, 1.5, 2.0))),
        "sensitivities": (MODEL, lb.sensitivities(MODEL, lb.bounds(MODEL))),
        "settlement": (MODEL, settlement(MODEL, "right", (0, 0, -1))),
        "worst position": (
            MODEL,
            worst_position(MODEL, Vehicle((10e3,)), Deck(0.5), (3.2, 3.8), positions=3),
        ),
    }


@pytest.mark.parametrize(
    "word", ["capacity curve", "verification", "adequacy", "sensitivities", "settlement", "worst position"]
)
def test_answers_of_practice_are_saved_read_and_shown(word, practised, tmp_path):
    model, saved = practised[word]
    assert KINDS[word].name == type(saved).__name__
    read = lb.read_result(saved.save(tmp_path / "result.json"), model)
    assert type(read) is type(saved)
    assert result_text(read) == result_text(saved)
    assert str(read) == f"{saved}; as a file says, not checked"
    made = lb.report(model, read)
    assert made.sections[0].headline == "not checked"
    jsonschema.validate(json.loads(made.json), lb.files.report_schema())
    ET.fromstring(saved._repr_html_())
    assert len(saved.to_frame()) == len(saved.rows()) > 0
    other = lb.structures.block(lb.PointContact(0.4), width=0.5, height=1.0)
    with pytest.raises(lb.ModelError, match="belongs to model"):
        lb.read_result(tmp_path / "result.json", other)


def test_a_report_keeps_what_a_verification_of_a_file_asks(tmp_path):
    """2 m/s2 given as 2 g: 2 / 9.81 = .204."""
    facade = facades.facade()
    solved = lb.nonassociated(facade)
    found = verification(facade, solved, Spectrum(2.0 * 9.81, 1.2, 2.5, 0.5), q=2.0)
    read = lb.read_result(found.save(tmp_path / "result.json"), facade)
    for one in (found, read):
        assert "a_g is 19.6 m/s2, 2 g: m/s2? 2 m/s2 = 0.204 g" in lb.report(facade, solved, one).text
    said = "Safety: chapter Kinematic verification of the mechanism, as a file says: not checked, least ratio"
    assert said in " ".join(lb.report(facade, solved, read).text.split())


def test_points_of_a_curve_that_was_read_can_be_checked(practised, tmp_path):
    """Each has its displaced structure with it."""
    _, curve = practised["capacity curve"]
    for point in lb.read_result(curve.save(tmp_path / "curve.json")).points:
        assert lb.check_mcp(point.model, point.result).passed


def test_a_sensitivity_is_its_chapter(practised):
    """The beam rests on two supports: the load factor of a sideways push is the friction, alpha = mu."""
    model, found = practised["sensitivities"]
    made = lb.report(model, found)
    (chapter,) = (one for one in made.document.chapters if one.title == "Sensitivity")
    values = {row[0].text: row[1].text for row in chapter.parts[1].rows}
    assert float(values["Friction, all together"]) == pytest.approx(0.6, abs=1e-4)
    assert values["Unit weights, all together"] == "0"  # weight and push grow alike, but for rounding


def test_a_sensitivity_names_the_points_of_loads_and_says_where_no_datum_governs():
    """Tipped by its weight: alpha = b / h, whatever the data; by F at z: W b / (2 F z), by z -alpha / z."""
    model = lb.structures.block(lb.PointContact(2.0), width=0.5, height=2.0)
    (stone,) = model.free_blocks
    pushed = replace(model, live=lb.loads.force(stone.name, (1e3, 0, 0), at=(0, 0, 2.0)))
    found = [lb.sensitivities(one, lb.bounds(one)) for one in (model, pushed)]
    assert "0.25: no friction or unit weight changes it" in str(found[0])
    headline, *parts = chapter(lb.report(model, found[0]), "Sensitivity").parts
    assert headline.number == "none"
    assert [part.caption for part in parts if hasattr(part, "caption")] == ["Result"]
    alpha = stone.weight * 0.5 / (2 * 1e3 * 2.0)
    report = lb.report(pushed, found[1])
    assert [one.name for one in found[1].governing()] == [stone.name]
    assert float(rows(report, "Sensitivity", "Data that govern")["unit weight"][2]) == pytest.approx(alpha)
    (place,) = rows(report, "Sensitivity", "Points of loads").values()
    assert place == ["live, term 1", stone.name, f"(0, 0, {-alpha / 2.0:g})"]
