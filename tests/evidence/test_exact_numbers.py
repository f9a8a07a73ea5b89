"""What proofs claim in floating point, against the same in rational numbers, which are exact."""

from fractions import Fraction

import numpy as np
import pytest
from scipy import sparse

import limitblocks as lb
from limitblocks import structures
from limitblocks.evidence.proof import _upper
from limitblocks.evidence.reach import Kinematic, Reach, Static, _in_cones
from limitblocks.evidence.rounding import scalar_product
from limitblocks.evidence.spanning_tree import spanning_tree
from limitblocks.problem import State

RANDOM = np.random.default_rng(11)


@pytest.fixture(scope="module", params=[lb.PointContact(0.6), lb.OrdunaLourenco(0.6, cohesion=1e3)], ids=repr)
def problem(request):
    return structures.eccentric_lintel(request.param, eccentricity=0.1, direction=(1, 0, 0)).problem


def rational(values):
    return [Fraction(float(value)) for value in values]


def product(A, v):
    """A v of a sparse matrix and rational numbers, exactly."""
    total, entries = [Fraction(0)] * A.shape[0], sparse.coo_array(A)
    for row, column, value in zip(*entries.coords, entries.data, strict=True):
        total[row] += Fraction(float(value)) * v[column]
    return total


def states(problem, count=5):
    for _ in range(count):
        x, u, y = (RANDOM.normal(size=n) for n in (*problem.C.shape, len(problem.g)))
        yield State(float(RANDOM.uniform(0.1, 1.0)), x, u, y)


def test_need_of_stresses_covers_the_exact_rows(problem):
    """Each row moves by |F| times the change, and what was computed of it is off by rounding."""
    p = problem
    static = Static(p, spanning_tree(p, np.ones(len(p.interfaces))))
    for state in states(p):
        reach = static.reach(state.load_factor, state.x)
        s = product(p.F, rational(state.x))
        s = [a + b for a, b in zip(s, rational(p.g), strict=True)]
        moves = product(abs(p.F), rational(reach.change))
        assert_room_is_at_least(p, reach, s, moves)


def test_need_of_multipliers_covers_their_change(problem):
    for state in states(problem):
        reach = Kinematic(problem).reach(state.u, state.y)
        assert_room_is_at_least(problem, reach, rational(state.y), rational(reach.change))


def test_need_of_a_cone_that_moves_along_itself():
    """Where no direction spares any of the move, and where nothing moves but what is computed is rounded."""
    p = structures.block(lb.PointContact(0.6), width=1.0, height=1.0).problem
    for share in (0.0, 1e-3):
        rows = RANDOM.normal(size=len(p.g))
        moves = share * np.abs(rows)
        assert_room_is_at_least(p, Reach(*_in_cones(p, rows, moves), moves), rational(rows), rational(moves))


def assert_room_is_at_least(p, reach, rows, moves):
    """Room less need is at most s - |ds| of linear rows, and t - |dt| - |z| - |dz| of cones."""
    claimed = [a - b for a, b in zip(rational(reach.room), rational(reach.need), strict=True)]
    for k in range(p.cones.linear):
        assert claimed[k] <= rows[k] - moves[k]
    cones = np.concatenate(p.cones.groups) if p.cones.groups else []
    for left, (head, *tail) in zip(claimed[p.cones.linear :], cones, strict=True):
        size = rows[head] - moves[head] - left
        assert size >= 0
        assert sum((abs(rows[i]) + moves[i]) ** 2 for i in tail) <= size**2


def test_what_is_left_of_the_flow_is_made_up_even_where_it_rounds_to_nothing():
    """Multipliers that equal the rounded opening of their points leave less than a rounding error."""
    p = structures.eccentric_lintel(lb.PointContact(0.0), eccentricity=0.1, direction=(1, 0, 0)).problem
    for _ in range(5):
        u = RANDOM.normal(size=p.C.shape[1])
        y = -(p.C @ u) / p.F.diagonal()  # one row a point
        left = [a + b for a, b in zip(product(p.C, rational(u)), product(p.F.T, rational(y)), strict=True)]
        reach = Kinematic(p).reach(u, y)
        made_up = product(abs(p.F).T, rational(reach.change))
        assert any(left)
        assert all(abs(a) <= b for a, b in zip(left, made_up, strict=True))


def test_room_that_is_less_than_the_need_by_a_rounding_error_proves_nothing():
    assert Reach(np.ones(2), np.ones(2), np.ones(2)).proven
    assert not Reach(np.array([1.0, 1e-18]), np.array([1.0, 0.0]), np.ones(2)).proven


@pytest.mark.parametrize("across", ["nothing", "dead", "live", "nearly live"])
def test_the_upper_bound_is_at_least_the_exact_ratio(problem, across):
    """(g.y - dead.u) / (live.u) and what a change of y can add to it, also where either all but cancels."""
    p = problem
    for state in states(p, 40):
        change = np.abs(RANDOM.normal(size=len(p.g))) * RANDOM.choice([0.0, 1e-12])
        u, y = state.u, state.y * (across != "dead")
        if across != "nothing":
            load = getattr(p, across.split()[-1])
            left = 1e-12 * np.sqrt((load @ load) * (u @ u)) * ("nearly" in across)
            u = u - (load @ u - left) / (load @ load) * load
        else:
            u = u if p.live @ u > 0.0 else -u
        found = _upper(p, State(state.load_factor, state.x, u, y), Reach(change, change, change), 1.0)
        g, dead, live, rates = rational(p.g), rational(p.dead), rational(p.live), rational(u)
        most = [a * b + abs(a) * c for a, b, c in zip(g, rational(y), rational(change), strict=True)]
        power = sum(most) - sum(a * b for a, b in zip(dead, rates, strict=True))
        work = sum(a * b for a, b in zip(live, rates, strict=True))
        assert found == np.inf or (work > 0 and Fraction(found) >= power / work)


@pytest.mark.parametrize("n", [1, 10, 1000])
def test_rounding_of_a_scalar_product_is_bounded_in_any_order_of_the_sum(n):
    """Higham (2002), Eq. (3.5): n u / (1 - n u) times the sum of the sizes of the products."""
    u, (a, b) = 2.0**-53, np.random.default_rng(n).normal(size=(2, n))
    assert scalar_product(a, b)[1] >= n * u / (1 - n * u) * (np.abs(a) @ np.abs(b))
