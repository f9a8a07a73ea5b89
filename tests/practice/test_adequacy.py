"""Partial factors: closed forms of a sliding block, a tower, a crushing column, a tie; misuse; command."""

import json
from dataclasses import dataclass, replace

import facades
import numpy as np
import pytest
from stones import model_of
from typer.testing import CliRunner

import limitblocks as lb
from limitblocks.cli import app
from limitblocks.joints import Dowel, Tie
from limitblocks.practice import (
    PartialFactors,
    adequacy,
    capacity_curve,
    design_model,
    dowel,
    least_ties,
    passive_fill,
    reinforced,
    tie,
)

G, Q, M, PHI, S = 1.35, 1.5, 2.2, 1.25, 1.15


def block(width=1.0, height=0.4, friction=0.3, joint=lb.PointContact):
    return lb.structures.block(joint(friction), width=width, height=height)


@dataclass(frozen=True)
class Glued:
    friction: float
    cohesion: float
    scale: float = 2.0

    def yield_rows(self, polygons, stress_unit=1.0):
        return lb.OrdunaLourenco(self.friction, cohesion=self.cohesion).yield_rows(polygons, stress_unit)


@dataclass(frozen=True)
class Nameless:
    friction: float
    c: float

    def yield_rows(self, polygons, stress_unit=1.0):
        return lb.OrdunaLourenco(self.friction, cohesion=self.c).yield_rows(polygons, stress_unit)


def test_a_factor_that_raises_friction_is_asked_about():
    """A block slides at mu: .3 / .8 = .375 by a resistance factor of .8, which multiplies; 1 / .8 = 1.25."""
    found = adequacy(block(), PartialFactors(1.0, 1.0, 0.8))
    assert found.factor == pytest.approx(0.375, abs=1e-7)
    assert found.remarks == ("gamma_M is 0.8, and raises what it divides: 1.25?",)
    assert found.remarks[0] in lb.report(block(), found).text
    assert adequacy(block(), PartialFactors(0.9, 0.5, 0.8, gamma_phi=1.0)).remarks == ()  # no strength but mu


def test_a_factor_below_one_is_not_told_as_one():
    """A block slides at .3 of its weight; pushed by .3 / .99999995 of it it had "1, LESS than one"."""
    model = block()
    pushed = replace(model, live=0.3 / 0.99999995 * model.live)
    found = adequacy(pushed, PartialFactors(1.0, 1.0, 1.0))
    assert found.factor == pytest.approx(0.99999995, abs=1e-9)
    assert str(found).startswith("adequacy factor 0.999 (without dilatancy), LESS than one")


@pytest.mark.parametrize(("M", "phi"), [(1.0, 1.5), (1.2, 1.5), (1.5, 1.25), (2.0, None)])
def test_dividing_friction_adds_no_tensile_strength(M, phi):
    """alpha = (1 + A f_t / W) b / h; of .02 MPa count c / mu = .01 MPa, more where mu alone is less."""
    joint = lb.OrdunaLourenco(0.6, cohesion=6e3, tensile_strength=20e3)
    tall = block(height=4.0, joint=lambda _: joint)
    A = lb.joints.areas(tall.interfaces[0].polygon[None]).item()
    found = adequacy(tall, PartialFactors(1.0, 1.0, M, phi))
    assert found.factor == pytest.approx((1.0 + A * 10e3 / M / tall.free_blocks[0].weight) / 4.0, rel=1e-6)
    counted = next(value for value in found.values if value.symbol == "f_t")
    assert (counted.characteristic, counted.design) == pytest.approx((10e3, 10e3 / M))


def test_a_strength_of_ones_own_joint_is_divided_or_refused():
    """alpha = mu + c A / W; a bond under another name was left whole, and stayed after the joint had slid."""
    W = block().free_blocks[0].weight
    glue = 0.1 * W / lb.joints.areas(block().interfaces[0].polygon[None]).item()  # Pa
    found = adequacy(block(joint=lambda mu: Glued(mu, glue)), PartialFactors(1.0, 1.0, 2.0))
    assert found.factor == pytest.approx((0.3 + 0.1) / 2.0, rel=1e-6)
    nameless = block(joint=lambda mu: Nameless(mu, glue))
    assert lb.bounds(nameless).upper == pytest.approx(0.3 + 0.1, rel=1e-6)
    for ask in (lambda: adequacy(nameless, PartialFactors(1.0, 1.0, 2.0)), lambda: capacity_curve(nameless)):
        with pytest.raises(lb.ModelError, match="leave c as it is, a strength; name it cohesion"):
            ask()


