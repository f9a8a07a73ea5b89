"""The command verify."""

import json

import pytest
from typer.testing import CliRunner

import limitblocks as lb
from limitblocks.cli import app


def run(*words):
    return CliRunner().invoke(app, [str(word) for word in words])


@pytest.fixture(scope="module")
def block(tmp_path_factory):
    folder = tmp_path_factory.mktemp("verify")
    return lb.structures.block(lb.PointContact(0.6), width=0.2, height=1.0).save(folder / "block.json")


@pytest.fixture(scope="module")
def kept(block):
    """A capacity curve of the block."""
    file = block.with_name("curve.json")
    assert run("capacity", block, "-o", file).exit_code == 0
    return file


def test_verify(block, tmp_path):
    """A block of its own: e* = 1, a0* = .2 g / 1.35, demand .25 x 1.2 g / 2."""
    site = ("--a-g", 0.25, "--soil", 1.2, "--f0", 2.5, "--t-c", 0.5, "--q", 2)
    done = run("verify", block, *site, "--linear", "--json")
    assert done.exit_code == 1, done.output
    check = json.loads(done.stdout)["checks"][0]
    assert check["ratio"] == pytest.approx(0.2 / 1.35 / 0.15, rel=1e-8)
    free = run("verify", block, *site, "--linear", "--json", "--elastic-period", 0.3)
    assert json.loads(free.stdout)["checks"][0]["demand"] == pytest.approx(2.5 * 0.25 * 9.81 * 1.2 / 2)
    assert "--q" in run("verify", block, *site[:-2]).output
    assert "F0 is 1.0" in run("verify", block, *site[:4], "--f0", 1, *site[6:]).output


def test_verify_takes_a_curve_that_was_kept(block, kept, tmp_path, monkeypatch):
    """A curve may take minutes, and was drawn anew."""
    site = ("--a-g", 0.25, "--soil", 1.2, "--f0", 2.5, "--t-c", 0.5, "--q", 2)
    anew = json.loads(run("verify", block, *site, "--json").stdout)
    bounds = tmp_path / "bounds.json"
    assert run("bounds", block, "-o", bounds).exit_code == 0
    monkeypatch.setattr("limitblocks.cli.analyses.capacity", lambda _: pytest.fail("a curve was drawn"))
    done = run("verify", block, *site, "--curve", kept, "--json")
    assert done.exit_code == 1
    found = json.loads(done.stdout)
    assert found["checks"] == anew["checks"]
    assert found["remarks"] == ["the capacity curve is as a file says, not computed here"]
    assert (
        "--curve is a Bounds, expected CapacityCurve" in run("verify", block, *site, "--curve", bounds).stderr
    )
    assert "give one of both" in run("verify", block, *site, "--curve", kept, "--linear").stderr


def test_verify_takes_another_damping(block, kept):
    """The ground acceleration that it bears at SLC goes with (5 + xi in %)^.5; 10 % is usual."""
    site = ("--a-g", 0.25, "--soil", 1.2, "--f0", 2.5, "--t-c", 0.5, "--q", 2, "--slc", ".3,1.2,2.5,.5")
    usual, damped = (
        json.loads(run("verify", block, *site, "--curve", kept, "--json", *more).stdout)["checks"][2]
        for more in ((), ("--damping", ".08,.12"))
    )
    assert damped["capacity"] == pytest.approx((17 / 15) ** 0.5 * usual["capacity"], rel=1e-9)
    wrong = run("verify", block, *site, "--curve", kept, "--damping", 5)
    assert (wrong.exit_code, "expected SLV,SLC" in wrong.output) == (2, True)
    assert "--damping, --linear" in run("verify", block, *site, "--linear", "--damping", ".05,.1").output


def test_verify_refuses_a_slip_before_it_draws_a_curve(block, monkeypatch):
    """A curve may take minutes, and what is wrong was said after it."""
    monkeypatch.setattr("limitblocks.cli.analyses.capacity", lambda _: pytest.fail("a curve was drawn"))
    site = {"--a-g": 0.25, "--soil": 1.2, "--f0": 2.5, "--t-c": 0.5, "--q": 2}
    for wrong, said in (
        ({"--a-g": 2.5}, "2.5 g"),
        ({"--q": 0.5}, "q is 0.5"),
        ({"--confidence": 9}, "FC is 9"),
    ):
        done = run("verify", block, *(word for pair in (site | wrong).items() for word in pair))
        assert done.exit_code == 2
        assert said in done.output


