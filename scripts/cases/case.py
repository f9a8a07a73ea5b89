"""A value to reproduce, and the analyses that have to reproduce it."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import limitblocks as lb
from limitblocks.structures.cases import Comparison

JOINTS = {"OrdunaLourenco": lb.OrdunaLourenco, "PointContact": lb.PointContact}
FLOWS = ("associated", "non-associated")


@dataclass(frozen=True)
class Case:
    """A value to reproduce: `run` has to return `published` within the absolute `tolerance`."""

    group: str
    structure: str
    quantity: str
    source: str
    published: float
    tolerance: float
    run: Callable[[], float]
    quick: bool = False
    at_least: bool = False  # every value from the published one upwards is right
    comparison: Comparison = Comparison.SAME

    def met(self, computed):
        if self.at_least:
            return computed >= self.published - self.tolerance
        return computed == self.published or abs(computed - self.published) <= self.tolerance


def of_print(group, structure, quantity, published, run, **options):
    """The case of a value in the registry of `limitblocks.structures.cases`."""
    value, tolerance = published.value, published.tolerance
    options.setdefault("source", published.source)
    return Case(group, structure, quantity, options.pop("source"), value, tolerance, run,
                comparison=published.comparison, **options)  # fmt: skip


def associated(build, joint):
    """The static bound; `lb.bounds` raises unless the kinematic one agrees and all residuals are small."""
    try:
        return lb.bounds(build(joint)).lower
    except lb.errors.UnlimitedLoad:
        return math.inf


def nonassociated(build, joint):
    model = build(joint)
    result = lb.nonassociated(model)
    lb.check_mcp(model, result).require()
    return result.load_factor


def end_of_path(build, joint):
    model = build(joint)
    path = lb.load_path(model)
    lb.check_mcp(model, path.collapse).require()
    return path.load_factor


ANALYSES = {"associated": associated, "non-associated": nonassociated, "load path": end_of_path}
