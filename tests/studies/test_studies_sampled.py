"""Studies over sampled parameters: closed forms, going on after an end, failures as rows."""

import json

import numpy as np
import pytest
from scipy import stats

import limitblocks as lb
from limitblocks.studies import SampledStudy, sampled
from limitblocks.studies.pool import failed
from limitblocks.studies.results import unanswered
from limitblocks.studies.samples import sampled_values


def block(friction=0.5, width=1.0):
    """min(friction, width / height) of a block one metre high."""
    return lb.structures.block(lb.PointContact(friction), width=width, height=1.0)


def product(friction, scale):
    """A block on a plane whose load factor is friction times a scale, by the direction's live load."""
    model = lb.structures.block(lb.PointContact(friction), width=2.0, height=1.0)
    live = (1.0 / scale) * lb.mass_proportional((1, 0, 0))
    return lb.Model(model.blocks, model.supports, model.interfaces, model.dead, live)


def falls_where_slippery(friction):
    if friction < 0.3:
        raise lb.ModelError("too slippery")
    return block(friction)


def test_load_factors_and_quantiles_of_a_block():
    found = lb.study(block, {"friction": (0.2, 0.6), "width": stats.uniform(0.3, 0.2)}, 16, seed=3)
    expected = np.minimum(*found.values.T)
    assert found.values.shape == (16, 2)
    assert found.values.min(axis=0) == pytest.approx([0.2, 0.3], abs=0.03)
    assert found.load_factors == pytest.approx(expected, rel=1e-6)
    assert found.quantiles([0.0, 1.0]) == pytest.approx([expected.min(), expected.max()], rel=1e-6)
    assert found.probability_below(0.35) == (found.load_factors < 0.35).mean()
    slides = found.values[:, 0] < found.values[:, 1]
    assert [mode == "slide" for mode in found.modes] == slides.tolist()
    assert found.mode_frequencies() == pytest.approx({"slide": slides.mean(), "hinge": 1 - slides.mean()})
    assert "16 analyses of friction, width" in str(found)


@pytest.mark.parametrize("sampler", ["sobol", "latin hypercube", "halton", "random"])
def test_samples_are_those_of_the_seed_and_fill_the_interval(sampler, monkeypatch):
    monkeypatch.setattr(
        sampled, "one_row", lambda k, *_: {"row": k, "load_factor": 1.0, "mode": "", "error": ""}
    )
    runs = [lb.study(block, {"friction": (1.0, 3.0)}, 64, sampler=sampler, seed=s) for s in (1, 1, 2)]
    assert (runs[0].values == runs[1].values).all()
    assert not (runs[0].values == runs[2].values).any()
    assert 1.0 <= runs[0].values.min() < 1.2
    assert 2.8 < runs[0].values.max() <= 3.0
    assert runs[0].values.mean() == pytest.approx(2.0, abs=0.2)


def test_a_sample_without_an_answer_has_no_mode(monkeypatch):
    """NotConverged carries the best state: what its joints do is no mechanism of the sample."""
    best = lb.bounds(block(0.4))
    monkeypatch.setattr(sampled, "analyse", lambda *_: failed(lb.NotConverged("no path", best)))
    found = lb.study(block, {"friction": (0.3, 0.5)}, 2)
    assert found.modes == ("", "")
    assert np.isnan(found.load_factors).all()


def test_a_study_that_was_killed_before_its_first_line_begins_anew(tmp_path):
    ask, empty, new = {"friction": (0.2, 0.6)}, tmp_path / "empty.jsonl", tmp_path / "new.jsonl"
    empty.touch()
    for file in (empty, new):
        lb.study(block, ask, 2, file=file)
    assert empty.read_bytes() == new.read_bytes()
    empty.write_bytes(new.read_bytes()[:30])  # within the first line
    lb.study(block, ask, 2, file=empty)
    assert empty.read_bytes() == new.read_bytes()


