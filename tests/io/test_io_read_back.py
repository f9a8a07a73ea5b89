"""What was saved is read back as what it was, and is no evidence until it is checked again."""

import json
from dataclasses import replace
from functools import reduce
from operator import getitem

import numpy as np
import pytest
from typer.testing import CliRunner

import limitblocks as lb
from limitblocks.cli import app
from limitblocks.errors import CheckFailed
from limitblocks.io.result_file import result_text
from limitblocks.reports.answer import answer

MODEL = lb.structures.portal(lb.PointContact(0.6), span=1.6, pier_width=0.8, pier_blocks=2, depth=0.8)
FOUND = lb.nonassociated(MODEL)
SAVED = {
    "bounds": lb.bounds(MODEL),
    "nonassociated": FOUND,
    "path": lb.load_path(MODEL),
    "range": lb.load_factor_range(MODEL, paths=1, mechanisms=0),
    "stability": lb.stability(MODEL),
    "check": lb.check_mcp(MODEL, FOUND),
}
TITLES = {
    "bounds": "Associated bounds",
    "nonassociated": "Non-associated solution",
    "path": "Load path",
    "range": "Range of load factors",
    "stability": "Stability under the dead loads, as a file says",
    "check": "Check, as a file says",
}
COPIES = ("load_path", "reached", "certified")  # load factors of answers
END = {"bound": 0.0, "proven": True, "stress_limit": None, "multiplier_limit": 1.0, "seconds": 0.0}
WRONG = {"bounds": ("lower", "upper"), "nonassociated": ("load_factor",)}


def changed(file, **values):
    document = json.loads(file.read_text(encoding="utf-8")) | values
    file.write_text(json.dumps(document), encoding="utf-8")
    return file


def without(file, *keys):
    document = json.loads(file.read_text(encoding="utf-8"))
    file.write_text(json.dumps({k: v for k, v in document.items() if k not in keys}), encoding="utf-8")
    return file


@pytest.mark.parametrize("kind", SAVED)
def test_what_was_saved_is_read_back(kind, tmp_path):
    saved = SAVED[kind]
    for given in ((), (MODEL,)):
        read = lb.read_result(saved.save(tmp_path / "result.json", overwrite=True), *given)
        assert type(read) is type(saved)
        assert result_text(read) == result_text(saved)  # to_dict with null for what is undefined or infinite
        assert str(read) == str(saved) + "; as a file says, not checked" or kind == "path"
        assert "as a file says, not checked" in str(read)
        assert (read.from_file, saved.from_file) == (True, False)
        assert read.digest == MODEL.digest


def test_parts_of_a_path_are_what_they_were(tmp_path):
    path = SAVED["path"]
    snapped = replace(path, snaps=(lb.results.Snap(path.steps[1], path.steps[2]),), tracked=np.nan)
    read = lb.read_result(snapped.save(tmp_path / "path.json"))
    assert read.snaps[0].after is read.steps[2]
    assert read.snaps[0].drop == snapped.snaps[0].drop
    assert np.isnan(read.tracked)
    assert read.steps[-1].active == path.steps[-1].active
    assert not read.steps[0].displacements.flags.writeable
    assert read.collapse.history == path.collapse.history
    assert read.collapse.residuals == path.collapse.residuals  # what each measures and where, too


@pytest.mark.parametrize("kind", SAVED)
def test_a_saved_result_is_reported_as_what_it_is(kind, tmp_path):
    SAVED[kind].save(tmp_path / "result.json")
    MODEL.save(tmp_path / "model.json")
    output = tmp_path / "report.md"
    files = [str(tmp_path / name) for name in ("model.json", "result.json")]
    done = CliRunner().invoke(app, ["report", *files, "--output", str(output)])
    assert done.exit_code == 0, done.output
    text = output.read_text(encoding="utf-8")
    assert f"## {TITLES[kind]}" in text
    assert "read from a file" in text
    assert "FAIL" not in text


