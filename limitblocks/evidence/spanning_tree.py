"""A tree of interfaces along which whatever a state leaves unbalanced can be carried to the supports."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse import csgraph

from limitblocks.arrays import Array, Indices
from limitblocks.problem import LimitProblem


@dataclass(frozen=True, eq=False)
class Tree:
    """Of each block (n,): the interface that leads towards a support, the block behind it, its depth.

    `parent` is -1 where a support is behind the interface; `depth` counts the interfaces on the way.
    """

    interface: Indices
    parent: Indices
    depth: Indices


def spanning_tree(problem: LimitProblem, room: Array) -> Tree:
    """Return the tree of the interfaces with most room that ties every block to a support.

    Parameters
    ----------
    problem : LimitProblem
        Chains of interfaces tie every block to a support.
    room : Array, shape (m,)
        What makes an interface a good way: its distance to yield.
    """
    n = len(problem.blocks)
    order = np.argsort(-room, kind="stable")
    pairs = np.sort(np.where(problem.ends < 0, n, problem.ends), axis=1)  # all supports are one: n
    best = order[np.unique(pairs[order], axis=0, return_index=True)[1]]  # of several between two blocks
    rank = np.empty(len(room))
    rank[order] = np.arange(1.0, len(room) + 1.0)
    i, j = pairs[best].T.astype(np.int32)  # scipy before 1.15 has no trees of graphs of longer indices
    graph = sparse.coo_array((rank[best], (i, j)), shape=(n + 1, n + 1)).tocsr()
    sequence, before = csgraph.breadth_first_order(csgraph.minimum_spanning_tree(graph), n, directed=False)
    depth = np.zeros(n + 1, dtype=np.int64)
    for k in sequence[1:]:
        depth[k] = depth[before[k]] + 1
    interface = sparse.coo_array((best + 1, (i, j)), shape=(n + 1, n + 1)).tocsr()
    parent = np.asarray(before[:n], dtype=np.int64)
    of_block = np.asarray(sparse.csr_array(interface + interface.T)[np.arange(n), parent]).ravel() - 1
    return Tree(of_block, np.where(parent == n, -1, parent), depth[:n])