def test_verify_says_the_linear_checks_before_it_draws_a_curve(block, monkeypatch):
    """A curve may take minutes, and may not end: ratio .2 / 1.35 / .15, and JSON alone on stdout."""

    def undrawn(model):
        raise lb.ModelError("no curve today")

    monkeypatch.setattr("limitblocks.cli.analyses.capacity", undrawn)
    site = ("--a-g", 0.25, "--soil", 1.2, "--f0", 2.5, "--t-c", 0.5, "--q", 2, "--json")
    done = run("verify", block, *site)
    before = done.stderr.partition("no curve today")[0]
    assert f"{0.2 / 1.35 / 0.15:.3f}" in before
    assert "before the capacity curve" not in run("verify", block, *site, "--linear").stderr


def test_verify_files_a_report(block, tmp_path):
    """The PDF has symbols and numbers: a0* = .2 g / 1.35, M* = the mass, ratio .2 / 1.35 / .15 = .98765."""
    pypdf = pytest.importorskip("pypdf", reason="the package pypdf is not installed")
    site = ("--a-g", 0.25, "--soil", 1.2, "--f0", 2.5, "--t-c", 0.5, "--q", 2, "--linear")
    done = run("verify", block, *site, "--report", tmp_path / "filed.pdf")
    assert done.exit_code == 1, done.output
    said = " ".join(page.extract_text() for page in pypdf.PdfReader(tmp_path / "filed.pdf").pages)
    said = " ".join(said.split())
    for word in ("M*", "e*", "a0*", "a_g S / q", "0.987 ", "NOT satisfied", "not against the Gazzetta"):
        assert word in said, word
    assert f"{0.2 * 9.81 / 1.35:.4g} m/s²" in said
    assert run("verify", block, *site, "--report", tmp_path / "filed.doc").exit_code == 2
    (tmp_path / "kept.pdf").write_text("another's")
    assert run("verify", block, *site, "--report", tmp_path / "kept.pdf").exit_code == 2


def test_verify_on_a_floor_and_at_damage(block):
    """One mode: a_Z = S_e(T) gamma psi sqrt(1.01) = .75 g 1.2 sqrt(1.01); SLD at .02 g is not set off."""
    site = ("--a-g", 0.25, "--soil", 1.2, "--f0", 2.5, "--t-c", 0.5, "--q", 2, "--linear", "--json")
    done = run("verify", block, *site, "--mode", "0.3,1.2,1.0,0.05", "--sld", "0.02,1.2,2.5,0.5")
    assert done.exit_code == 1, done.output
    linear, damage = json.loads(done.stdout)["checks"]
    assert linear["demand"] == pytest.approx(0.75 * 9.81 * 1.2 * 1.01**0.5 / 2)
    assert damage["demand"] == pytest.approx(0.06 * 9.81 * 1.2 * 1.01**0.5)
    assert damage["satisfied"] == (damage["demand"] <= 0.2 * 9.81 / 1.35)


def test_verify_without_a_whole_curve_has_the_linear_check_and_fails(block, monkeypatch):
    """A curve that ends early is said; the linear check of .02 g is met; the exit code is 1."""
    from limitblocks.cli import analyses
    from limitblocks.practice import capacity_curve

    monkeypatch.setattr(analyses, "capacity", lambda model: capacity_curve(model, steps=2, largest=0.01))
    site = ("--a-g", 0.02, "--soil", 1.2, "--f0", 2.5, "--t-c", 0.5, "--q", 2)
    done = run("verify", block, *site, "--json")
    assert done.exit_code == 1, done.output
    found = json.loads(done.stdout)
    assert [(one["name"], one["satisfied"]) for one in found["checks"]] == [("linear, SLV", True)]
    assert found["left_out"].startswith("no non-linear check: the capacity curve does not end at zero")
    assert run("verify", block, *site, "--linear", "--json").exit_code == 0
