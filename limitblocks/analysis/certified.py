"""From approximate static and kinematic solutions to proven ones: a little of a strictly admissible state.

A convex combination of a state at yield with one strictly within yield has room for the errors of both:
stresses with those of the dead loads of largest margin, a mechanism with one that opens every joint.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from limitblocks.analysis.in_plane import in_plane
from limitblocks.analysis.interior import carrying
from limitblocks.analysis.polish import polish
from limitblocks.analysis.programs import remeasured
from limitblocks.analysis.repair import PlanarRepair, Repair
from limitblocks.analysis.scales import scaled
from limitblocks.analysis.splitting import Splitting
from limitblocks.arrays import Array
from limitblocks.evidence.proof import Proof, Prover, acting_at
from limitblocks.evidence.reach import Reach
from limitblocks.evidence.rounding import EPS
from limitblocks.problem import ASSOCIATED, Flow, LimitProblem, State
from limitblocks.problem.plane import Planar

CLOSE = 1e-8  # width of an interval that needs no polish of states from elsewhere
MOST = 0.1  # of the strictly admissible state
ROUNDS = 7  # of taking MORE of it, where the estimate of the least part was short
MORE = 2.0
LEAST = 1e-15
RESERVE = 2.0  # times the room that the proof needs here, for machines that sum in another order
NEEDED = 1.5 * RESERVE  # times what the state itself needs: the inner one has errors, too
SPARE = 3e-10  # of the load factor: about what it costs to open all joints alike
POLISHED = 1e-12  # residual of a state that no further polish betters


def certified(
    problem: LimitProblem,
    state: State,
    dead: Array,
    *,
    close: float = CLOSE,
    patience: int | None = None,
    splitting: Splitting | None = None,
    whole: bool = False,
) -> tuple[State, Proof]:
    """Return static and kinematic solutions near those of `state` that prove their bounds.

    Where they leave more than `close` between them, those of the polished state are taken if closer. A side
    for which no proof succeeds comes back as it was, and the proof says so.

    Parameters
    ----------
    problem : LimitProblem
        The model's, ``model.problem``.
    state : State
        A pair of bounds, dimensionless.
    dead : Array, shape (s,)
        Stresses strictly within yield that carry the dead loads, dimensionless.
    close : float
        Width of an interval that needs no polish.
    patience : int, optional
        Of the polish. Left out: it is thorough.
    splitting : Splitting, optional
        Of the problem, reduced by its mirror if it has one, where it is at hand.
    whole : bool
        Whether to make no use of a mirror.
    """
    plane = None if whole else in_plane(problem)
    reduced, own = (problem, dead) if plane is None else (plane.problem, plane.stresses_of(dead))
    repair = Repair(splitting or Splitting(scaled(reduced)), carrying(reduced, own))
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        mixture = _Mixture(
            problem,
            repair if plane is None else PlanarRepair(problem, plane, repair),
            dead,
            acting_at(problem, state),
        )
        found, proof = mixture.proven(state)
        if proof.width > close:
            closer, better = mixture.proven(_polished(problem, plane, state, patience))
            found, proof = (closer, better) if better.width < proof.width else (found, proof)
    return found, proof


@dataclass(frozen=True, eq=False)
class _Mixture:
    """States mixed with a little of strictly admissible ones; `acting` (m,) as in `acting_at`."""

    own: LimitProblem
    repair: Repair | PlanarRepair
    dead: Array
    acting: Array
    opened: list[tuple[Array, Array]] = field(default_factory=list)  # the mechanism, once it is found

    def proven(self, state: State) -> tuple[State, Proof]:
        """Both sides proven with the least part of strict states; as they were where none does."""
        x = self.repair.balanced(state.load_factor, state.x)
        static, prover = self._static_part(state.load_factor, x), self.prover
        kinematic, u, y, v, z = self._kinematic_part(state, self._spare(state.load_factor, x))
        lower, upper, again = (-np.inf, ""), (np.inf, ""), (True, True)
        for _ in range(ROUNDS):
            a, mixed = state.load_factor, state
            if static <= MOST:
                mixed = replace(mixed, load_factor=(1.0 - static) * a, x=x + static * (self.inner - x))
            if kinematic <= MOST:
                work = 1.0 + kinematic * float(self.own.live @ v)  # of the live load, Eq. (55)
                mixed = replace(mixed, u=(u + kinematic * v) / work, y=(y + kinematic * z) / work)
            prover = prover.at(mixed)  # as whoever checks the state makes it
            lower = prover.lower(mixed, RESERVE) if again[0] else lower
            upper = prover.upper(mixed, RESERVE) if again[1] else upper
            again = (bool(lower[1]) and static <= MOST, bool(upper[1]) and kinematic <= MOST)
            if not any(again):
                break
            static = max(MORE * static, LEAST) if again[0] else static
            kinematic = max(MORE * kinematic, LEAST) if again[1] else kinematic
        return mixed, Proof(lower[0], upper[0], lower[1], upper[1])

    @cached_property
    def inner(self) -> Array:
        """The stresses strictly within yield, in equilibrium with the dead loads to rounding."""
        return self.repair.balanced(0.0, self.dead)

    @cached_property
    def prover(self) -> Prover:
        return Prover(self.own, self.dead, self.acting)

    def _static_part(self, load_factor: float, x: Array) -> float:
        """Least part of the inner stresses that pays for what x needs; infinite where they have no room."""
        reach = self.prover.static.reach(load_factor, x)
        return _part(_lack(reach), self.prover.margin - reach.room)

    def _spare(self, load_factor: float, x: Array) -> Array:
        """Opening of every joint, the like of which is found in few rounds, that costs next to no width.

        By virtual work multipliers z cost (F x + g).z beyond the load factor, x being the stresses. It is
        the less the more acts on the joint.
        """
        p = self.own
        less = 1.0 / self.acting[p.member_interface]
        cost = float((p.F @ x + p.g)[p.cones.heads] @ less)
        size = max(abs(load_factor), EPS)
        return SPARE * (size / cost if cost > size else 1.0) * less

    def _kinematic_part(self, state: State, spare: Array) -> tuple[float, Array, Array, Array, Array]:
        """Part, rates and multipliers of a mechanism that opens joints by what those of the state lack.

        It opens none by less than `spare`. Before it come the part, infinite where there is no such
        mechanism, and the state's own rates and multipliers: what does not move in it stays, exactly.
        """
        p, u, y = self.own, state.u, self.repair.following(state.u, state.y)
        lack = _lack(self.prover.kinematic.reach(u, y))
        if not self.opened:
            amount = np.zeros(p.F.shape[0])
            amount[p.cones.heads] = np.maximum(lack, spare)
            self.opened.append(self.repair.opened(amount))
        v, z = self.opened[0]
        moving = np.repeat(v.reshape(-1, 6).any(axis=1), 6)
        if not moving.all():
            opens = np.bincount(p.row_interface, z != 0.0, len(p.interfaces)) > 0
            u, y = u * moving, self.repair.following(u * moving, y * opens[p.row_interface])
            lack = _lack(self.prover.kinematic.reach(u, y))
        return _part(lack, p.cones.margin(z)), u, y, v, z


def _lack(reach: Reach) -> Array:
    """What each linear row and each cone lacks of the room that is needed."""
    lack = np.maximum(NEEDED * reach.need - reach.room, 0.0)
    return np.where(np.isnan(lack), np.inf, lack)


def _part(lack: Array, gain: Array) -> float:
    """Least part of a state with that `gain` that makes up for all that is lacking; infinite if none does."""
    lack, gain = lack[lack > 0.0], gain[lack > 0.0]
    return float(np.where(gain > 0.0, lack / gain, np.inf).max(initial=0.0))


def _polished(
    problem: LimitProblem, plane: Planar | None, given: State, patience: int | None = None
) -> State:
    """The state polished in units of what acts in it, reduced by the mirror if there is one."""
    own = remeasured(problem, given) or problem
    state = own.dimensionless(problem.in_si(given))
    if plane is None:
        state = polish(Flow(own, ASSOCIATED), state, until=POLISHED, patience=patience)
    else:
        plane = plane.measured(own)
        flow = Flow(plane.problem, ASSOCIATED)
        state = plane.lifted(polish(flow, plane.averaged(state), until=POLISHED, patience=patience))
    return problem.dimensionless(own.in_si(state))