def test_ended_study_goes_on_without_computing_anything_twice(tmp_path, monkeypatch):
    file, calls, own = tmp_path / "study.jsonl", [], sampled.one_row

    def counted(number, *rest):
        if len(calls) == 5:
            calls.append(None)
            raise RuntimeError("the machine stops")
        calls.append(number)
        return own(number, *rest)

    monkeypatch.setattr(sampled, "one_row", counted)
    ask = {"friction": (0.2, 0.6)}
    with pytest.raises(RuntimeError):
        lb.study(block, ask, 8, file=file)
    file.write_text(file.read_text() + '\n{"row": 5, "load_f')  # cut off by the end
    found = lb.study(block, ask, 8, file=file)
    assert [k for k in calls if k is not None] == [0, 1, 2, 3, 4, 5, 6, 7]
    assert found.load_factors == pytest.approx(found.values[:, 0], rel=1e-6)
    assert len([json.loads(line) for line in file.read_text().splitlines()]) == 1 + 8
    again = lb.study(block, ask, 8, file=file)
    assert len(calls) == 9
    assert (again.load_factors == found.load_factors).all()
    with pytest.raises(lb.ModelError, match="is of another study: seed 0 there, 1 here; name another file"):
        lb.study(block, ask, 8, file=file, seed=1)
    with pytest.raises(lb.ModelError, match="another study: number of samples 8 there, 16 here"):
        lb.study(block, ask, 16, file=file)
    with pytest.raises(lb.ModelError, match="another study: intervals or distributions"):
        lb.study(block, dict.fromkeys(ask, (0.21, 0.6)), 8, file=file)
    file.write_text("friction 0.6\n")
    with pytest.raises(lb.ModelError, match="is of no study"):
        lb.study(block, ask, 8, file=file)


def test_a_maker_that_has_changed_is_warned_of(tmp_path, caplog):
    """A block of b/h = 1 slides at mu, one of b/h = .1 rocks at .1: rows of one are none of the other."""

    def slender(friction):
        return lb.structures.block(lb.PointContact(friction), width=0.1, height=1.0)

    file, ask = tmp_path / "study.jsonl", {"friction": (0.2, 0.6)}
    for _ in range(2):
        kept = lb.study(block, ask, 4, file=file)
    assert not caplog.records
    assert lb.study(slender, ask, 4, file=file).load_factors == pytest.approx(kept.load_factors)
    (record,) = caplog.records
    assert "row 0 is of another model than the maker makes now" in record.getMessage()


def test_failures_are_rows(tmp_path):
    found = lb.study(falls_where_slippery, {"friction": (0.2, 0.6)}, 8, file=tmp_path / "a.jsonl")
    slippery = found.values[:, 0] < 0.3
    assert found.failures == slippery.sum() > 0
    assert all(("too slippery" in e) == s for e, s in zip(found.errors, slippery, strict=True))
    again = lb.study(falls_where_slippery, {"friction": (0.2, 0.6)}, 8, file=tmp_path / "a.jsonl")
    assert np.isnan(again.load_factors).tolist() == slippery.tolist()
    assert json.loads(json.dumps(found.to_dict()))["rows"][0]["friction"] == found.values[0, 0]


def test_quantiles_where_some_loads_are_unlimited(monkeypatch):
    """In order .1, .2, .3, inf, inf: sixths fall on rows, and beyond them the lower neighbour counts."""
    values = [np.inf, 0.3, 0.1, np.inf, 0.2]
    monkeypatch.setattr(
        sampled, "one_row", lambda k, *_: {"row": k, "load_factor": values[k], "mode": "", "error": ""}
    )
    found = lb.study(block, {"friction": (0.2, 0.6)}, 5, sampler="random")
    assert found.quantiles([0.0, 0.125, 0.25, 0.5, 0.6]) == pytest.approx([0.1, 0.1, 0.15, 0.3, 0.3])
    assert np.isinf(found.quantiles([0.67, 0.9, 1.0])).all()
    assert found.probability_below(0.2) == pytest.approx(1 / 5)  # below: .1, not .2 itself


