"""The load factor at which the mechanism of a displaced structure goes on."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from limitblocks.analysis.nonassociated.fixed_point import NearestStresses
from limitblocks.analysis.nonassociated.loop import nonassociated
from limitblocks.arrays import Indices
from limitblocks.errors import NoEquilibrium, SolveError
from limitblocks.evidence.results import Nonassociated
from limitblocks.joints.queries import normal_share
from limitblocks.model import Model
from limitblocks.practice.displaced import Assembly
from limitblocks.practice.kept import solved
from limitblocks.practice.touching import across, pressed_in, touching

CRUSHED = 1.0 - 1e-6  # of the force that crushes all of a strip: its width holds the answer back


def answered(assembly: Assembly) -> tuple[Assembly, float, Model, Nonassociated, tuple[str, ...]]:
    """The answer and the joints that press across a gap: none once those are narrowed, if that is solved.

    What crushes presses on as much of the joint as its force needs: a strip that is narrower is no answer.
    """
    narrow: set[int] = set()
    found: tuple[Assembly, float, Model, Nonassociated, tuple[str, ...]] | None = None
    while True:
        model, kept = touching(assembly, narrow)
        try:
            shift, loaded, result = _answered(model)
        except SolveError:
            if found is None:
                raise
            return found
        if found is not None and _crushed(loaded, result, np.flatnonzero(np.isin(kept, list(narrow)))):
            return found
        whole = [k for k in kept if k not in narrow]
        rows = np.isin(kept, whole)
        pressed = across(assembly, result.stress_resultants[: len(kept)][rows], whole)
        marked = pressed_in(assembly, kept, result.stress_resultants[: len(kept)])
        answer = marked, shift, loaded, result, tuple(pressed.values())
        if not pressed:
            return answer
        found = found or answer
        narrow |= pressed.keys()


def _crushed(model: Model, result: Nonassociated, strips: Indices) -> bool:
    """Whether one of the strips, by their places, carries all that its area does."""
    forces = ((model.interfaces[k], float(result.stress_resultants[k, 2])) for k in strips)
    return any(normal_share(own.joint, own, N) > CRUSHED for own, N in forces)


def _answered(model: Model) -> tuple[float, Model, Nonassociated]:
    """The answer; where the dead loads alone fall, from the load factor of the least stresses."""
    try:
        return 0.0, model, solved(nonassociated, model)
    except NoEquilibrium:
        problem = model.problem
        least = NearestStresses(problem, problem.compliance)
        found = least.find(np.zeros(len(problem.compliance)), np.zeros(len(problem.g)))
        if found is None:
            raise
        shift = -found[0] / problem.units.live
        held = replace(model, dead=model.dead + (-shift) * model.live)
        return shift, held, solved(nonassociated, held)
