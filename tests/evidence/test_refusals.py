"""What is no claim at all is refused with a sentence: wrong kinds, shapes, numbers and owners."""

import warnings
from dataclasses import replace

import numpy as np
import pytest
from attacks import ATTACKS
from true_claims import state_of, true

import limitblocks as lb
from limitblocks.evidence.claim import ARRAYS

NUMBERS = ("load_factor", "dilatancy")
WRONG = {
    "text": "x",
    "bytes": b"x",
    "yes": True,
    "complex": 1.0 + 0.0j,
    "date": np.datetime64("2025-01-01"),
    "dictionary": {},
    "set": {1.0},
    "object": object(),
    "generator": (k for k in range(3)),
    "whole number beyond floats": 10**400,
    "masked": np.ma.masked,
    "ragged": [[1.0], [1.0, 2.0]],
    "list": [1.0],
    "empty": [[[]]],
    "nan": np.nan,
}


def whole():
    """A true claim that has everything."""
    model, claim = true("points")
    return model, replace(claim, dead_load_stresses=lb.bounds(model).dead_load_stresses)


@pytest.mark.parametrize("kind", WRONG)
@pytest.mark.parametrize("field", [*ARRAYS, *NUMBERS])
def test_what_is_no_number_is_refused_by_its_name(field, kind):
    model, claim = whole()
    with pytest.raises(lb.ModelError, match=field):
        lb.check_mcp(model, replace(claim, **{field: WRONG[kind]}))


@pytest.mark.parametrize(
    ("kind", "sentence"),
    [
        ("nan", r"0\] is nan, expected finite"),
        ("inf", r"0\] is inf, expected finite"),
        ("-inf", r"0\] is -inf, expected finite"),
        ("complex", "holds complex128, expected real"),
        ("bool", "holds bool, expected real"),
        ("str", "holds <U.*, expected real"),
        ("object", "holds object, expected real"),
        ("masked", "holds masked values, expected real"),
        ("long", r"0\] is inf, expected finite"),
    ],
)
@pytest.mark.parametrize("field", ARRAYS)
def test_one_wrong_number_in_an_array_is_refused(field, kind, sentence):
    model, claim = whole()
    array = np.array(getattr(claim, field))
    first = (0,) * array.ndim
    if kind == "masked":
        array = np.ma.masked_array(array, mask=array > 0.0)
    elif kind == "long":
        array = array.astype(np.longdouble)
        array[first] = np.longdouble("1e4000")
    elif kind in ("nan", "inf", "-inf"):
        array[first] = float(kind)
    else:
        array = array.astype(kind)
    with pytest.raises(lb.ModelError, match=f"{field}.*{sentence}"):
        lb.check_mcp(model, replace(claim, **{field: array}))


@pytest.mark.parametrize("field", ARRAYS)
@pytest.mark.parametrize(
    "shape", [lambda a: a[None], lambda a: a[..., None], lambda a: a[:-1], lambda a: a[:0]]
)
def test_a_wrong_shape_is_refused(field, shape):
    model, claim = whole()
    with pytest.raises(lb.ModelError, match=f"{field} has shape .*, expected "):
        lb.check_mcp(model, replace(claim, **{field: shape(getattr(claim, field))}))


@pytest.mark.parametrize("field", [*ARRAYS, "load_factor"])
def test_numbers_near_the_end_of_floats_count_as_infinite_without_a_warning(field):
    model, claim = true("sliding, circle")
    claim = replace(claim, dead_load_stresses=claim.generalised_stresses)
    huge = np.array(getattr(claim, field), dtype=float)
    huge[(-1,) * huge.ndim] = 1e308
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            assert not lb.check_mcp(model, replace(claim, **{field: huge[()]})).passed
        except lb.ModelError as error:
            assert "differ" in str(error)  # noqa: PT017 # the two kinds of stresses


@pytest.mark.parametrize(
    ("tolerance", "sentence"),
    [
        (np.nan, "is nan, expected a real"),
        (np.inf, "is inf, expected a finite"),
        (0, "is 0, expected a number above 0, such as 1e-08"),
        (-1e-8, "is -1e-08, expected a number above 0"),
        ("1e-8", "holds <U4, expected real"),
        (True, "holds bool, expected real"),
        (np.bool_(True), "holds bool, expected real"),
        (1e-8 + 0j, "holds complex128, expected real"),
        (np.complex128(1e-8), "holds complex128, expected real"),
        ([1e-8], r"is \[1e-08\], expected a real"),
        (10**400, "holds object, expected real"),
    ],
)
def test_a_tolerance_that_measures_nothing_is_refused(tolerance, sentence):
    with pytest.raises(lb.ModelError, match=f"tolerance {sentence}"):
        lb.check_mcp(*true("sliding, circle"), tolerance=tolerance)