def test_quantiles_say_what_they_can_be_with_the_samples_left_out():
    """Of .1, ..., .9 the median is .5; with two more below it is .4 of eleven, with two more above .6."""
    values = np.array([*np.arange(1, 10) / 10, np.nan, np.nan])
    words = {"modes": ("",) * 11, "errors": ("",) * 9 + ("NotConverged: lost",) * 2, "indices": False}
    found = SampledStudy("bounds", ("x",), values[:, None], values, samples=11, **words)
    half = [found.quantiles([0.5], failed=one)[0] for one in (None, 0.0, np.inf)]
    assert half == pytest.approx([0.5, 0.4, 0.6])
    assert "2 without an answer (NotConverged: lost); the quantiles leave these out" in str(found)
    assert str(found).endswith("with them 5 % is at least 0, 95 % may be unlimited")
    fallen = SampledStudy("bounds", ("x",), values[:9, None], values[:9], samples=9, modes=("",) * 9,
                          errors=("",) * 9, indices=False)  # fmt: skip
    assert "leave" not in str(fallen)


@pytest.mark.parametrize("lost", [50.0, 1e6, np.inf])
def test_no_quantile_is_above_the_largest_with_the_samples_left_out(lost):
    """Of 1, ..., 48 and two lost ones, of 50 or more, 95 % is .45 of the way from the 48th to the 49th."""
    words = {"modes": ("",) * 50, "samples": 50, "indices": False}

    def studied(values, errors):
        return SampledStudy("bounds", ("x",), values[:, None], values, errors=errors, **words)

    known = np.arange(1.0, 49.0)
    without = studied(np.append(known, [np.nan] * 2), ("",) * 48 + ("NotConverged: lost",) * 2)
    complete = studied(np.append(known, [lost] * 2), ("",) * 50)
    true = complete.quantiles([0.95])[0]
    assert true == pytest.approx(0.55 * 48.0 + 0.45 * lost if lost < np.inf else 48.0)
    assert true <= without.quantiles([0.95], failed=np.inf)[0]
    assert str(without).endswith("95 % may be unlimited")
    assert without.quantiles([0.9], failed=np.inf) == pytest.approx([45.9])  # no lost one has a share


@pytest.mark.parametrize(("n", "said"), [(18, "least and largest"), (19, "5 % to 95 %")])
def test_the_line_claims_no_quantile_that_so_few_samples_do_not_have(n, said):
    """The least of n has 1 / (n + 1) below it on average, 5 % of 19."""
    values = np.arange(1.0, n + 1)
    words = {"modes": ("",) * n, "errors": ("",) * n, "samples": n, "indices": False}
    study = SampledStudy("nonassociated", ("x",), values[:, None], values, **words)
    assert f"non-associated load factor {(n + 1) / 2:g}, {said} 1 to {n}" in str(study)


def test_the_line_says_in_a_word_that_a_load_is_unlimited():
    values = np.array([1.0, 2.0, np.inf])
    words = {"modes": ("",) * 3, "errors": ("",) * 3, "samples": 3, "indices": False}
    study = SampledStudy("bounds", ("x",), values[:, None], values, **words)
    assert "associated load factor 2, least and largest 1 to unlimited" in str(study)


@pytest.mark.parametrize("n", [16, 64])
def test_what_is_below_a_quantile_is_its_share_on_average(n):
    """Of uniform samples between 0 and 1; numpy's default has (1 + (n - 1) / 20) / (n + 1)."""
    samples = np.random.default_rng(1).random((3000, n))
    words = {"modes": ("",) * n, "errors": ("",) * n, "samples": n, "indices": False}
    studies = [SampledStudy("bounds", ("x",), one[:, None], one, **words) for one in samples]
    low, high = np.mean([one.quantiles((0.05, 0.95)) for one in studies], axis=0)
    expected = max(0.05, 1 / (n + 1))  # less than the least sample there is not
    assert low == pytest.approx(expected, abs=2e-3)
    assert high == pytest.approx(1 - expected, abs=2e-3)


def test_a_parameter_that_the_maker_needs_is_named_before_any_sample(monkeypatch):
    monkeypatch.setattr(sampled, "one_row", None)
    with pytest.raises(
        lb.ModelError, match=r"the maker is given friction .*'scale'.; it takes friction, scale"
    ):
        lb.study(product, {"friction": (0.2, 0.6)}, 4)


def test_impossible_models_are_told_from_lost_answers():
    values = np.array([0.3, np.nan, np.nan, np.nan])
    errors = ("", "GeometryError: overlap", "NotConverged: lost", "ModelError: no support")
    said = unanswered(values, errors)
    assert said == "; 2 without a model (GeometryError: overlap); 1 without an answer (NotConverged: lost)"


