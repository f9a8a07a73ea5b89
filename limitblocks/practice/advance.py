"""One step of a displaced structure along its mechanism: contacts brought together, changes told."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy import sparse

from limitblocks.arrays import Array, Flags, as_typed, read_only, real
from limitblocks.errors import ModelError
from limitblocks.evidence.relative_rates import largest_rate
from limitblocks.geometry import Block
from limitblocks.joints import Backfill, Dowel, Guide, Tie
from limitblocks.joints.base import joint_of, refuse_nameless_strength
from limitblocks.mechanics.loads.forces import AddedMass, MassProportional, Moment, PointForce
from limitblocks.mechanics.loads.load import Load, vector
from limitblocks.model import Model
from limitblocks.practice.capacity_result import Control
from limitblocks.practice.contact import CLOSED, DisplacedContacts, bond
from limitblocks.practice.displaced import Assembly
from limitblocks.practice.rejoined import closed_up, joined, meet, parallel, slid
from limitblocks.shown import coordinates

FOLLOWS = (MassProportional, AddedMass, PointForce, Moment)  # loads that know where a moved block is
STILL = 1e-6  # of the largest speed: a relative motion below it counts as none
TOUCH = 1e-5  # of the size of the structure: a corner that comes as near closes
SECANTS = 4  # to where a contact closes; then steps are halved
SHORTEST = 2.0**-20  # of a step: where a contact closes
PROBE = 1e-8  # of the size of the structure: so short a motion is one of the first order
AT_ODDS = 1e-5  # of that motion: a tie that it lengthens by more is lengthened
BESIDE = 1e-2  # of the size of a block: a point as far from it is not on it


@dataclass(frozen=True, eq=False)
class Advanced:
    """A structure one step on: where its contacts are, its control point, and what changed on the way."""

    assembly: Assembly
    control: Control
    changes: tuple[str, ...]
    snapped: bool = False


def farthest(largest: object, what: str) -> float:
    """Return the displacement at which a way ends, which may be infinite; ModelError where it is none."""
    if not (given := real(largest)) > 0.0:
        raise ModelError(f"largest is {as_typed(largest)}, expected a {what} > 0 in m")
    return given


def refuse_left_behind(what: str, model: Model, words: Sequence[str]) -> None:
    """Raise ModelError for a load of these names, or passive fill, that stays behind as its block moves."""
    if any(isinstance(own.joint, Backfill) for own in model.interfaces):
        raise ModelError(f"passive fill does not move with the blocks; a {what} needs a structure without it")
    for joint in {joint_of(own) for own in model.interfaces}:
        if not isinstance(joint, Tie | Dowel | Guide):
            refuse_nameless_strength(joint, f"a {what}")
    for word in words:
        load: Load = getattr(model, word)
        for _, term in load.terms:
            if not isinstance(term, FOLLOWS):
                raise ModelError(
                    f"the {word} load has a {type(term).__name__}, which does not move with the blocks; a "
                    f"{what} needs weights, added masses, forces and moments"
                )


def control_point(model: Model, name: str, at: Sequence[float]) -> tuple[Block, Array]:
    """Return the block of a name and a point (3,), m, on it; ModelError where it is none."""
    named = {block.name: block for block in model.blocks}
    if name not in named:
        raise ModelError(f"control block {name!r} is not a block of the model")
    block, point = named[name], np.array(vector(at, "control point"))
    low, high = block.vertices.min(axis=0), block.vertices.max(axis=0)
    if (np.maximum(low - point, point - high) > BESIDE * block.size).any():
        here, first, last = (coordinates(one.tolist()) for one in (point, low, high))
        raise ModelError(
            f"control point {here} is not on block {block.name!r}, which reaches from {first} to {last} m"
        )
    return block, point


def advanced(assembly: Assembly, control: Control, rates: Array, step: float) -> Advanced | None:
    """Return the structure after a step (m, of the control point) along rates (n, 6); None if it is stuck.

    The step is cut where a contact closes.
    """
    pace = float(velocity(assembly.model, control, rates) @ control.direction)
    found = moved_until_contact(assembly, step / pace * rates)
    if found is None:
        return None
    there, changes = found
    return Advanced(there, carried(assembly, there, control), changes)


def shut(there: Advanced, numbers: Collection[int]) -> Advanced | None:
    """Return the structure with some of its contacts, by number, closed; None if what is closed bars it.

    Supports stay. A contact that opened on the way has not; another one closes.
    """
    assembly, own = there.assembly, there.assembly.contacts
    held = (assembly.closed | np.isin(own.of, list(numbers))) & own.rigid[own.of]
    goal, left = closed_up(assembly, held, np.zeros(len(own), dtype=bool))
    meets = (goal.contacts.least[own.rigid] < -10.0 * CLOSED * assembly.size).any()
    if left > CLOSED * assembly.size or meets or meet(goal):
        return None
    names = [own.interfaces[k].name for k in numbers]
    said = [one for one in there.changes if one not in {f"{name} opens" for name in names}]
    said += [f"{name} closes" for name in names if f"{name} opens" not in there.changes]
    return replace(there, assembly=goal, changes=tuple(said))


def stopped(displacement: float) -> str:
    """Return why a curve ends at a displacement, m, from which contacts allow no step."""
    if displacement == 0.0:
        return "a contact closes at once, in the first step, and stops the mechanism"
    return f"contacts that close, or blocks that meet, stop the mechanism at {displacement:.6g} m"


def moved_until_contact(assembly: Assembly, displacements: Array) -> tuple[Assembly, tuple[str, ...]] | None:
    """Return the structure after displacements (n, 6), cut where a contact closes, and what changed.

    The contacts that the displacements do not open are brought together again. None if it is stuck.
    """
    held, sliding, yielding = _motion(assembly, displacements)
    at_odds = _at_odds(assembly, displacements, held, sliding)
    own, yielding = assembly.contacts, yielding | at_odds
    held &= ~at_odds[own.of]
    before, least = own.ways[:, 2], 10.0 * CLOSED * assembly.size
    rigid, share, trials = (own.rigid & ~yielding)[own.of], 1.0, 0
    while share >= SHORTEST:
        goal, left = closed_up(assembly, held, sliding, share * displacements)
        gap = goal.contacts.ways[:, 2]
        meets = rigid & (gap < -least)
        closes = rigid & (before > least) & (gap < np.minimum(TOUCH * assembly.size, 0.1 * before))
        if closes.any() and not (meets & ~closes).any() and gap[closes].min() > -TOUCH * assembly.size:
            goal, left = closed_up(goal, held | closes, sliding)
            meets &= ~closes
        if left <= CLOSED * assembly.size and not meets.any() and not meet(goal):
            changes = _changes(own, before, goal.contacts.ways[:, 2], least)
            goal = replace(goal, contacts=goal.contacts.yielded(yielding))
            goal, lost = _parted(goal, sliding, least)
            there, said = slid(goal, sliding)
            return there, tuple(dict.fromkeys(changes + lost + said))  # pieces of an area share a name
        closes &= meets
        secant = (before[closes] / (before - gap)[closes]).min() if closes.any() else 0.5
        share, trials = share * (secant if trials < SECANTS else min(secant, 0.5)), trials + 1
    return None


def _parted(assembly: Assembly, sliding: Flags, least: float) -> tuple[Assembly, tuple[str, ...]]:
    """The structure without the bond of the contacts that have opened or slide, and a sentence for each."""
    own = assembly.contacts
    lost = (sliding | own.any(own.ways[:, 2] > least)) & [bool(bond(one.joint)) for one in own.interfaces]
    if not lost.any():
        return assembly, ()
    contacts = own.parted(lost)
    said = tuple(f"{own.interfaces[k].name} loses its bond" for k in np.flatnonzero(lost))
    return Assembly(joined(assembly, contacts), contacts), said


def _motion(assembly: Assembly, rates: Array) -> tuple[Flags, Flags, Flags]:
    """Which corners (k,) are closed and stay so, which contacts (m,) slide, and which are ties that yield."""
    own, least = assembly.contacts, STILL * largest_rate(assembly.model, rates)
    speeds = [
        rates[k, :3] + np.cross(rates[k, 3:], points - assembly.at_rest.at[k])
        for k, points in zip(own.ends[own.of].T, (own.on_i, own.on_j), strict=True)
    ]
    axes = np.stack([one.axes for one in own.interfaces])
    relative = np.einsum("kab,kb->ka", axes[own.of], speeds[1] - speeds[0])
    relative[own.tied[own.of], 2] *= -1.0  # its gap is what it is slack
    slowest = _last(own, np.minimum.reduceat(np.where(assembly.closed, relative[:, 2], np.inf), own.first))
    closed = assembly.closed & (relative[:, 2] <= np.maximum(slowest, 0.0)[own.of] + least)
    yielding = own.tied & own.any(closed & (relative[:, 2] < -least))
    slides = closed & (np.linalg.norm(relative[:, :2], axis=1) > least)
    return closed & (own.rigid & ~yielding)[own.of], own.any(slides) & ~own.tied, yielding


def _last(own: DisplacedContacts, opens: Array) -> Array:
    """Speeds at which the closed corners of pressed joints open that do so last, shape (m,); 0 of others.

    `opens`, shape (m,), are the least of their own closed corners. A strip along closed corners turns about
    its other edge: what is pressed there opens nowhere, be it in one piece or in several between the same
    blocks.
    """
    pairs = np.unique(own.ends, axis=0, return_inverse=True)[1].reshape(-1)
    of_pair = sparse.csr_array((np.ones(len(pairs)), (np.arange(len(pairs)), pairs)))
    piece, other = (of_pair @ of_pair.T).nonzero()
    kept = ~own.tied[other] & parallel(own.axes_i[piece], own.axes_i[other])
    last = np.full(len(pairs), np.inf)
    np.minimum.at(last, piece[kept], opens[other[kept]])
    return np.where(own.pressed & ~own.tied, last, 0.0)


def _at_odds(assembly: Assembly, rates: Array, held: Flags, sliding: Flags) -> Flags:
    """Taut ties (m,) that crushing does not lengthen but the motion does: they go with the motion.

    A joint that crushes turns about the inner edge of what is crushed, in the finite motion about the toe.
    """
    own = assembly.contacts
    shut = own.any(assembly.closed)
    joints = [own.interfaces[k].joint for k in np.flatnonzero(shut)]
    taut = own.tied & shut
    if not taut.any() or all(getattr(joint, "compressive_strength", None) is None for joint in joints):
        return np.zeros_like(taut)
    way, (start, _) = PROBE * assembly.size, closed_up(assembly, held, sliding)
    probe = way / largest_rate(assembly.model, rates) * rates
    now = closed_up(start, held, sliding, probe)[0].contacts
    return taut & (now.least < np.minimum(start.contacts.least, 0.0) - AT_ODDS * way)


def carried(assembly: Assembly, goal: Assembly, control: Control) -> Control:
    """Return the control point on its moved block: the same combination of its vertices."""
    k = [block.name for block in assembly.model.blocks].index(control.block)
    old, new = assembly.model.blocks[k], goal.model.blocks[k]
    about = old.vertices - old.centroid
    turn = np.linalg.lstsq(about, new.vertices - new.centroid, rcond=None)[0]
    return replace(control, point=read_only(new.centroid + (control.point - old.centroid) @ turn))


def velocity(model: Model, control: Control, rates: Array) -> Array:
    """Return the velocity of the control point, shape (3,)."""
    k = [block.name for block in model.blocks].index(control.block)
    arm = control.point - model.blocks[k].centroid
    return np.asarray(rates[k, :3] + np.cross(rates[k, 3:], arm))


def _changes(own: DisplacedContacts, before: Array, after: Array, least: float) -> tuple[str, ...]:
    """Sentences on the contacts that opened or closed, by the gaps (k,) of their corners."""
    closes, opens = own.any((before > least) & (after <= least)), own.any((before <= least) & (after > least))
    said = []
    for k in np.flatnonzero(closes | opens):
        words = ("is taut again", "goes slack") if own.tied[k] else ("closes", "opens")
        found = zip(words, (closes[k], opens[k]), strict=True)
        said += [f"{own.interfaces[k].name} {word}" for word, true in found if true]
    return tuple(said)
