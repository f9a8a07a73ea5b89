import json
import re
from contextlib import suppress
from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from stones import model_of, portal_stones

import limitblocks as lb
from limitblocks.evidence.claim import claim_of
from limitblocks.evidence.ending import Status
from limitblocks.evidence.load_path_result import LoadPath, PathStep
from limitblocks.evidence.results import Iteration, Nonassociated
from limitblocks.io import strict_json
from limitblocks.problem import Turning

PAGE = Path(__file__).parents[2] / "docs" / "result-file.md"


def portal(joint, name="lintel"):
    blocks = portal_stones(lintel=name)
    return model_of(blocks, ["ground"], joint)


def associated(model, dilatancy, turning=Turning.CENTROID):
    """The associated solution as what it is too: a solution at dilatancy = friction."""
    bounds = lb.bounds(model)
    state = {key: getattr(bounds, key) for key in STATE}
    history = (Iteration(bounds.lower, "step", 0.0, {"flow": np.inf}, 1, 0),)
    return Nonassociated(
        load_factor=bounds.upper,
        frictionless=np.nan,
        associated=np.inf,
        residuals=bounds.residuals,
        backward_error=lb.check_mcp(model, bounds).backward_error,
        status=Status.CONVERGED,
        how="tracked path",
        history=history,
        dilatancy=dilatancy,
        turning=turning,
        remarks=(),
        tolerance=1e-6,
        digest=model.digest,
        **state,
    )


def load_path(result):
    still = np.zeros_like(result.displacement_rates)
    first = PathStep(0.0, result.stress_resultants, still, (), {"equilibrium": 0.0, "yield": 0.0}, "step")
    last = replace(first, load_factor=result.load_factor, active=(("ground|left", "sliding"),))
    return LoadPath((first, last), result)


STATE = (
    "stress_resultants",
    "generalised_stresses",
    "displacement_rates",
    "flow_multipliers",
    "dead_load_stresses",
)
MODELS = {"rows": portal(lb.OrdunaLourenco(0.2)), "points": portal(lb.PointContact(0.2))}
RESULTS = {key: associated(model, 0.2) for key, model in MODELS.items()}
MODEL, RESULT = MODELS["points"], RESULTS["points"]
DOCUMENT = json.loads(strict_json.text(RESULT.to_dict()))
MINIMAL = {key: DOCUMENT[key] for key in ("load_factor", "stress_resultants")}


def written(file, document):
    file.write_text(document if isinstance(document, str) else json.dumps(document), encoding="utf-8")
    return file


@pytest.mark.parametrize("wrapped", [lambda result: result, load_path], ids=["state", "path"])
@pytest.mark.parametrize("key", MODELS)
def test_what_is_written_is_read_bit_for_bit(key, wrapped, tmp_path):
    model, result = MODELS[key], RESULTS[key]
    file = lb.files.write_result(wrapped(result), tmp_path / "result.json")
    for read in (lb.read_result(file), lb.read_result(str(file), model)):
        claim = read.collapse
        assert (claim.load_factor, claim.dilatancy, claim.digest) == (result.load_factor, 0.2, model.digest)
        for name in STATE:
            array = getattr(claim, name)
            assert array.tobytes() == getattr(result, name).tobytes()
            assert not array.flags.writeable
        assert lb.check_mcp(model, claim).passed


@pytest.mark.parametrize("key", MODELS)
def test_bounds_are_read_and_checked_with_associated_flow(key, tmp_path):
    """The stresses of the lower bound and the mechanism of the upper one solve Eqs (54)-(59) with G = F."""
    model = MODELS[key]
    bounds = lb.bounds(model)
    claim = lb.read_result(lb.files.write_result(bounds, tmp_path / "bounds.json"), model)
    assert (claim.load_factor, claim.dilatancy, claim.digest) == (bounds.lower, np.inf, model.digest)
    assert all(np.array_equal(getattr(claim, name), getattr(bounds, name)) for name in STATE)
    check = lb.check_mcp(model, claim, tolerance=1e-6)
    assert check.passed
    assert not check.mechanism_found
    assert not lb.check_mcp(
        model, replace(claim_of(model, claim), dilatancy=0.0), tolerance=1e-6
    ).passed  # V = mu N slides


