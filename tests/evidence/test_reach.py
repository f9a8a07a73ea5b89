"""How far exact states may lie from computed ones: rounding errors, ways to the supports, multipliers."""

from dataclasses import replace
from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import pytest
from lintels import JOINTS, lintel
from scipy import sparse

import limitblocks as lb
from limitblocks import structures
from limitblocks.arrays import equal_rows, same_rows
from limitblocks.evidence.reach import Kinematic, Static, _in_cones
from limitblocks.evidence.rounding import Products, products, scalar_product
from limitblocks.evidence.spanning_tree import spanning_tree
from limitblocks.problem import Cones

RANDOM = np.random.default_rng(7)


def exact(row, vector):
    return sum(
        (Fraction(float(a)) * Fraction(float(b)) for a, b in zip(row, vector, strict=True)), Fraction(0)
    )


def scattered(*shape):
    """Numbers over 20 orders of magnitude, some of them zero."""
    numbers = RANDOM.normal(size=shape) * 10.0 ** RANDOM.uniform(-10, 10, size=shape)
    return np.where(RANDOM.random(shape) < 0.2, 0.0, numbers)


@pytest.mark.parametrize("kind", [sparse.csr_array, sparse.csc_array])
def test_error_of_a_product_is_bounded(kind):
    for _ in range(40):
        A, v, w = scattered(5, 17), scattered(17), scattered(5)
        value, off = Products((kind(A),)).of((v,), w)
        for k in range(5):
            error = abs(exact(A[k], v) + Fraction(w[k]) - Fraction(value[k]))
            assert error <= Fraction(off[k])
        a, b = scattered(50), scattered(50)
        total, more = scalar_product(a, b)
        assert abs(exact(a, b) - Fraction(total)) <= Fraction(more)


def test_error_of_small_matrices_is_bounded():
    A, B = scattered(8, 3, 5), scattered(8, 5, 4)
    value, off = products(A, B)
    for k, i, j in np.ndindex(value.shape):
        error = abs(exact(A[k, i], B[k, :, j]) - Fraction(value[k, i, j]))
        assert error <= Fraction(off[k, i, j])


def test_cancelling_product_is_not_called_exact():
    A = sparse.csr_array(np.array([[1e16, 1.0, -1e16]]))
    value, off = Products((A,)).of((np.ones(3),))
    assert abs(value[0] - 1.0) <= off[0]
    assert off[0] > 0.0


def test_a_product_that_underflows_is_not_called_exact():
    value, off = Products((sparse.csr_array(np.array([[1e-200]])),)).of((np.array([1e-200]),))
    assert value[0] == 0.0
    assert off[0] > 0.0


def test_product_of_nothing_is_exact():
    value, off = Products((sparse.csr_array(np.array([[1.0, 0.0]])),)).of((np.array([0.0, 3.0]),))
    assert value[0] == off[0] == 0.0


@pytest.fixture(scope="module", params=JOINTS)
def model(request):
    return lintel(request.param)


def test_tree_leads_every_block_to_a_support(model):
    p = model.problem
    tree = spanning_tree(p, RANDOM.random(len(p.interfaces)))
    for k in range(len(p.blocks)):
        assert set(p.ends[tree.interface[k]]) == {k, tree.parent[k]}
    assert (depth_of(tree) <= len(p.blocks)).all()


def depth_of(tree):
    """Number of interfaces on the way of each block; more than there are blocks on a circle."""
    depth, behind = np.ones(len(tree.parent), dtype=int), tree.parent
    for _ in depth:
        depth, behind = depth + (behind >= 0), np.where(behind >= 0, tree.parent[behind], -1)
    return depth


def ways(tree, length):
    """Length of the way of each block to the supports."""
    total = np.zeros(len(tree.parent))
    for k in np.argsort(depth_of(tree)):
        total[k] = length[tree.interface[k]] + (total[tree.parent[k]] if tree.parent[k] >= 0 else 0.0)
    return total


def test_tree_takes_short_ways_with_much_room(model):
    p = model.problem
    room = RANDOM.random(len(p.interfaces)) + 1e-3
    shortest = ways(spanning_tree(p, room), 1.0 / room)
    for _ in range(20):
        assert (shortest <= ways(spanning_tree(p, RANDOM.random(len(room))), 1.0 / room) * (1 + 1e-12)).all()


@pytest.fixture(scope="module", params=["lintel", "long way"])
def carrying(request, model):
    """A structure, and one of many steps to the supports."""
    joint = model.interfaces[0].joint
    return (
        model
        if request.param == "lintel"
        else structures.arch(joint, radius=5.0, thickness=1.0, voussoirs=27)
    )


def test_what_is_carried_to_the_supports_is_bounded(carrying):
    p = carrying.problem
    tree = spanning_tree(p, RANDOM.random(len(p.interfaces)))
    own = np.isin(p.stress_interface, tree.interface)
    C = p.C.toarray()[own]
    for _ in range(20):
        unbalanced = np.abs(scattered(len(p.blocks), 6))
        load = (unbalanced * RANDOM.uniform(-1, 1, unbalanced.shape)).ravel()
        found = Static(p, tree).carried(unbalanced)
        assert not found[~own].any()
        exact_change = along_tree(p, C, own, tree, load)
        assert (np.abs(exact_change) <= found[own] * (1 + 1e-9)).all()