@pytest.mark.parametrize("phi", [None, PHI])
def test_block_that_slides(phi):
    """gamma_Q alpha W = (mu / gamma) gamma_G W."""
    found = adequacy(block(), PartialFactors(G, Q, M, gamma_phi=phi))
    expected = 0.3 / (phi or M) * G / Q
    assert found.factor == pytest.approx(expected, rel=1e-8)
    assert found.bounds.upper == pytest.approx(expected, rel=1e-8)
    assert found.characteristic.lower == pytest.approx(0.3, rel=1e-6)
    assert not found.satisfied


def test_tower_that_overturns_needs_the_favourable_factor():
    """gamma_Q alpha W H / 2 = gamma_G W B / 2: the least gamma_G governs."""
    tower = block(width=1.0, height=4.0, friction=0.9)
    for gamma_G in (1.35, 0.9):
        found = adequacy(tower, PartialFactors(gamma_G, Q, 1.0), without_dilatancy=False)
        assert found.factor == pytest.approx(0.25 * gamma_G / Q, rel=1e-6)
        assert found.result is None


def test_column_that_crushes():
    """gamma_G W + gamma_Q alpha P = A f_cef / gamma_M, P through the centroid."""
    strength, load = 1e6, 50e3
    stones = [
        lb.Block.box("ground", (1, 1, 0.2), (0, 0, -0.1)),
        lb.Block.box("column", (0.5, 0.4, 2.0), (0, 0, 1.0), 20e3),
    ]
    joint = lb.OrdunaLourenco(0.6, compressive_strength=strength)
    live = lb.loads.force("column", (0, 0, -load), (0, 0, 2.0))
    model = lb.Model(stones, ["ground"], lb.find_interfaces(stones, joint), lb.self_weight(), live)
    found = adequacy(model, PartialFactors(G, Q, M), without_dilatancy=False)
    assert found.bounds.lower == pytest.approx((0.2 * strength / M - G * 8e3) / (Q * load), rel=1e-6)
    assert found.satisfied
    crushing = next(one for one in found.values if one.symbol == "f_cef")
    assert (crushing.characteristic, crushing.factor) == (strength, "gamma_M")
    assert crushing.design == pytest.approx(strength / M)


def test_cohesion_is_divided():
    """A block pushed along: gamma_Q alpha W = gamma_G mu W / gamma_phi + A c / gamma_M."""
    model = block(width=2.0, height=0.4)
    weight = model.free_blocks[0].weight
    (own,) = model.interfaces
    joint = lb.OrdunaLourenco(0.3, cohesion=500.0, tensile_strength=100.0)
    model = replace(model, interfaces=[replace(own, joint=joint)])
    found = adequacy(model, PartialFactors(G, Q, M, PHI), without_dilatancy=False)
    area = abs(float(lb.joints.areas(own.polygon)))
    assert found.factor == pytest.approx((G * 0.3 / PHI + area * 500.0 / M / weight) / Q, rel=1e-6)
    (made,) = {one.joint for one in found.model.interfaces}
    assert made.tensile_strength == pytest.approx(100.0 / M)


def wall(prestress=0.0):
    model = model_of(facades.wall_stones(), ["ground"], lb.PointContact(0.8))
    rod = tie("wall", (-0.25, 0, 4.5), "ground", (-6, 0, 4.5), area=1e-4, strength=8e7, prestress=prestress)
    return reinforced(model, rod)


@pytest.mark.parametrize("prestress", [0.0, 1.5e3])
def test_tie_is_divided_and_its_prestress_stays_within(prestress):
    """gamma_Q alpha W H / 2 = gamma_G W t / 2 + F z / gamma_S, whatever part of F is a prestress."""
    found = adequacy(wall(prestress), PartialFactors(G, Q, M, 1.0, S))
    expected = (G * 45e3 * 0.25 + 8e3 * 4.5 / S) / (Q * 45e3 * 2.5)
    assert found.factor == pytest.approx(expected, rel=1e-6)
    assert found.model.interfaces[1].joint == Tie(8e7 / S, 5.75, G * (prestress / 1e-4))
    assert [one.symbol for one in found.values] == ["G", "Q", "mu", "F"]
    (rod,) = (one for one in found.values if one.unit == "N")
    assert (rod.characteristic, rod.design) == pytest.approx((8e3, 8e3 / S))


def test_dowel_is_divided():
    model = block()
    (own,), weight = model.interfaces, model.free_blocks[0].weight
    held = reinforced(model, dowel(own, own.centroid, diameter=0.02, capacity=0.05 * weight))
    found = adequacy(held, PartialFactors(1.0, 1.0, M, 1.0, S))
    assert found.factor == pytest.approx(0.3 + 0.05 / S, rel=1e-6)
    assert isinstance(found.model.interfaces[1].joint, Dowel)