@pytest.mark.parametrize("kind", ["bounds", "nonassociated", "minimal"])
def test_a_claim_is_written_as_it_was_read(kind, tmp_path):
    claims = {
        "bounds": lambda: claim_of(MODEL, lb.bounds(MODEL)),
        "nonassociated": lambda: claim_of(MODEL, RESULT),
        "minimal": lambda: lb.read_result(written(tmp_path / "minimal.json", MINIMAL)),
    }
    claim = claims[kind]()
    again = lb.read_result(lb.files.write_result(claim, tmp_path / "claim.json"))
    assert isinstance(again, lb.results.Claim)
    for field in fields(claim):
        one, other = getattr(claim, field.name), getattr(again, field.name)
        assert np.array_equal(one, other), field.name
    flow = "associated" if kind == "bounds" else "non-associated"
    upper = f" to {claim.upper:.6g}" if kind == "bounds" else ""
    assert str(again) == f"claimed {flow} load factor {claim.load_factor:.6g}{upper}, not checked"


def test_turning_is_written_and_read(tmp_path):
    result = associated(MODEL, 0.2, Turning.PRESSURE)
    file = lb.files.write_result(result, tmp_path / "result.json")
    assert json.loads(file.read_text(encoding="utf-8"))["turning"] == "centre of pressure"
    assert lb.read_result(file).turning is Turning.PRESSURE
    assert lb.read_result(written(file, MINIMAL)).turning is Turning.CENTROID


def test_file_is_strict_json_and_says_where_it_comes_from(tmp_path):
    text = lb.files.write_result(load_path(RESULT), tmp_path / "result.json").read_text(encoding="utf-8")
    document = json.loads(text, parse_constant=lambda word: pytest.fail(f"{word} is not JSON"))
    assert (document["schema_version"], document["analysis"]) == (1, "path")
    assert document["versions"]["limitblocks"] == lb.__version__
    collapse = document["collapse"]
    assert (collapse["frictionless"], collapse["associated"]) == (None, None)  # undefined, and infinite
    assert collapse["history"][0]["residuals"] == {"flow": None}
    assert collapse["model_digest"] == MODEL.digest


def test_nothing_is_overwritten_unasked(tmp_path):
    file = written(tmp_path / "result.json", "mine")
    with pytest.raises(lb.LimitBlocksError, match="exists"):
        lb.files.write_result(RESULT, file)
    assert file.read_text() == "mine"
    assert (
        lb.read_result(lb.files.write_result(RESULT, file, overwrite=True)).load_factor == RESULT.load_factor
    )
    with pytest.raises(lb.LimitBlocksError, match="cannot write"):
        lb.files.write_result(RESULT, tmp_path / "none" / "result.json")


def test_minimal_file_is_enough_and_names_may_stand_for_order(tmp_path):
    model, result = MODELS["rows"], RESULTS["rows"]
    named = {i.name: row for i, row in zip(model.interfaces, result.stress_resultants.tolist(), strict=True)}
    rates = {b.name: row for b, row in zip(model.blocks, result.displacement_rates.tolist(), strict=True)}
    del rates["ground"]
    document = {"load_factor": result.load_factor, "stress_resultants": dict(reversed(named.items()))}
    file = written(tmp_path / "result.json", document | {"dilatancy": 0.2})
    claim = lb.read_result(file, model)
    assert (claim.digest, claim.displacement_rates, claim.flow_multipliers) == ("", None, None)
    assert np.array_equal(claim.stress_resultants, result.stress_resultants)
    check = lb.check_mcp(model, claim)
    assert check.passed
    assert check.mechanism_found
    written(file, document | {"displacement_rates": rates})
    assert np.array_equal(lb.read_result(file, model).displacement_rates, result.displacement_rates)
    with pytest.raises(lb.ModelError, match="give the model too"):
        lb.read_result(file)


