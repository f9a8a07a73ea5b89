"""What of the contacts of a displaced structure touches, where their forces act, and the answer of that."""

from __future__ import annotations

from collections.abc import Sequence, Set
from dataclasses import replace

import numpy as np
import shapely

from limitblocks.analysis.nonassociated.fixed_point import NearestStresses
from limitblocks.analysis.nonassociated.loop import nonassociated
from limitblocks.arrays import Array, Indices, read_only
from limitblocks.errors import NoEquilibrium, SolveError
from limitblocks.evidence.results import Nonassociated
from limitblocks.geometry import Interface
from limitblocks.geometry.polygon import clean
from limitblocks.joints.queries import normal_share
from limitblocks.model import Model
from limitblocks.practice.contact import CLOSED, DisplacedContacts
from limitblocks.practice.displaced import Assembly
from limitblocks.practice.kept import solved
from limitblocks.practice.rejoined import joined
from limitblocks.practice.trimmed import about_centroid

PRESSED = 1e-6  # of the largest normal force: a contact with less carries none
NEAR = 1e-3  # of the size of a joint: a centre of pressure as near to its closed corners is on them
STRIP = 1e-2  # of the size of a joint: what is left of one on its closed corners; solved where 1e-3 is not
CRUSHED = 1.0 - 1e-6  # of the force that crushes all of a strip: its width holds the answer back


def touching(assembly: Assembly, narrow: Set[int] = frozenset()) -> tuple[Model, list[int]]:
    """Return the model of what touches, and the contacts that its interfaces are of.

    Those that have opened all over carry nothing, nor do ties that are slack. Of those numbered `narrow` the
    closed corners are left.
    """
    kept = np.flatnonzero(assembly.contacts.any(assembly.closed)).tolist()
    found = joined(assembly, assembly.contacts[kept])
    if not narrow:
        return found, kept
    left = (
        narrowed(assembly.contacts[k], assembly.size) if k in narrow else own
        for k, own in zip(kept, found.interfaces, strict=True)
    )
    return replace(found, interfaces=tuple(left)), kept


def narrowed(own: DisplacedContacts, size: float) -> Interface:
    """Return the strip of an opened joint along its closed corners."""
    polygon, closed = own.interface.polygon, own.ways[:, 2] <= 10.0 * CLOSED * size
    shut = shapely.MultiPoint(polygon[closed]).convex_hull
    corners = shapely.points(polygon)
    on = shapely.get_coordinates(shapely.get_point(shapely.shortest_line(shut, corners), 0))
    off = polygon - on
    far = np.linalg.norm(off, axis=1, keepdims=True)
    strip = on + off * np.minimum(STRIP * np.abs(polygon).max() / np.maximum(far, 1e-300), 1.0)
    # corners that an overlay left next to each other come nearer yet
    strip, _ = clean(strip, np.zeros(len(strip), dtype=int), np.array([CLOSED * size]))
    middle, turn, first = about_centroid(strip, own.interface.axes[:2])
    strip = np.roll(strip - middle, -first, axis=0)
    axes = own.interface.axes
    return replace(
        own.interface,
        centroid=read_only(own.interface.centroid + middle @ axes[:2]),
        axes=read_only(np.concatenate([turn @ axes[:2], axes[2:]])),
        polygon=read_only(strip @ turn.T),
    )


def pressed_in(assembly: Assembly, kept: list[int], stress_resultants: Array) -> Assembly:
    """Return the structure with the contacts that carry a force marked, from stress resultants (m, 6)."""
    normal = np.zeros(len(assembly.contacts))
    normal[kept] = -stress_resultants[:, 2]
    contacts = replace(assembly.contacts, pressed=normal > PRESSED * normal.max())
    return replace(assembly, contacts=contacts)


def across(assembly: Assembly, stress_resultants: Array, kept: Sequence[int] | Indices) -> dict[int, str]:
    """Return sentences on the opened joints whose normal force acts off their closed corners, by number.

    `stress_resultants`, shape (m, 6), are those of the contacts `kept`, on their whole faces.
    """
    said, least = {}, 1e-6 * np.abs(stress_resultants[:, 2]).max(initial=0.0)
    opened = assembly.contacts.any(~assembly.closed)[kept]
    for row in np.flatnonzero(opened & (-stress_resultants[:, 2] > least)).tolist():
        k, Q = int(kept[row]), stress_resultants[row]
        own, closed = assembly.contacts[k], assembly.closed[assembly.contacts.of == k]
        gap, size = own.ways[:, 2], float(np.abs(own.interface.polygon).max())
        centre = np.array([-Q[4] / Q[2], Q[3] / Q[2]])
        pressed = shapely.Point(centre)
        shut = shapely.MultiPoint(own.interface.polygon[closed]).convex_hull
        if not closed.any() or shut.distance(pressed) > NEAR * size:
            opening = np.linalg.lstsq(np.c_[np.ones(len(gap)), own.interface.polygon], gap)[0]  # linear
            there = float(opening @ [1.0, *centre])
            said[k] = f"{own.interface.name} presses across a gap of {1e3 * there:.3g} mm"
    return said


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
        found = NearestStresses(problem).find(np.zeros(len(problem.compliance)), np.zeros(len(problem.g)))
        if found is None:
            raise
        shift = -found[0] / problem.units.live
        held = replace(model, dead=model.dead + (-shift) * model.live)
        return shift, held, solved(nonassociated, held)