def along_tree(p, C, own, tree, load):
    """Stresses on the tree of least norm at each interface that balance the load; leaves first."""
    rest, change = load.copy(), np.zeros(own.sum())
    interface = p.stress_interface[own]
    for k in np.argsort(-depth_of(tree)):
        rows = interface == tree.interface[k]
        part = np.linalg.pinv(C[rows][:, 6 * k : 6 * k + 6].T) @ rest[6 * k : 6 * k + 6]
        change[rows] = part
        rest = rest - C[rows].T @ part
    assert np.abs(rest).max() <= 1e-9 * np.abs(load).max()
    return change


def test_what_leads_over_a_joint_that_carries_nothing_is_not_bounded():
    p = structures.arch(lb.PointContact(0.6), radius=5.0, thickness=1.0, voussoirs=9).problem
    tree = spanning_tree(p, np.ones(len(p.interfaces)))
    last = int(np.flatnonzero(depth_of(tree) == 2)[0])
    broken = replace(
        p, C=sparse.csr_array(sparse.diags_array(1.0 * (p.stress_interface != tree.interface[last])) @ p.C)
    )
    behind = next(k for k in range(len(p.blocks)) if tree.parent[k] == last)
    for block, bounded in ((behind, False), (last, False), (int(tree.parent[last]), True)):
        unbalanced = np.zeros((len(p.blocks), 6))
        unbalanced[block, 2] = 1.0
        assert np.isfinite(Static(p, tree).carried(unbalanced)).all()
        assert np.isfinite(Static(broken, tree).carried(unbalanced)).all() == bounded


def test_rows_are_classed_by_their_numbers():
    rows = np.array([[0.0, 1.0], [1.0, 0.0], [0.0, 1.0], [0.0, 1.0 + 1e-13], [2.0, 0.5]])
    for within, expected in ((0.0, [0, 1, 0, 3, 4]), (1e-12, [0, 1, 0, 0, 4])):
        first, of = same_rows(rows, within)
        assert first[of].tolist() == expected


def test_rows_of_the_same_bits_are_classed():
    rows = np.array([[0.5, 1.0], [1.0, 0.5], [0.5, 1.0], [0.5, 1.0 + 2.0**-52], [0.0, 0.5], [-0.0, 0.5]])
    for few, classes in (
        (rows, [0, 1, 0, 3, 4, 5]),
        (rows[:, ::2], [0, 1, 0, 0, 4, 5]),
        (rows[:, :0], [0] * 6),
    ):
        first, of = equal_rows(few)
        assert first[of].tolist() == classes


def test_interfaces_share_an_inverse_where_their_numbers_are_the_same(model):
    """One entry by a rounding error another: the interface has an inverse of its own."""
    p = model.problem
    for factor in (1.0, 1.0 + 2.0**-52):
        F = p.F.copy()
        F.data[np.flatnonzero(F.data)[0]] *= factor
        parts = Kinematic(replace(p, F=F))._inverses
        for rows, columns, kind, _, _ in parts:
            blocks = [F[own][:, its].T.toarray() for own, its in zip(rows, columns, strict=True)]
            same = np.array([[(a == b).all() for b in blocks] for a in blocks])
            np.testing.assert_array_equal(same, kind[:, None] == kind)


def test_what_is_made_up_is_bounded(model):
    p = model.problem
    for _ in range(20):
        defect = np.abs(scattered(p.F.shape[1]))
        strain = defect * RANDOM.uniform(-1, 1, defect.shape)
        found = Kinematic(p).made_up(defect)
        needed = np.linalg.pinv(p.F.toarray().T) @ strain
        assert (np.abs(needed) <= found * (1 + 1e-9) + 1e-9 * np.abs(needed).max()).all()


def test_cones_with_one_other_row_are_judged_without_rounding():
    """Eq. (39) as a cone is (1, 1, 0) without stresses: on its boundary, as exactly as 1e-9 beside is off."""
    rows = np.array([(1.0, 1.0, 0.0), (1.0, 1.0, 1e-9), (1.0, 0.0, -1.0), (0.0, 1e-200, 0.0)])
    need, room = _in_cones(SimpleNamespace(cones=Cones(0, ((4, 3),))), rows.ravel(), np.zeros(12))
    assert (room >= need).tolist() == [True, False, True, False]


def test_one_number_alone_is_no_sum():
    """Nothing is rounded where no product comes to it; two numbers are added."""
    sums = Products((sparse.csr_array(np.eye(2)),))
    for addends, exact in (((np.ones(2),), [False, True]), ((np.ones(2), np.ones(2)), [False, False])):
        assert (sums.of((np.array([1.0, 0.0]),), *addends)[1] == 0.0).tolist() == exact