@pytest.mark.parametrize("kind", WRONG)
def test_what_a_file_says_of_itself_is_no_evidence(kind, tmp_path):
    """The load factor raised by 1 %, with status and residuals of the true one left as they are."""
    file = SAVED[kind].save(tmp_path / "result.json")
    said = {key: 1.01 * getattr(SAVED[kind], key) for key in WRONG[kind]}
    if kind == "bounds":  # which are told twice
        said["proof"] = SAVED[kind].proof.to_dict() | said
    file = changed(file, tolerance=1e3, **said)
    read = lb.read_result(file, MODEL)
    assert type(read) is type(SAVED[kind])
    assert not lb.check_mcp(MODEL, read).passed
    made = lb.report(MODEL, read)
    assert answer(made.sections).load_factor is None
    assert "Claimed solution, check failed" in made.markdown
    assert "FAIL" in made.markdown


def test_a_path_to_a_wrong_collapse_is_no_path(tmp_path):
    file = SAVED["path"].save(tmp_path / "path.json")
    collapse = json.loads(file.read_text(encoding="utf-8"))["collapse"]
    collapse["load_factor"] *= 1.01
    read = lb.read_result(changed(file, collapse=collapse))
    assert "Claimed solution, check failed" in lb.report(MODEL, read).markdown


def test_a_range_with_an_answer_that_is_none_is_refused(tmp_path):
    file = SAVED["range"].save(tmp_path / "range.json")
    answers = json.loads(file.read_text(encoding="utf-8"))["answers"]
    del answers[0]["load_factor"]
    answers[0]["solution"]["load_factor"] *= 1.01
    changed(without(file, *COPIES), answers=answers)
    with pytest.raises(CheckFailed, match=r"load factor .*, that is no solution: "):
        lb.report(MODEL, lb.read_result(file))
    model = MODEL.save(tmp_path / "model.json")
    done = CliRunner().invoke(app, ["report", str(model), str(file), "-o", str(tmp_path / "report.md")])
    assert done.exit_code == 1  # a check failed; 2 would be a wrong model


@pytest.mark.parametrize(
    "place", ["answers.0.load_factor", "load_path", "reached.0", "answers.0.check.passed"]
)
def test_a_range_that_says_a_number_twice_and_otherwise_is_refused(place, tmp_path):
    file = SAVED["range"].save(tmp_path / "range.json")
    document = json.loads(file.read_text(encoding="utf-8"))
    *on, last = (int(key) if key.isdigit() else key for key in place.split("."))
    held = reduce(getitem, on, document)
    held[last] = False if held[last] is True else 1.01 * held[last]
    changed(file, **document)
    with pytest.raises(lb.ModelError, match=f"{place} is .*, but by what else the file says it is "):
        lb.read_result(file)


def test_check_judges_every_answer_of_a_range(tmp_path):
    """Two answers; then the load factor of the second is 1 % too large, and the first stays a solution."""
    model, file = MODEL.save(tmp_path / "model.json"), SAVED["range"].save(tmp_path / "range.json")
    first, second = (json.loads(file.read_text(encoding="utf-8"))["answers"][0] for _ in range(2))
    answers = [first, second]
    changed(without(file, *COPIES), answers=answers)

    def check(*options):
        return CliRunner().invoke(app, ["check", str(model), str(file), *options])

    done = check()
    assert (done.exit_code, done.stderr) == (0, "")
    *lines, unjudged = done.stdout.splitlines()
    assert [line.partition(": worst")[0] for line in lines] == [
        f"load factor {one['load_factor']:.6g}: check passed" for one in answers
    ]
    assert unjudged.startswith(
        "as the file says, not judged: how answers were reached, intervals between them, "
    )
    assert check("--tolerance", "1e-20").exit_code == 1
    del second["load_factor"]
    second["solution"]["load_factor"] *= 1.01
    changed(file, answers=answers)
    done = check()
    assert done.exit_code == 1
    named = f"load factor {second['solution']['load_factor']:.6g}"
    assert [line.partition(": worst")[0] for line in done.stdout.splitlines()[:-1]] == [
        f"load factor {first['load_factor']:.6g}: check passed",
        f"{named}: check FAILED",
    ]
    assert done.stderr.splitlines() == [f"error: 1 of 2 answers failed the check: {named}"]
    said = json.loads(check("--json").stdout)
    passed = [one["check"]["passed"] for one in said["answers"]]
    assert (said["accepted"], passed) == (False, [True, False])
    assert (said["schema_version"], said["versions"]["limitblocks"]) == (1, lb.__version__)
    ends = dict.fromkeys(("least", "greatest"), {"answer": second} | END)  # those of `exact` are judged, too
    answers.pop()
    changed(file, answers=answers, **ends)
    assert check().stderr.startswith("error: 2 of 3 answers failed the check: ")
    changed(file, answers=[], load_path_place=None, least=None, greatest=None)
    assert "error: the range has no answer that could be checked" in check().stderr
    assert check().exit_code == 2


