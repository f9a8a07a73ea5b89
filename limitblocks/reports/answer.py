"""The one number to design with, why it is the one, and how it compares with what is required."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from limitblocks.model import Model
from limitblocks.reports.section import Section
from limitblocks.reports.words import as_acceleration, cut
from limitblocks.shown import rounded_down

CERTIFIED = (
    "Stresses, mechanism and multipliers that satisfy equilibrium, yield, flow rule and complementarity, "
    "Eqs (54)-(59), prove it, recomputed without the solver. {} Other solutions may exist at other load "
    "factors."
)
REAL = "Joints that slide do not dilate by the friction angle, as in real masonry."
LIFTING = "Joints that slide lift by {:g} of what they slide, the dilatancy stated."
LIFTED = (
    "this load factor is one with a dilatancy of {:g}: joints that dilate less, as those of real masonry "
    "may, can give a smaller one"
)
LEAST = "It is the least of the {} certified load factors of this report that loading leads to."
UPPER = (
    "It is the kinematic bound for joints that dilate by the friction angle (associated flow). No certified "
    "load factor without that dilatancy is in this report."
)
WARNING = (
    "This number is an upper estimate: real friction dilates less than associated flow assumes, and the "
    "structure may collapse at a smaller load factor. The non-associated analysis gives one to design with."
)
NONE = "No certified load factor is in this report."
UNDEMANDED = "Safety: no required load factor (demand) was stated, so this report says nothing about safety."


@dataclass(frozen=True)
class Answer:
    """Load factor to design with.

    Attributes
    ----------
    load_factor : float, optional
        None where the report has none.
    certified : bool
        Whether it is a certified non-associated one; else it is an upper estimate.
    source : str
        Which result it is of.
    reason : str
        Why it is the one.
    remarks : tuple of str
        What to know of it.
    """

    load_factor: float | None = None
    certified: bool = False
    source: str = ""
    reason: str = NONE
    remarks: tuple[str, ...] = ()

    @property
    def number(self) -> str:
        """The load factor as text."""
        if self.load_factor is None:
            return "none"
        return cut(self.load_factor) if self.certified else f"≤ {cut(self.load_factor, most=True)}"

    def quantity(self, model: Model) -> str:
        """What the number is, in words."""
        if self.load_factor is None:
            return "no load factor to design with"
        kind = f"load factor α to design with, {'certified' if self.certified else 'upper estimate'}"
        said = as_acceleration(model, self.load_factor, most=not self.certified)
        return f"{kind}, {self.source}" + (f": {said}" if said else "")


@dataclass(frozen=True)
class Verdict:
    """How the load factor compares with the one that is required."""

    demand: float
    ratio: float
    text: str


def answer(sections: Sequence[Section]) -> Answer:
    """Return the load factor to design with: the least certified non-associated one that loading leads to.

    Without one it is the least kinematic bound, as an upper estimate.
    """
    certified = sorted(design for one in sections for design in one.designs)
    if certified:
        load_factor, source, remarks, dilatancy = certified[0]
        least = f"{LEAST.format(len(certified))} " if len(certified) > 1 else ""
        if dilatancy:
            source, remarks = f"{source}, dilatancy {dilatancy:g}", (LIFTED.format(dilatancy), *remarks)
        flow = LIFTING.format(dilatancy) if dilatancy else REAL
        return Answer(load_factor, True, source, least + CERTIFIED.format(flow), remarks)
    upper = [one.upper for one in sections if one.upper is not None]
    return Answer(min(upper), False, "kinematic bound", UPPER) if upper else Answer()


def verdict(found: Answer, demand: float) -> Verdict | None:
    """Return the load factor over the demand, in words; None where there is no load factor."""
    if found.load_factor is None:
        return None
    ratio = found.load_factor / demand
    word = "load factor" if found.certified else "upper estimate of the load factor"
    number = cut(found.load_factor, most=not found.certified)
    said = f"the {word} {number} is {rounded_down(ratio)} times the demand {demand:.15g}"
    if ratio < 0.0:
        said = (
            f"the {word} {number} is below zero: in this state the structure falls before the live load acts "
            "or with it acting the other way (stability says whether it stands without it)"
        )
        meaning = f"the demand {demand:.15g} cannot be met"
    elif ratio < 1.0:
        meaning = "the demand is not reached"
    elif found.certified:
        meaning = "the demand is reached"
    else:
        meaning = "whether the demand is reached is open, because real friction may give less"
    return Verdict(demand, ratio, f"{said}: {meaning}. This is no statement of compliance with a code.")