def test_passive_fill_is_divided_as_a_tie():
    """gamma_Q alpha W = gamma_G mu W / gamma_phi + K_p gamma h^2 / 2 / gamma_S."""
    stones = [
        lb.Block.box("ground", (8, 1, 1), (0, 0, -0.5)),
        lb.Block.prism("wedge", [(0, 0), (2, 0), (1, 1), (0, 1)], (-0.5, 0.5), 20e3),
    ]
    found = lb.find_interfaces(stones, lb.PointContact(0.4))
    model = lb.Model(stones, ["ground"], found, lb.self_weight(), lb.mass_proportional((1, 0, 0)))
    held = reinforced(model, *passive_fill(model, 1.0, unit_weight=18e3, coefficient=3.0))
    with pytest.raises(lb.ModelError, match="passive fill: give gamma_S"):
        adequacy(held, PartialFactors(G, Q, M))
    found = adequacy(held, PartialFactors(G, Q, M, PHI, S))
    weight, fill = model.free_blocks[0].weight, 3.0 * 18e3 / 2
    assert found.factor == pytest.approx((G * 0.4 * weight / PHI + fill / S) / (Q * weight), rel=1e-6)


def test_what_reinforces_a_design_model_has_gamma_s(tmp_path):
    """gamma_Q alpha W H / 2 = gamma_G W t / 2 + F z: the tie is made for gamma_S F, in the model as given."""
    factors, required, weight = PartialFactors(0.9, Q, M, 1.0, S), 0.1, 45e3
    rod = tie("wall", (-0.25, 0, 4.5), "ground", (-6, 0, 4.5), area=1e-3, strength=1e8)
    bare = replace(wall(), interfaces=wall().interfaces[:1])
    design = design_model(bare, factors)
    force = (Q * required * weight * 2.5 - 0.9 * weight * 0.25) / 4.5
    assert least_ties(design, [rod], required).total == pytest.approx(force, rel=1e-6)
    made = tie("wall", (-0.25, 0, 4.5), "ground", (-6, 0, 4.5), area=1e-3, strength=S * force / 1e-3)
    assert adequacy(reinforced(bare, made), factors).factor == pytest.approx(required, rel=1e-6)
    with pytest.raises(lb.ModelError, match="reinforce the model with characteristic values, then"):
        reinforced(design, rod)
    point = [
        "--point",
        "0",
        "0",
        "0",
        "--diameter",
        "0.02",
        "--capacity",
        "8e3",
        "-o",
        str(tmp_path / "d.json"),
    ]
    done = CliRunner().invoke(app, ["dowel", str(design.save(tmp_path / "design.json")), *point])
    assert done.exit_code == 2
    assert "design values" in done.output


def test_factors_of_one_change_nothing():
    model = wall(1e3)
    assert design_model(model, PartialFactors(1, 1, 1, 1, 1)).digest == model.digest


def test_report_has_design_beside_characteristic_values():
    made = lb.report(block(), adequacy(block(), PartialFactors(G, Q, M, PHI)))
    (chapter,) = (one for one in made.document.chapters if one.title == "Adequacy with partial factors")
    (table,) = (part for part in chapter.parts if getattr(part, "caption", "").startswith("Characteristic"))
    rows = {row[0].text: [cell.text for cell in row] for row in table.rows}
    assert rows["mu"] == ["mu", "1 of 1 interface", "0.3", "gamma_phi", "1.25", "0.24"]
    assert rows["G"][3:] == ["gamma_G", "1.35", "1.35"]
    assert "LESS than one" in made.markdown
    assert "not judged here" in made.text


def test_the_characteristic_load_factor_is_of_the_same_flow_rule(monkeypatch):
    """With factors of one it is the adequacy factor itself; .4037 is that of joints that dilate."""
    model = lb.structures.ferris_tin_loi_wall(3, lb.OrdunaLourenco(0.65))
    found = adequacy(model, PartialFactors(1.0, 1.0, 1.0))
    assert found.characteristic_factor == found.factor == lb.nonassociated(model).load_factor
    assert found.characteristic_factor < 0.9 * found.characteristic.lower
    assert f"characteristic load factor {found.factor:.6g}, without dilatancy" in str(found)
    assert "Characteristic, without dilatancy" in lb.report(model, found).text
    doubled = adequacy(model, PartialFactors(1.0, 2.0, 1.0))
    assert doubled.characteristic_factor == found.factor
    assert doubled.factor == pytest.approx(found.factor / 2.0, rel=1e-3)

    def lost(own):
        if own is model:
            raise lb.errors.SolverFailure("no answer")
        return lb.nonassociated(own)

    monkeypatch.setitem(adequacy.__globals__, "nonassociated", lost)
    assert "characteristic load factor 0.403694, associated" in str(adequacy(model, doubled.factors))


