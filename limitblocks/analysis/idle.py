"""Blocks on which nothing acts, and which a single joint ties to the others."""

from __future__ import annotations

import numpy as np

from limitblocks.errors import few
from limitblocks.problem import LimitProblem


def idle_words(problem: LimitProblem) -> tuple[str, ...]:
    """Return what helps where an analysis failed on blocks that carry nothing; empty without such blocks.

    Equilibrium leaves their joints no stresses: without strength of their own none is strictly within yield.
    """
    names = idle(problem)
    if not names:
        return ()
    return (
        f"nothing acts on {few(names)}, and one joint is all that ties each, or what leans on it, to the "
        "rest: give a unit weight, or leave out such blocks, which changes no load factor",
    )


def idle(problem: LimitProblem) -> tuple[str, ...]:
    """Return the blocks without loads that one joint ties to the rest, or to such blocks and one joint."""
    n = len(problem.blocks)
    ends = np.where(problem.ends >= 0, problem.ends, n)
    loaded = (problem.dead.reshape(-1, 6).any(axis=1)) | (problem.live.reshape(-1, 6).any(axis=1))
    left, found = np.ones(len(ends), dtype=bool), np.zeros(n + 1, dtype=bool)
    while True:  # the outermost first
        outer = np.append(~loaded, False) & (np.bincount(ends[left].ravel(), minlength=n + 1) == 1)
        if not outer.any():
            return tuple(np.array(problem.blocks)[found[:n]].tolist())
        found |= outer
        left &= ~outer[ends].any(axis=1)
