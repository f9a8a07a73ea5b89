"""Ties, strips and dowels between blocks, as interfaces of their own; prestress as a dead load."""

from __future__ import annotations

from collections.abc import Container, Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from limitblocks.analysis.anchors import anchors_off
from limitblocks.arrays import read_only
from limitblocks.errors import ModelError, near, refuse_kind
from limitblocks.geometry import Interface
from limitblocks.geometry.polygon import areas, axes_of
from limitblocks.joints import Dowel, Guide, Tie
from limitblocks.joints.base import checked_count
from limitblocks.mechanics import Load
from limitblocks.mechanics.loads import force
from limitblocks.mechanics.loads.load import number, vector
from limitblocks.model import Model, checked_model
from limitblocks.practice.partial_factors import DesignModel
from limitblocks.practice.places import off_joint

ROUNDED = 1e-9  # of the coordinates of its anchors: the direction of a shorter tie is rounding
CORNERS = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]) / 2.0


@dataclass(frozen=True, eq=False)
class Element:
    """A tie or dowel, ready for :func:`reinforced`.

    Attributes
    ----------
    interface : Interface
        What carries its force; the normal of a tie points from the anchor in block i to that in block j.
    """

    interface: Interface

    def __post_init__(self) -> None:
        refuse_kind(self.interface, Interface, "interface of an element")

    @property
    def prestress(self) -> float:
        """Tension that is there from the beginning and stays, N."""
        joint = self.interface.joint
        return joint.prestress * float(areas(self.interface.polygon)) if isinstance(joint, Tie) else 0.0

    def loads(self, free: Container[str]) -> Load:
        """Return the prestress as forces on its blocks, those that are `free`."""
        pull, own = self.prestress * self.interface.axes[2], self.interface
        ends = ((own.block_i, pull), (own.block_j, -pull))
        on = [force(block, along.tolist(), own.centroid.tolist()) for block, along in ends if block in free]
        return sum(on, Load()) if self.prestress else Load()


def tie(
    block_i: str,
    at_i: Sequence[float],
    block_j: str,
    at_j: Sequence[float],
    *,
    area: float,
    strength: float,
    pull_out: float = np.inf,
    prestress: float = 0.0,
    number_of: int = 1,
) -> Element:
    """Return a tie from the point `at_i` of `block_i` to the point `at_j` of `block_j`.

    It carries tension from 0 to the lesser of `number_of` x area x strength and the anchor's `pull_out`, and
    no compression. Without extension it carries nothing by itself; a tie that must be tight at first has a
    prestress.

    Parameters
    ----------
    block_i, block_j : str
        Blocks that hold the anchors; a support stands for the ground.
    at_i, at_j : sequence of float
        Anchors, global axes, m: in or on a block that can move; that of a support may lie anywhere.
    area : float
        Cross-section of one tie, m2.
    strength : float
        Yield strength f_y of the material, Pa.
    pull_out : float
        Largest force that the anchors hold, N, all ties together.
    prestress : float
        Tension that is there from the beginning, N, all ties together: a dead load on both blocks. It stays
        where the anchors approach, as in a long tie whose stretch is large beside the motion; what more the
        tie can take is its capacity less the prestress.
    number_of : int
        Ties side by side.

    Raises
    ------
    ModelError
        If a block is not named, both ends are in one, the anchors coincide, a number is out of range, or the
        prestress is not below what the tie can carry.
    """
    for name in (block_i, block_j):
        refuse_kind(name, str, "name of a block that a tie joins")
    word = f"tie {block_i}|{block_j}"
    if block_i == block_j:
        raise ModelError(f"{word}: both ends are in block {block_i!r}; a tie joins two blocks")
    checked_count(f"{word}: number_of", number_of, 1)
    start = np.array(vector(at_i, f"{word}: at_i"))
    end = np.array(vector(at_j, f"{word}: at_j"))
    length = float(np.linalg.norm(end - start))
    if not length > ROUNDED * np.abs([start, end]).max():
        raise ModelError(f"{word}: both anchors are at {start.tolist()}; a tie needs a length")
    section = number_of * number(area, f"{word}: area", "m2", above=0.0)
    capacity = section * number(strength, f"{word}: strength", "Pa", above=0.0)
    if pull_out != np.inf:
        capacity = min(capacity, number(pull_out, f"{word}: pull_out", "N", above=0.0))
    if not number(prestress, f"{word}: prestress", "N", least=0.0) < capacity:
        raise ModelError(
            f"{word}: prestress is {prestress:g} N, expected 0 to less than the {capacity:g} N it can carry: "
            "one that has nothing left to yield is a pair of forces"
        )
    return Element(
        Interface(
            block_i,
            block_j,
            read_only((start + end) / 2.0),
            read_only(axes_of((end - start) / length)),
            read_only(np.sqrt(section) * CORNERS),
            Tie(capacity / section, length, prestress / section),
        )
    )


