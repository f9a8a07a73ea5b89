"""A displaced structure that no load factor holds: it snaps until contacts close, the live load at rest."""

from __future__ import annotations

import numpy as np
from scipy import sparse

from limitblocks.arrays import Array
from limitblocks.errors import SolveError
from limitblocks.evidence.mechanism import PRECISE, linear_program
from limitblocks.joints import Dowel, Guide
from limitblocks.mechanics.loads.load import resultant
from limitblocks.practice.advance import Advanced, advanced, carried, moved_until_contact
from limitblocks.practice.capacity_result import Control
from limitblocks.practice.contact import bond
from limitblocks.practice.displaced import Assembly
from limitblocks.practice.rejoined import rows_of

TURN = 0.05  # the largest displacement of a round over the size of its block
ROUNDS = 100  # of linear programs, each from where the last one led
FALLS = 1e-6  # power of the dead loads over that of all of them through the largest displacement: none below
# presolve ends programs of opened joints, whose rows are nearly dependent, with Status 4 or at no optimum
TIGHT = PRECISE | {"presolve": False}


class NoRest(SolveError):
    """Where a structure that snaps comes to rest was not found: a shorter step finds no more."""


def held(assembly: Assembly, control: Control, rates: Array, step: float, accuracy: float) -> Advanced | None:
    """Return the structure one step on (m, of the control point), or as far as a load factor holds it.

    That is found within `accuracy`, m; beyond it the structure is where it snaps to. None if it is stuck.
    """

    def ahead(way: float) -> tuple[Advanced | None, bool]:
        there = advanced(assembly, control, rates, way)
        return there, there is not None and falls(there.assembly)

    there, fallen = ahead(step)
    low, high, last, way = 0.0, step, None, accuracy
    while fallen and high - low > accuracy:
        one, beyond = ahead(way)
        there, high = (one, way) if beyond else (there, high)
        last, low = (last, low) if beyond else (one, way)
        way = (low + high) / 2.0
    if last is not None or there is None or not fallen:
        return last or there
    rest, changes = snapped(there.assembly)
    moved_on = carried(there.assembly, rest, there.control)
    return Advanced(rest, moved_on, there.changes + changes, snapped=True)


def falls(assembly: Assembly) -> bool:
    """Whether no load factor holds the structure by forces where its contacts are closed.

    By Farkas' lemma there is then a motion in which the live load does no work, the dead loads do, and no
    corner penetrates, no contact slides that was pressed and no tie gets longer. It knows no bonds: what a
    tie, a dowel or a glued joint may hold is never said to fall.
    """
    # more than compression, its friction and the tension of a tie
    holds = (bond(own.joint) or isinstance(own.joint, Dowel | Guide) for own in assembly.contacts.interfaces)
    return not any(holds) and steepest(assembly)[1] > FALLS


def snapped(assembly: Assembly) -> tuple[Assembly, tuple[str, ...]]:
    """Return where a structure that falls comes to rest, and the contacts that opened and closed.

    Each round goes along the steepest fall until a contact closes: a chain under compression is unstable,
    so that it is held only where there are no more hinges than a mechanism needs.

    Raises
    ------
    NoRest
        If it does not come to rest.
    """
    changes: tuple[str, ...] = ()
    for _ in range(ROUNDS):
        step, power = steepest(assembly)
        if power <= FALLS:
            return assembly, changes
        found = moved_until_contact(assembly, step)
        if found is None:
            break
        assembly, changes = found[0], changes + found[1]
    raise NoRest("the structure snaps, and where it comes to rest was not found")


def steepest(assembly: Assembly) -> tuple[Array, float]:
    """Return displacements (n, 6) in which the dead loads do most work, and its share of what they could.

    None is larger than TURN of its block along the sums of the loads and across them: axes that turn with the
    structure.
    """
    model, free = assembly.model, assembly.model.free
    sums = np.stack([resultant(load, model.free_blocks) for load in (model.live, model.dead)], axis=1)
    axes = np.linalg.qr(sums, mode="complete")[0]
    size = TURN * np.array([block.size for block in model.blocks])
    lengths = np.stack([size, np.full_like(size, TURN)], axis=1).ravel()
    scale = sparse.kron(sparse.diags_array(lengths), axes).tocsr()
    dead, live = np.zeros((len(size), 6)), np.zeros((len(size), 6))
    dead[free], live[free] = (load.on(model.free_blocks) for load in (model.dead, model.live))
    dead, live = scale.T @ dead.ravel(), scale.T @ live.ravel()
    rows = (rows_of(assembly.contacts, assembly.at_rest.at) @ scale).tocsr()
    own = assembly.contacts
    gap, rigid = own.ways[:, 2], own.rigid[own.of]
    stuck = rigid & own.pressed[own.of] & assembly.closed
    along = np.flatnonzero(np.outer(stuck, [True, True, False]))
    reach = np.repeat(free, 6) * 1.0
    rests = sparse.csr_array(live.reshape(1, -1) / np.abs(live).max())
    found = linear_program(
        -dead / np.abs(dead).sum(),
        -rows[2::3][rigid],
        np.where(assembly.closed, 0.0, gap)[rigid],  # of a tower HiGHS ends with Status 4 by their rounding
        sparse.vstack([rows[along], rests]),
        np.zeros(len(along) + 1),
        np.stack([-reach, reach], axis=1),
        "highs",
        options=TIGHT,
    )
    if found.x is None:
        raise SolveError("whether the structure is held was not found")
    return np.asarray(scale @ found.x).reshape(-1, 6), -float(found.fun)