def test_result_of_another_model_is_refused_by_both_names(tmp_path):
    other = portal(lb.PointContact(0.2), "beam")
    file = lb.files.write_result(RESULT, tmp_path / "result.json")
    with pytest.raises(lb.ModelError) as caught:
        lb.read_result(file, other)
    assert all(part in str(caught.value) for part in (str(file), MODEL.digest[:12], other.digest[:12]))
    with pytest.raises(lb.ModelError, match=f"{MODEL.digest[:12]}.*{other.digest[:12]}"):
        lb.check_mcp(other, lb.read_result(file))


def six(**changes):
    named = {i.name: [0.0] * 6 for i in MODEL.interfaces} | changes
    return MINIMAL | {"stress_resultants": {key: row for key, row in named.items() if row}}


FAULTS = {
    "empty": (" ", ["is empty"]),
    "truncated": (json.dumps(DOCUMENT)[:300], ["line 1, column", "not JSON"]),
    "NaN": (json.dumps(MINIMAL | {"load_factor": np.nan}), ["load_factor: NaN is not a number"]),
    "infinity by size": (json.dumps(MINIMAL).replace('"load_factor": ', '"load_factor": 1e999, "x": '), []),
    "duplicate key": ('{"load_factor": 1, "load_factor": 2}', ["'load_factor' appears twice"]),
    "a list": ("[1, 2]", ["expected an object"]),
    "deep": ("[" * 100_000, ["nests too deeply"]),
    "nothing in it": ({}, ["load_factor: is missing", "stress_resultants: is missing"]),
    "undefined load factor": (MINIMAL | {"load_factor": None}, ["load_factor: expected a number, not None"]),
    "text for a number": (MINIMAL | {"load_factor": "0.2"}, ["load_factor: expected a number, not '0.2'"]),
    "row of five": (
        MINIMAL | {"stress_resultants": [[0.0] * 6, [0.0] * 5]},
        ["stress_resultants[1][5]: is missing"],
    ),
    "number in a row": (
        MINIMAL | {"stress_resultants": [[0, 0, "N", 0, 0, 0]]},
        ["stress_resultants[0][2]: expected a number, not 'N'"],
    ),
    "number in a row as text": (
        MINIMAL | {"stress_resultants": [[0, 0, "1", 0, 0, True]]},
        [
            "stress_resultants[0][2]: expected a number, not '1'",
            "stress_resultants[0][5]: expected a number, not True",
        ],
    ),
    "multiplier as text": (
        MINIMAL | {"flow_multipliers": ["0"]},
        ["flow_multipliers[0]: expected a number, not '0'"],
    ),
    "no rows": (MINIMAL | {"stress_resultants": 7}, ["stress_resultants: expected a list [...], not 7"]),
    "key": (
        MINIMAL | {"flow_multiplier": []},
        ["flow_multiplier: unknown key; did you mean 'flow_multipliers'"],
    ),
    "dilatancy": (MINIMAL | {"dilatancy": -0.1}, ["dilatancy: expected", "-0.1"]),
    "no number": (MINIMAL | {"schema_version": True}, ["schema_version: expected 1, not True"]),
    "future": (MINIMAL | {"schema_version": 2}, ["schema_version: expected 1, not 2"]),
    "kind": (MINIMAL | {"analysis": "modal"}, ["analysis: expected 'nonassociated'", "'modal'"]),
    "kind of kind": (MINIMAL | {"analysis": [1]}, ["analysis: expected 'nonassociated'"]),
    "stability": ({"analysis": "stability"}, ["no load factor", "result of bounds, nonassociated or path"]),
    "stability without stresses": (
        {"analysis": "stability", "kind": "stands", "margin": 0.1, "blocks": [], "residuals": {"yield": 0.0}},
        ["whether the dead loads stand", "(stress_resultants is missing)"],
    ),
    "bounds without a lower one": ({"analysis": "bounds", "upper": 1.0}, ["lower: is missing"]),
    "turning": (MINIMAL | {"turning": "table 5"}, ["turning: expected 'centroid' or 'centre of pressure'"]),
    "check": ({"analysis": "check"}, ["holds a check"]),
    "path without collapse": ({"analysis": "path", "steps": []}, ["collapse: is missing"]),
    "fault within a path": (
        {"analysis": "path", "collapse": MINIMAL | {"load_factor": "a"}},
        ["collapse.load_factor: expected a number"],
    ),
    "report": (lb.report(MODEL).to_dict(), ["is a report, which nothing is read from; a result file"]),
    "another model": (MINIMAL | {"model_digest": "0" * 64}, ["belongs to model 000000000000, not to this"]),
    "unknown interface": (
        six(**{"ground|lefd": [0.0] * 6}),
        ["no 'ground|lefd' in the model", "'ground|left'"],
    ),
    "missing interface": (six(**{"ground|left": None}), ["stress_resultants: 'ground|left' is missing"]),
    "missing block": (
        MINIMAL | {"displacement_rates": {"left": [0] * 6}},
        ["'right' is missing", "'lintel'"],
    ),
}