@pytest.mark.parametrize("tolerance", [1e-8, np.float32(1e-6), np.array(1e-8), 1])
def test_any_positive_number_is_a_tolerance(tolerance):
    assert lb.check_mcp(*true("sliding, circle"), tolerance=tolerance).tolerance == float(tolerance)


@pytest.mark.parametrize(
    "thing",
    [None, 1, "claim", {}, np.zeros(6), lb.bounds, lb.results.Claim],
    ids=lambda thing: type(thing).__name__,
)
def test_what_is_no_result_is_refused(thing):
    model, _ = true("sliding, circle")
    with pytest.raises(lb.ModelError, match="has no load_factor and no stress_resultants; expected a Claim"):
        lb.check_mcp(model, thing)


@pytest.mark.parametrize("thing", [None, "model", 1])
def test_what_is_no_model_is_refused(thing):
    with pytest.raises(lb.ModelError, match="expected a Model"):
        lb.check_mcp(thing, true("sliding, circle")[1])
    model, claim = true("sliding, circle")
    with pytest.raises(lb.ModelError, match="model is a Claim, expected a Model"):
        lb.check_mcp(claim, model)


@pytest.mark.parametrize("result", ["bounds", "nonassociated", "load_path"])
def test_a_result_of_another_model_is_refused_and_of_its_own_passes(result):
    model, other = (
        lb.structures.block(lb.OrdunaLourenco(mu), width=2.0, height=1.0) for mu in (0.3, 0.3 + 1e-9)
    )
    found = getattr(lb, result)(model)
    assert lb.check_mcp(model, found).passed
    with pytest.raises(lb.ModelError, match=f"belongs to model {model.digest[:12]}, not to this"):
        lb.check_mcp(other, found)


def test_a_claim_with_the_digest_of_another_model_is_refused():
    model, claim = true("sliding, circle")
    with pytest.raises(lb.ModelError, match="belongs to model"):
        lb.check_mcp(model, replace(claim, digest=true("sliding, octagon")[0].digest))


@pytest.mark.parametrize("turning", ["table 5", "", None, 0, [], "CENTROID"])
def test_an_unknown_turning_is_refused(turning):
    model, claim = true("sliding, circle")
    with pytest.raises(lb.ModelError, match=r"turning is .*, expected 'centroid' or 'centre of pressure'"):
        lb.check_mcp(model, replace(claim, turning=turning))


def test_a_dilatancy_below_zero_is_refused():
    model, claim = true("sliding, circle")
    with pytest.raises(lb.ModelError, match=r"dilatancy is -0\.1, expected 0 or more"):
        lb.check_mcp(model, replace(claim, dilatancy=-0.1))


@pytest.mark.parametrize("rate", [1e-300, -1.0])
def test_supports_that_move_are_refused(rate):
    model, claim = true("scales")
    rates = claim.displacement_rates.copy()
    rates[0, 4] = rate
    with pytest.raises(lb.ModelError, match="displacement rates move the support 'floor', expected zero"):
        lb.check_mcp(model, replace(claim, displacement_rates=rates))


def test_stress_resultants_that_are_not_those_of_the_points_are_refused():
    model, claim = true("points")
    Q = claim.stress_resultants.copy()
    Q[0, 2] *= 1 + 1e-6
    with pytest.raises(lb.ModelError, match="generalised stresses and stress resultants differ by"):
        lb.check_mcp(model, replace(claim, stress_resultants=Q))
    with pytest.raises(lb.ModelError, match="inner forces"):
        lb.check_mcp(model, replace(claim, generalised_stresses=None))


def test_a_load_factor_alone_is_no_claim():
    model, claim = true("sliding, circle")
    with pytest.raises(lb.ModelError, match="stress_resultants are missing"):
        lb.check_mcp(model, replace(claim, stress_resultants=None))


@pytest.mark.parametrize("name", [name for name, attack in ATTACKS.items() if "equilibrium" in attack.names])
def test_a_searched_mechanism_mends_no_stresses(name):
    """The checker's own search finds the best mechanism, and the stresses stay false."""
    model, claim = ATTACKS[name].make()
    searched = replace(claim, displacement_rates=None, flow_multipliers=None)
    assert "equilibrium" in {entry.name for entry in lb.check_mcp(model, searched).residuals.above(1e-8)}


def test_the_state_of_a_claim_is_what_it_was_made_of():
    """The helpers of these tests go there and back."""
    model, claim = true("wall")
    state = state_of(model, claim)
    si = model.problem.in_si(state)
    np.testing.assert_allclose(si.x, claim.generalised_stresses, rtol=1e-15)
    assert si.load_factor == pytest.approx(claim.load_factor, rel=1e-15)


def test_bounds_without_any_dead_load():
    """What acts on nothing is measured by its own unit: rounding of it is no imbalance."""
    model, claim = true("glued")
    assert lb.bounds(model).lower == pytest.approx(claim.load_factor, rel=1e-9)
