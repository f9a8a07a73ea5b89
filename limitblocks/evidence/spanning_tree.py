"""A tree of interfaces along which whatever a state leaves unbalanced can be carried to the supports."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse import csgraph

from limitblocks.arrays import Array, Indices
from limitblocks.problem import LimitProblem

LEAST = 1e-6  # of the largest room: interfaces with less are equally bad ways


@dataclass(frozen=True, eq=False)
class Tree:
    """Of each block (n,): the interface that leads towards a support, the block behind it, or -1."""

    interface: Indices
    parent: Indices


def spanning_tree(problem: LimitProblem, room: Array) -> Tree:
    """Return the tree of the shortest ways to a support; an interface is the longer the less room it has.

    What a block leaves unbalanced acts on every interface of its way: few of them, and none that is tight.

    Parameters
    ----------
    problem : LimitProblem
        Chains of interfaces tie every block to a support.
    room : Array, shape (m,)
        What makes an interface a good way: its distance to yield.
    """
    n = len(problem.blocks)
    stresses = np.bincount(problem.stress_interface, minlength=len(room))
    room = np.where(stresses < min(6, int(stresses.max())), 0.0, room)  # ties cannot carry any force
    most = float(room.max(initial=0.0))
    share = np.where(np.isfinite(room) & (most > 0.0), room / (most if most > 0.0 else 1.0), LEAST)
    length = 1.0 / np.clip(share, LEAST, 1.0)
    order = np.argsort(length, kind="stable")
    pairs = np.sort(np.where(problem.ends < 0, n, problem.ends), axis=1)  # all supports are one: n
    between = pairs[:, 0] * (n + 1) + pairs[:, 1]
    pair, first = np.unique(between[order], return_index=True)
    best = order[first]  # of several between two blocks
    i, j = pairs[best].T
    graph = sparse.csr_array((length[best], j, np.searchsorted(i, np.arange(n + 2))), shape=(n + 1, n + 1))
    _, ways = csgraph.dijkstra(graph, directed=False, indices=[n], return_predecessors=True)
    parent = np.asarray(ways[0, :n], dtype=np.int64)
    i, j = np.sort([np.arange(n), parent], axis=0)
    return Tree(best[np.searchsorted(pair, i * (n + 1) + j)], np.where(parent == n, -1, parent))