def pressed_down():
    """A squat block whose live load presses it down: with mu = .6 and dilatancy no load moves it."""
    stones = [
        lb.Block.box("ground", (30.0, 1.0, 0.4), (0, 0, -0.2)),
        lb.Block.box("wall", (2.0, 1.0, 0.2), (0, 0, 0.1), 20e3),
    ]
    live = lb.mass_proportional((0.55, 0.0, -1.0))
    joints = lb.find_interfaces(stones, lb.PointContact(0.6))
    return lb.Model(stones, ["ground"], joints, lb.self_weight(), live)


def test_a_load_without_limit_has_one_with_design_friction():
    """gamma_Q alpha .55 W = (mu / gamma_M) (W + gamma_Q alpha W), of a direction of length one."""
    found = adequacy(pressed_down(), PartialFactors(1.0, Q, 2.0))
    assert found.factor == pytest.approx(np.hypot(0.55, 1.0) * 0.3 / (Q * (0.55 - 0.3)), rel=1e-8)
    assert found.characteristic is None
    assert found.characteristic_factor == np.inf
    assert "characteristic load factor without limit, associated" in str(found)
    text = lb.report(pressed_down(), found).text
    assert "without limit" in text
    assert "LESS than one" in text
    assert json.loads(json.dumps(found.to_dict()))["characteristic"] is None


def test_dilatancy_without_limit_does_not_hide_the_answer_without_it():
    """A stone between walls 25 degrees off the push, mu = .7 > tan 25: no dilatancy, no wedging."""
    walls = lb.structures.wedge(lb.OrdunaLourenco(0.7), half_angle=np.radians(25.0))
    model = replace(walls, live=lb.mass_proportional((0, 0, 1)))
    found = adequacy(model, PartialFactors(1.0, Q, 1.2))
    assert found.factor == pytest.approx(1.0 / Q, rel=1e-8)
    assert found.bounds is None
    assert found.characteristic_factor == pytest.approx(1.0, rel=1e-8)
    assert "associated, of the design model" in lb.report(model, found).text
    with pytest.raises(lb.errors.UnlimitedLoad):
        adequacy(model, PartialFactors(1.0, Q, 1.2), without_dilatancy=False)


def test_command(tmp_path):
    pypdf = pytest.importorskip("pypdf", reason="the package pypdf is not installed")
    file = block().save(tmp_path / "block.json")
    words = ["adequacy", str(file), "--gamma-g", "1", "--gamma-q", "1.5", "--gamma-m", "1.25"]
    done = CliRunner().invoke(app, [*words, "--json", "--report", str(tmp_path / "a.pdf")])
    assert done.exit_code == 1, done.output
    assert json.loads(done.stdout)["adequacy_factor"] == pytest.approx(0.3 / 1.25 / 1.5, rel=1e-8)
    said = " ".join(page.extract_text() for page in pypdf.PdfReader(tmp_path / "a.pdf").pages)
    for word in ("gamma_phi", "Characteristic", "adequacy factor, LESS than one"):
        assert word in said, word
    file = block(friction=3.0, width=4.0, height=1.0).save(tmp_path / "wide.json")
    done = CliRunner().invoke(app, ["adequacy", str(file), *words[2:], "--associated"])
    assert done.exit_code == 0, done.output
    assert "--gamma-m" in CliRunner().invoke(app, words[:-2]).output


def test_what_stands_with_characteristic_values_alone_is_said_to():
    """A block on a slope of 1 in 5 stands at friction 0.3 and slides at 0.3 / 2."""
    pair = [lb.Block.prism("slope", [(0, 0), (5, 0), (5, 1)], (0, 1))]
    pair.append(
        lb.Block.prism("stone", [(2, 0.4), (3, 0.6), (2.8, 1.6), (1.8, 1.4)], (0, 1), unit_weight=20e3)
    )
    model = model_of(pair, ["slope"], lb.PointContact(0.3))
    assert lb.stability(model).stands
    with pytest.raises(
        lb.errors.NoEquilibrium, match="with design values the dead loads alone cannot stand: stone"
    ):
        adequacy(model, PartialFactors(1.0, 1.0, 2.0))
