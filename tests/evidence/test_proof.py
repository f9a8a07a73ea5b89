"""Bounds as theorems: rounding errors bounded, exact states near computed ones, falsified claims refused."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from scipy import sparse

import limitblocks as lb
from limitblocks import structures
from limitblocks.analysis.bounds import bounds
from limitblocks.analysis.certified import certified
from limitblocks.evidence.proof import proof_of, room_of
from limitblocks.evidence.reach import carried_to_supports, kinematic_reach, made_up, static_reach
from limitblocks.evidence.rounding import product, products, scalar_product
from limitblocks.evidence.spanning_tree import spanning_tree
from limitblocks.problem import State

RANDOM = np.random.default_rng(7)
JOINTS = {
    "points": lb.PointContact(0.6),
    "torsion": lb.OrdunaLourenco(0.6),
    "octagon": lb.OrdunaLourenco(0.6, slip="paper"),
    "crushing": lb.OrdunaLourenco(0.6, compressive_strength=3e6),
}


def exact(row, vector):
    return sum((Fraction(float(a)) * Fraction(float(b)) for a, b in zip(row, vector, strict=True)), Fraction(0))


def scattered(*shape):
    """Numbers over 20 orders of magnitude, some of them zero."""
    numbers = RANDOM.normal(size=shape) * 10.0 ** RANDOM.uniform(-10, 10, size=shape)
    return np.where(RANDOM.random(shape) < 0.2, 0.0, numbers)


def test_error_of_a_product_is_bounded():
    for _ in range(40):
        A, v, w = scattered(5, 17), scattered(17), scattered(5)
        value, off = product(sparse.csr_array(A), v, w)
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
    value, off = product(A, np.ones(3))
    assert abs(value[0] - 1.0) <= off[0] and off[0] > 0.0


def test_product_of_nothing_is_exact():
    value, off = product(sparse.csr_array(np.array([[1.0, 0.0]])), np.array([0.0, 3.0]))
    assert value[0] == off[0] == 0.0


@pytest.fixture(scope="module", params=JOINTS)
def model(request):
    return structures.eccentric_lintel(JOINTS[request.param], eccentricity=0.1, direction=(1, 0, 0))


def test_tree_leads_every_block_to_a_support(model):
    p = model.problem
    tree = spanning_tree(p, RANDOM.random(len(p.interfaces)))
    for k in range(len(p.blocks)):
        assert set(p.ends[tree.interface[k]]) == {k, tree.parent[k]}
        behind = tree.parent[k]
        assert tree.depth[k] == 1 + (tree.depth[behind] if behind >= 0 else 0)


def test_tree_takes_the_way_with_most_room():
    base, lower, upper = (structures.box(name, (0, 0, z), (1, 1, z + 1)) for name, z in
                          (("base", 0.0), ("lower", 1.0), ("upper", 2.0)))
    wall = structures.box("wall", (1, 0, 0), (2, 1, 3))
    found = lb.find_interfaces([base, lower, upper, wall], lb.PointContact(0.6))
    model = lb.Model([base, lower, upper, wall], ["base", "wall"], found, lb.self_weight(),
                     lb.mass_proportional((1, 0, 0)))
    p = model.problem
    beside = np.array(["wall" in name for name in p.interfaces])
    assert (spanning_tree(p, 1.0 * beside).depth == 1).all()
    assert sorted(spanning_tree(p, 1.0 * ~beside).depth) == [1, 2]


def test_what_is_carried_to_the_supports_is_bounded(model):
    p = model.problem
    tree = spanning_tree(p, RANDOM.random(len(p.interfaces)))
    own = np.isin(p.stress_interface, tree.interface)
    C = p.C.toarray()[own]
    for _ in range(20):
        unbalanced = np.abs(scattered(len(p.blocks), 6))
        load = (unbalanced * RANDOM.uniform(-1, 1, unbalanced.shape)).ravel()
        found = carried_to_supports(p, unbalanced, tree)
        assert not found[~own].any()
        sides = np.zeros((len(load), 0))
        del sides
        # interface by interface the stresses of least norm: the only ones where there are six
        exact_change = along_tree(p, C, own, tree, load)
        assert (np.abs(exact_change) <= found[own] * (1 + 1e-9)).all()


def along_tree(p, C, own, tree, load):
    """Stresses on the tree of least norm at each interface that balance the load; leaves first."""
    rest, change = load.copy(), np.zeros(own.sum())
    interface = p.stress_interface[own]
    for k in np.argsort(-tree.depth):
        rows = interface == tree.interface[k]
        part = np.linalg.pinv(C[rows][:, 6 * k : 6 * k + 6].T) @ rest[6 * k : 6 * k + 6]
        change[rows] = part
        rest = rest - C[rows].T @ part
    assert np.abs(rest).max() <= 1e-9 * np.abs(load).max()
    return change


def test_what_is_made_up_is_bounded(model):
    p = model.problem
    for _ in range(20):
        defect = np.abs(scattered(p.F.shape[1]))
        strain = defect * RANDOM.uniform(-1, 1, defect.shape)
        found = made_up(p, defect)
        needed = np.linalg.pinv(p.F.toarray().T) @ strain
        assert (np.abs(needed) <= found * (1 + 1e-9) + 1e-9 * np.abs(needed).max()).all()
