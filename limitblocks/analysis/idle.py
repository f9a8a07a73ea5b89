"""Blocks on which nothing acts, and which a single joint ties to the others."""

from __future__ import annotations

import numpy as np

from limitblocks.errors import ModelError, few
from limitblocks.problem import LimitProblem


def refuse_idle(problem: LimitProblem) -> None:
    """Raise ModelError where blocks without loads lean on others by one joint: it carries nothing.

    Without strength of its own that joint has no stresses strictly within yield, and rounding is all there
    is to measure such blocks by.
    """
    names = idle(problem)
    if names:
        raise ModelError(
            f"nothing acts on {few(names)}, and one joint is all that ties each, or what leans on it, to the "
            "rest: give a unit weight, or leave out such blocks, which changes no load factor"
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
