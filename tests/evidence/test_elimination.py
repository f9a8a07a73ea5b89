"""Unknowns are eliminated interface by interface, which keeps factors as sparse as a search for an order."""

import numpy as np
import pytest
from scipy import sparse

import limitblocks as lb
from limitblocks.evidence.elimination import Entries, Factors, elimination, factors_in_order, numbered, placed
from limitblocks.evidence.factors import diagonal_factors


def random(rows, columns, seed=0):
    return sparse.random_array((rows, columns), density=0.3, format="csr", rng=np.random.default_rng(seed))


def test_blocks_stand_where_they_begin_and_add_up():
    a, b = random(3, 4), random(4, 3, 1)
    made = (
        placed([(Entries.of(a), 0, 3), (-Entries.of(a).T, 3, 0), (Entries.of(b), 3, 0)]).square(7).toarray()
    )
    expected = np.zeros((7, 7))
    expected[:3, 3:], expected[3:, :3] = a.toarray(), b.toarray() - a.toarray().T
    np.testing.assert_array_equal(made, expected)


def test_entries_times_a_matrix_are_those_of_the_product():
    a, b = random(5, 6), random(6, 4, 1)
    product = Entries.of(a).times(b)
    found = sparse.coo_array((product.data, (product.row, product.column)), (5, 4)).toarray()
    np.testing.assert_allclose(found, a.toarray() @ b.toarray(), atol=1e-15)


@pytest.mark.parametrize("columns", [(), (3,)])
def test_factors_solve_in_whatever_order(columns):
    K = sparse.csr_array(random(8, 8) + 8.0 * sparse.eye_array(8))
    x = np.random.default_rng(2).normal(size=(8, *columns))
    order = np.random.default_rng(3).permutation(8)
    np.testing.assert_allclose(factors_in_order(Entries.of(K), order).solve(K @ x), x, atol=1e-14)
    assert (numbered(order)[order] == np.arange(8)).all()


def test_unknowns_left_out_are_zero():
    order = np.array([3, 1])
    factors = Factors(diagonal_factors(2.0 * sparse.eye_array(2)), order)
    np.testing.assert_array_equal(factors.solve(np.array([1.0, 2.0, 3.0, 4.0])), [0.0, 1.0, 0.0, 2.0])


@pytest.mark.parametrize("joint", [lb.OrdunaLourenco(0.6), lb.PointContact(0.6)], ids=repr)
def test_factors_are_as_sparse_as_in_an_order_that_is_searched_for(joint):
    """With the rates first they have several times the entries."""
    p = lb.structures.wall(joint, length=2.4, courses=6).problem
    n, a = p.C.shape[0], p.C.shape[0] + p.C.shape[1]
    C, live = Entries.of(p.C), Entries.of(sparse.csr_array(p.live[:, None]))
    size, F = a + 1 + len(p.g), Entries.of(p.F)
    blocks = [(C, 0, n), (C.T, n, 0), (live, n, a), (live.T, a, n), (F, a + 1, 0), (F.T, 0, a + 1)]
    K = sparse.csr_array(placed(blocks).square(size) + 1e3 * sparse.eye_array(size))
    order = elimination(p, p.row_interface)
    rates_first = np.concatenate([order[-(a + 1 - n) :], order[: -(a + 1 - n)]])
    searched, own, other = (
        factors.nnz
        for factors in (
            diagonal_factors(K),
            *(factors_in_order(Entries.of(K), one).factors for one in (order, rates_first)),
        )
    )
    assert own <= 1.1 * searched
    assert other >= 3.0 * own


@pytest.mark.parametrize("entry", [np.nan, np.inf, 1e300])
def test_a_matrix_whose_factors_overflow_is_refused(entry):
    """Of a polish far from collapse: SuperLU read beyond its arrays, and ended the process."""
    K = sparse.csc_array(np.array([[1.0, entry], [-entry, 1.0]]))
    with pytest.raises(np.linalg.LinAlgError, match="ran away"):
        diagonal_factors(K)