def test_a_study_without_an_answer_prints():
    none = lb.study(falls_where_slippery, {"friction": (0.1, 0.2)}, 2)
    assert str(none) == (
        "2 analyses of friction, no load factor; 2 without a model (ModelError: too slippery)"
    )


def test_rows_for_sobol_indices_are_those_of_the_matrices():
    """A, B, and A with one column of B."""
    found = lb.study(product, {"friction": (0.2, 0.6), "scale": (0.5, 2.5)}, 2, indices=True, seed=4)
    A, B, *mixed = found.values.reshape(4, 2, 2)
    assert np.array_equal(mixed, [np.column_stack([B[:, 0], A[:, 1]]), np.column_stack([A[:, 0], B[:, 1]])])
    assert found.load_factors == pytest.approx(found.values.prod(axis=1), rel=1e-6)


def of_law(parameters, law, n=1024):
    """A study whose load factors are a law of the values."""
    names, values = sampled_values(parameters, n, "sobol", 4, True)
    words = {"modes": ("",) * len(values), "errors": ("",) * len(values)}
    return SampledStudy("bounds", names, values, law(values), samples=n, indices=True, **words)


def test_sobol_indices_of_a_product():
    """f = a b with independent a, b: S_a = Va mb^2 / (Va mb^2 + Vb ma^2 + Va Vb)."""
    found = of_law({"friction": (0.2, 0.6), "scale": (0.5, 2.5)}, lambda values: values.prod(axis=1))
    (ma, va), (mb, vb) = (0.4, 0.4**2 / 12), (1.5, 4 / 12)
    total = va * mb**2 + vb * ma**2 + va * vb
    indices = found.sobol()
    assert indices["friction"] == pytest.approx(
        (va * mb**2 / total, (va * mb**2 + va * vb) / total), abs=0.01
    )
    assert indices["scale"] == pytest.approx((vb * ma**2 / total, (vb * ma**2 + va * vb) / total), abs=0.01)


def test_a_single_parameter_has_all_of_the_variance():
    found = of_law({"friction": (0.2, 0.6)}, lambda values: values[:, 0])
    assert found.sobol() == {"friction": pytest.approx((1.0, 1.0), abs=0.01)}


def test_load_factors_that_are_one_but_for_rounding_have_no_indices():
    found = of_law({"friction": (0.2, 0.6)}, lambda values: 0.5 + 1e-11 * values[:, 0])
    with pytest.raises(lb.SolveError, match=r"all load factors are 0\.5: no parameter changes them"):
        found.sobol()


def test_table(tmp_path):
    pandas = pytest.importorskip("pandas")
    found = lb.study(block, {"friction": (0.2, 0.6)}, 2)
    assert list(found.to_frame().columns) == ["friction", "load_factor", "mode", "error", "remarks"]
    written = pandas.read_csv(found.write_csv(tmp_path / "a.csv"))
    assert written["load_factor"].tolist() == pytest.approx(found.load_factors.tolist())


def test_on_a_local_cluster():
    distributed = pytest.importorskip("dask.distributed", reason="dask is not installed")
    settings = {"n_workers": 1, "processes": False, "dashboard_address": None}
    with distributed.LocalCluster(**settings) as cluster, distributed.Client(cluster) as client:
        found = lb.study(block, {"friction": (0.2, 0.6)}, 4, client=client)
    assert found.load_factors == pytest.approx(found.values[:, 0], rel=1e-6)


@pytest.mark.parametrize(
    ("ask", "words"),
    [
        ({"parameters": {}}, "at least one parameter"),
        ({"parameters": {"friction": (0.6, 0.2)}}, "parameter 'friction' is .0.6, 0.2."),
        ({"parameters": {"friction": 0.6}}, "parameter 'friction' is 0.6, expected"),
        ({"parameters": {"mode": (0.2, 0.6)}}, "has the name 'mode' of a column"),  # its values were lost
        ({"n": 0}, "n is 0"),
        ({"workers": "2"}, "workers is '2', expected a whole number of at least 1"),
        ({"sampler": "dice"}, "sampler is 'dice'"),
        ({"analysis": "x"}, "analysis is 'x'"),
        ({"parameters": {"fricton": (0.2, 0.6)}}, "the maker is given fricton .*; it takes friction, width$"),
        ({"wide": 2}, "with bounds is given wide .*; it takes tolerance, progress$"),
        ({"n": 6, "indices": True}, "n is 6, expected a power of two"),
    ],
)
def test_misuse(ask, words):
    given = {"parameters": {"friction": (0.2, 0.6)}, "n": 4} | ask
    with pytest.raises(lb.ModelError, match=words):
        lb.study(block, given.pop("parameters"), given.pop("n"), **given)