def strip(interface: Interface, at: Sequence[float], *, width: float, capacity: float) -> Element:
    """Return a bonded strip (fibre-reinforced polymer or mortar) across `interface`, along its normal.

    It carries tension up to `capacity`, the least of its own strength and what its bond holds on either side
    (debonding), and no compression.

    Parameters
    ----------
    interface : Interface
        The joint that it bridges.
    at : sequence of float
        A point of the joint under the strip, as a rule on its edge, global axes, m.
    width : float
        Width of the strip, m.
    capacity : float
        Force at which it breaks or debonds, N.

    Raises
    ------
    ModelError
        If a number is out of range, the interface is one of an element, or the point is not on the joint.
    """
    word = _joint_word(interface, "strip")
    side = number(width, f"{word}: width", "m", above=0.0)
    most = number(capacity, f"{word}: capacity", "N", above=0.0)
    return _across(interface, at, side, Tie(most / side**2), word)


def dowel(interface: Interface, at: Sequence[float], *, diameter: float, capacity: float) -> Element:
    """Return a dowel or stitch across `interface` at the point `at`, which carries shear up to `capacity`.

    Parameters
    ----------
    interface : Interface
        The joint that it crosses.
    at : sequence of float
        Where, global axes, m.
    diameter : float
        m; for the picture, and the unit of length.
    capacity : float
        Shear force at which it yields or tears out, N, the same in all directions.

    Raises
    ------
    ModelError
        If a number is out of range, the interface is one of an element, or the point is not on the joint.
    """
    word = _joint_word(interface, "dowel")
    side = number(diameter, f"{word}: diameter", "m", above=0.0)
    most = number(capacity, f"{word}: capacity", "N", above=0.0)
    return _across(interface, at, side, Dowel(most / side**2), word)


def reinforced(model: Model, *elements: Element) -> Model:
    """Return the model with ties, strips and dowels; their prestress is added to the dead loads.

    The result is a model like any other: bounds, the answer without dilatancy, checks and reports work on it.

    Parameters
    ----------
    model : Model
        The structure without them.
    *elements : Element
        Of :func:`tie`, :func:`strip`, :func:`dowel`.

    Raises
    ------
    ModelError
        If an element names a block that the model does not have, or joins two supports, or an anchor of a
        tie, or a strip or dowel, is off a block that can move; if the model has design values, which the
        elements would not have.
    """
    if isinstance(model, DesignModel):
        raise ModelError(
            "the model has design values, which an element would not have: reinforce the model with "
            "characteristic values, then design_model"
        )
    return with_elements(model, *elements)


def with_elements(model: Model, *elements: Element) -> Model:
    """Return the model with elements as they are: of a design model they have design values already."""
    checked_model(model)
    for element in elements:
        _refuse_other(element)
    known, supports = {block.name for block in model.blocks}, set(model.supports)
    problems = []
    for element in elements:
        own = element.interface
        ends = {own.block_i, own.block_j}
        problems += [
            f"{own.name}: {name!r} is not a block of the model{near(name, known)}"
            for name in sorted(ends - known)
        ]
        if ends <= supports:
            problems.append(f"{own.name}: both ends are in supports, which do not move")
        problems += anchors_off(model, own)
    if problems:
        raise ModelError(*problems)
    free = {block.name for block in model.free_blocks}
    dead = sum((element.loads(free) for element in elements), model.dead)
    interfaces = (*model.interfaces, *(element.interface for element in elements))
    return replace(model, interfaces=interfaces, dead=dead)


def _refuse_other(element: object) -> None:
    """ModelError where that is no element, which says how a list of them is given."""
    if not isinstance(element, Element):
        several = isinstance(element, Iterable) and not isinstance(element, str)
        raise ModelError(
            f"what a structure is reinforced with is a {type(element).__name__}, expected Element, as of "
            "tie, strip or dowel" + "; several are given one by one: reinforced(model, *elements)" * several
        )


def _joint_word(interface: Interface, what: str) -> str:
    """What a strip or dowel across a joint is called; ModelError where it is no joint of two blocks."""
    refuse_kind(interface, Interface, f"interface of a {what}")
    if isinstance(interface.joint, Tie | Dowel | Guide):
        raise ModelError(f"{what} across {interface.name}: expected a joint in which two blocks touch")
    return f"{what} across {interface.name}"


def _across(interface: Interface, at: Sequence[float], side: float, joint: Tie | Dowel, word: str) -> Element:
    point = read_only(np.array(vector(at, f"{word}: at")))
    if off := off_joint(interface, point):
        raise ModelError(f"{word}: at is {point.tolist()}, not on the joint, {off:.3g} m off it")
    return Element(
        Interface(
            interface.block_i, interface.block_j, point, interface.axes, read_only(side * CORNERS), joint
        )
    )