def test_a_check_and_a_stability_that_were_read_prove_nothing(tmp_path):
    for kind in ("check", "stability"):
        made = lb.report(MODEL, lb.read_result(SAVED[kind].save(tmp_path / f"{kind}.json")))
        (said,) = made.sections
        assert said.headline == "not checked"
        assert not said.judged
        assert said.rates is None
    failed = changed(tmp_path / "check.json", passed=False)
    with pytest.raises(lb.ModelError, match="passed is False, but by what else the file says it is True"):
        lb.read_result(failed)


@pytest.mark.parametrize(
    ("kind", "key"), [("nonassociated", "history"), ("path", "steps"), ("bounds", "proof")]
)
def test_a_file_that_lacks_something_is_a_claim(kind, key, tmp_path):
    """As a file of an earlier version or of another program."""
    file = without(SAVED[kind].save(tmp_path / "result.json"), key)
    assert type(lb.read_result(file)) is lb.results.Claim
    assert "Claimed solution, check passed" in lb.report(MODEL, lb.read_result(file)).markdown


@pytest.mark.parametrize("key", ["history", "status", "residuals", "backward_error", "remarks", "how"])
@pytest.mark.parametrize("nonsense", [7, [[1]], {"a": []}, {}, None], ids=str)
def test_nonsense_beside_the_numbers_makes_it_a_claim(key, nonsense, tmp_path):
    file = changed(FOUND.save(tmp_path / "result.json"), **{key: nonsense})
    assert type(lb.read_result(file)) is lb.results.Claim


@pytest.mark.parametrize(
    "changes",
    [{"steps": []}, {"snaps": [[0, 99]]}, {"snaps": [[-1, 0]]}, {"trace": [[0, 1]]}, {"tracked": 1e300}],
    ids=str,
)
def test_a_path_that_is_none_is_the_claim_of_its_collapse(changes, tmp_path):
    read = lb.read_result(changed(SAVED["path"].save(tmp_path / "path.json"), **changes))
    assert type(read) is lb.results.Claim


def test_files_without_the_new_keys_are_read(tmp_path):
    file = without(FOUND.save(tmp_path / "result.json"), "residual_details")
    read = lb.read_result(file)
    assert type(read) is type(FOUND)
    assert read.residuals.to_dict() == FOUND.residuals.to_dict()


def test_result_of_another_model_is_refused(tmp_path):
    other = lb.structures.block(lb.PointContact(0.4), width=0.5, height=1.0)
    for kind, saved in SAVED.items():
        file = saved.save(tmp_path / f"{kind}.json")
        with pytest.raises(lb.ModelError, match=r"belongs to model \w+, not to this model \w+$"):
            lb.read_result(file, other)
        with pytest.raises(lb.ModelError, match=r"limitblocks 0\.0\.9, this .*: analyse it again$"):
            lb.read_result(changed(file, versions={"limitblocks": "0.0.9"}), other)


@pytest.mark.parametrize("version", [2, True, "1", None])
@pytest.mark.parametrize("kind", ["range", "stability"])
def test_results_of_another_version_are_refused(kind, version, tmp_path):
    file = SAVED[kind].save(tmp_path / "result.json")
    said = json.loads(file.read_text(encoding="utf-8"))
    file.write_text(json.dumps(said | {"schema_version": version}), encoding="utf-8")
    with pytest.raises(lb.ModelError, match=f"schema_version: expected 1, not {version!r}"):
        lb.read_result(file)
