"""Numbers of results are Python's own: what a prompt shows is the number, not the type that holds it."""

from collections.abc import Mapping
from dataclasses import fields, is_dataclass

import numpy as np
import pytest

import limitblocks as lb
from limitblocks.practice import capacity_curve, least_masses
from limitblocks.problem import State

POINTS = lb.structures.wall(lb.PointContact(0.6), length=1.6, courses=2)
LINES = lb.structures.wall(lb.OrdunaLourenco(0.6), length=1.2, courses=2)
ANALYSES = (lb.stability, lb.bounds, lb.nonassociated, lb.load_path)


def arrays_own(value, name=""):
    """Names of NumPy's scalars among the fields and properties of a result, in whatever they hold."""
    if isinstance(value, np.generic):
        return {name}
    if isinstance(value, Mapping):
        return set().union(*(arrays_own(one, name) for one in [*value, *value.values()]))
    if isinstance(value, (list, tuple)):
        return set().union(*(arrays_own(one, name) for one in value))
    kind = type(value)
    if not is_dataclass(kind) or kind is State or not kind.__module__.startswith("limitblocks"):
        return set()
    read = {field.name: getattr(value, field.name) for field in fields(value)}
    given = {
        w: getattr(value, w) for w in dir(kind) if isinstance(getattr(kind, w), property) and w[0] != "_"
    }
    read |= {word: one for word, one in given.items() if not is_dataclass(one)}  # it may lead back here
    return set().union(*(arrays_own(one, f"{kind.__name__}.{word}") for word, one in read.items()))


@pytest.mark.parametrize("model", [POINTS, LINES], ids=["points", "lines"])
def test_results(model):
    told = []
    results = [analyse(model) for analyse in ANALYSES]
    results += [lb.load_factor_range(model, paths=1, mechanisms=2, progress=told.append)]
    results += [lb.check_mcp(model, results[2]), lb.interface_states(model, results[2])]
    assert told
    for result in [*results, *told]:
        assert arrays_own(result) == set()


def test_an_array_s_own_scalar_is_seen():
    told = lb.results.Iteration(1.0, "path", np.float64(0.5), {"theta": np.float64(0.5)}, 0, 0)
    assert arrays_own([told]) == {"Iteration.step_size", "Iteration.residuals"}


def test_a_prompt_shows_the_load_factor():
    found = lb.bounds(POINTS)
    assert "np." not in repr((found.lower, found.upper, found.load_factor, found.gap))


@pytest.mark.parametrize(
    ("said", "ask"),
    [
        ("start is (1.0, nan)", lambda x: lb.loads.line_load((0, 0, -1e3), (x(1), x(np.nan)), (2, 0))),
        ("weight is -1.0", lambda x: lb.loads.added_mass("wall", (0, 0, 1), weight=x(-1))),
        ("friction is -1.0", lambda x: lb.PointContact(x(-1))),
        ("compressive strength is -1.0 Pa", lambda x: lb.OrdunaLourenco(0.6, compressive_strength=x(-1))),
        ("angle is 30.0", lambda x: lb.loads.tilting((1, 0, 0)).at(x(30))),
        ("largest is 0.0", lambda x: capacity_curve(POINTS, largest=x(0))),
        ("control is (0.0, 1.0)", lambda x: capacity_curve(POINTS, control=(x(0), x(1)))),
        ("places are (0.0, 1.0)", lambda x: least_masses(POINTS, (x(0), x(1)), 0.5)),
    ],
)
def test_an_error_shows_the_number_that_was_given(said, ask):
    with pytest.raises(lb.ModelError) as caught:
        ask(np.float64)
    assert said in str(caught.value)