@pytest.mark.parametrize("shares", [[5, 50, 95], [-0.1], [float("nan")], ["0.5"], None])
def test_shares_of_quantiles_are_from_0_to_1(shares):
    found = lb.study(block, {"friction": (0.2, 0.6)}, 2)
    with pytest.raises(lb.ModelError, match=r"shares is .* expected numbers from 0 to 1"):
        found.quantiles(shares)


def test_study_without_indices_has_none():
    with pytest.raises(lb.ModelError, match="indices=True"):
        lb.study(block, {"friction": (0.2, 0.6)}, 2).sobol()


def remarking(friction):
    """A pier pushed along the diagonal, of which Eq. (39) carries more than the stress block."""
    joint = lb.OrdunaLourenco(friction, compressive_strength=400e3)
    return lb.structures.block(joint, width=1.0, height=4.0, direction=(1.0, 1.0, 0.0))


def test_what_an_answer_remarks_is_kept_in_rows_and_file(tmp_path):
    file = tmp_path / "rows.jsonl"
    first, again = (lb.study(remarking, {"friction": (0.8, 0.9)}, 2, file=file) for _ in range(2))
    for found in (first, again):  # the second reads what the first wrote
        assert all("times the moment" in row["remarks"] for row in found.rows())
        assert "; 2 with remarks, such as: " in str(found)


def test_a_saved_study_is_no_result_of_one_model(tmp_path):
    file = lb.study(block, {"friction": (0.2, 0.6)}, 2).save(tmp_path / "study.json")
    written = json.loads(file.read_text())
    assert (written["study"], written["of"], written["parameters"]) == (
        "SampledStudy",
        "bounds",
        ["friction"],
    )
    with pytest.raises(lb.ModelError, match="holds a study, the load factors of many models"):
        lb.read_result(file)


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"seed": -1}, "seed is -1, expected a whole number of at least 0"),
        ({"seed": 1.5}, r"seed is 1\.5, expected a whole number"),
        ({"seed": None}, "seed is None, expected a whole number"),
        ({"tolerance": -1.0}, r"tolerance is -1\.0, expected a finite number > 0"),
        ({"indices": True, "n": 1}, "n is 1, expected a whole number of at least 2"),
        ({"maker": None}, "maker is a NoneType, expected a function"),
        ({"parameters": [("friction", (0.2, 0.6))]}, "parameters is .*, expected intervals by name"),
        ({"parameters": {1: (0.2, 0.6)}}, "parameters is .*, expected intervals by name"),
    ],
)
def test_what_is_wrong_in_a_study_is_told_before_its_rows(wrong, words):
    rows = []
    given = {"maker": block, "parameters": {"friction": (0.2, 0.6)}, "n": 2} | wrong
    maker, parameters, n = (given.pop(key) for key in ("maker", "parameters", "n"))
    with pytest.raises(lb.ModelError, match=words):
        lb.study(maker, parameters, n, progress=lambda *done: rows.append(done), **given)
    assert not rows


def test_a_folder_is_no_file_of_a_study(tmp_path):
    with pytest.raises(lb.ModelError, match="is a folder; name a file in it"):
        lb.study(block, {"friction": (0.2, 0.6)}, 2, file=tmp_path)


@pytest.mark.parametrize("demand", ["a", None, float("nan")])
def test_a_demand_that_is_no_number_is_told(demand):
    """The load factor is the friction, .2 to .6: all are below infinity."""
    found = lb.study(block, {"friction": (0.2, 0.6)}, 2)
    assert found.probability_below(float("inf")) == 1.0
    with pytest.raises(lb.ModelError, match="expected a load factor"):
        found.probability_below(demand)