@pytest.mark.parametrize(("document", "said"), FAULTS.values(), ids=FAULTS)
def test_fault_is_one_line_that_names_file_and_place(document, said, tmp_path):
    file = written(tmp_path / "result.json", document)
    with pytest.raises(lb.ModelError) as caught:
        lb.read_result(file, MODEL)
    problems = caught.value.problems
    assert all(problem.startswith(f"{file}: ") and "\n" not in problem for problem in problems)
    assert all(part in "\n".join(problems) for part in said), problems
    assert "pydantic" not in str(caught.value)


def test_all_faults_come_at_once(tmp_path):
    wrong = {"load_factor": "a", "stress_resultants": [[0]], "dilatancy": -1, "x": 0}
    with pytest.raises(lb.ModelError) as caught:
        lb.read_result(written(tmp_path / "result.json", wrong))
    assert len(caught.value.problems) == 8
    with pytest.raises(lb.ModelError, match="No such file"):
        lb.read_result(tmp_path / "none.json")


@pytest.mark.parametrize("name", STATE)
def test_wrong_number_of_rows_is_refused_by_the_check(name, tmp_path):
    file = written(tmp_path / "result.json", DOCUMENT | {name: DOCUMENT[name][1:]})
    with pytest.raises(lb.ModelError, match=f"{name} has shape .*, expected"):
        lb.check_mcp(MODEL, lb.read_result(file, MODEL))


@given(
    st.sampled_from(sorted(DOCUMENT)),
    st.none() | st.booleans() | st.floats() | st.text() | st.lists(st.none()),
)
def test_only_our_errors_come_out_of_mutated_documents(tmp_path_factory, key, value):
    file = written(tmp_path_factory.mktemp("fuzz") / "result.json", DOCUMENT | {key: value})
    with suppress(lb.LimitBlocksError):
        lb.check_mcp(MODEL, lb.read_result(file, MODEL))


def test_file_on_the_page_is_a_solution(tmp_path):
    (text,) = re.findall(r"```json\n(.*?)```", PAGE.read_text(encoding="utf-8"), flags=re.DOTALL)
    blocks = [
        lb.Block.box("ground", (4, 1, 0.2), (0, 0, -0.1)),
        lb.Block.box("stone", (1, 1, 2), (0, 0, 1), 20e3),
    ]
    model = model_of(blocks, ["ground"], lb.OrdunaLourenco(0.3))
    assert lb.check_mcp(model, lb.read_result(written(tmp_path / "claim.json", text), model)).passed
