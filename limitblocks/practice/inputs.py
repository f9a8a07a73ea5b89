"""What a verification is given, as quantities, and what the text asks of it that was not given."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from limitblocks.arrays import Array
from limitblocks.errors import ModelError
from limitblocks.evidence.check import check_mcp
from limitblocks.evidence.claim import Claim
from limitblocks.evidence.mechanism import change_of_mechanism
from limitblocks.joints import Tie
from limitblocks.mechanics import Load
from limitblocks.mechanics.loads import AddedMass, Fill, MassProportional
from limitblocks.mechanics.loads.load import of
from limitblocks.model import Model
from limitblocks.practice.capacity_result import CapacityCurve
from limitblocks.practice.carried_loads import prestress
from limitblocks.practice.spectra import Place, Spectrum
from limitblocks.practice.verification_result import Quantity
from limitblocks.problem import Flow, State, turning_of

LC1 = 1.35  # confidence factor of the lowest level of knowledge, Table C8.5.IV
PLANE = 1e-3  # of the largest velocity: less than this across the plane is none
ALIKE = 1e-3  # of the live work, or of e*: less of a difference is none
GOLDEN = 0.5 * (5.0**0.5 - 1.0)
ROUNDING = 1e-9  # of the weight: a force that is none
UP = (0.0, 0.0, 1.0)
ROOM = 1e-3  # of the associated load factor: without sliding an answer lies below it by rounding

GIVEN = "given"
NTC = "NTC 2018"


def refuse_unproven(model: Model, result: Any) -> None:
    """Raise CheckFailed for a claim, as of a file, that is no solution, and ModelError for a best state."""
    if isinstance(result, Claim) or getattr(result, "from_file", False):
        check_mcp(model, result).require()
    elif not getattr(getattr(result, "collapse", result), "accepted", True):
        raise ModelError(f"this {type(result).__name__} is no solution: {result.collapse.status.value}")


def given(spectrum: Spectrum, state: str = "SLV") -> list[Quantity]:
    """Return the parameters of a spectrum; symbols of another limit state than SLV end in its name."""
    end = "" if state == "SLV" else f"_{state}"
    rows = (
        ("a_g", "ground acceleration on rock", GIVEN, spectrum.a_g, "m/s2", "3.2"),
        ("S", "soil and topography, S_S S_T", GIVEN, spectrum.S, "", "[3.2.3]"),
        ("F0", "largest amplification", GIVEN, spectrum.F0, "", "3.2"),
        ("T_C", "start of constant velocity", GIVEN, spectrum.T_C, "s", "[3.2.5]"),
        ("T_D", "start of constant displacement", "4 a_g / g + 1.6", spectrum.T_D, "s", "[3.2.7]"),
    )
    return [
        Quantity(f"{symbol}{end}", f"{meaning}, {state}", formula, value, unit, f"{NTC} {source}")
        for symbol, meaning, formula, value, unit, source in rows
    ]


def carried(place: Place, spectrum: Spectrum) -> list[Quantity]:
    """Return the modes that carry the mechanism, and the largest acceleration of its floor, m/s2."""
    found: list[Quantity] = []
    floor = place.floor
    if not floor:
        return found
    for k, (mode, peak) in enumerate(zip(floor.modes, floor.peaks(spectrum), strict=True), start=1):
        found += [
            Quantity(f"T_{k}", f"period of mode {k}", GIVEN, mode.period, "s", "C7.2.3"),
            Quantity(f"gamma_{k}", f"participation of mode {k}", GIVEN, mode.participation, "", "C7.2.3"),
            Quantity(f"psi_{k}(z)", f"shape of mode {k} at the height z", GIVEN, mode.shape, "", "C7.2.3"),
            Quantity(f"xi_{k}", f"damping of mode {k}", GIVEN, mode.damping, "", "C7.2.3"),
            Quantity(f"a_Z,{k}", f"share of mode {k} in the acceleration of the floor",
                     "S_e(T_k, xi_k) |gamma_k psi_k| sqrt(1 + .0004 xi_k^2), xi_k in %", peak, "m/s2",
                     "[C7.2.7]"),
        ]  # fmt: skip
    words = "sqrt(sum a_Z,k^2); here at least a_g S, on the safe side"
    largest = Quantity("a_Z", "largest acceleration at the height z", words, floor.largest(spectrum), "m/s2",
                       "[C7.2.8]")  # fmt: skip
    return [*found, largest]


def flow_words(dilatancy: float) -> str:
    """Return how the joints of a result flow, from the tangent of their dilatancy angle."""
    if dilatancy == 0.0:
        return "without dilatancy"
    return f"with a dilatancy of {dilatancy:g}" if np.isfinite(dilatancy) else "associated"


def unproven(collapse: Any, curve: CapacityCurve | None) -> tuple[str, ...]:
    """Return where joints lift as they slide or press across gaps, and a curve not computed here."""
    said = []
    if collapse.dilatancy > 0.0:
        said.append(
            f"alpha0 is {flow_words(collapse.dilatancy)}: where joints slide, real friction may give less"
            " (limitblocks.nonassociated)"
        )
    if curve and curve.from_file:
        said.append("the capacity curve is as a file says, not computed here")
    if curve and any(point.across for point in curve.points):
        said.append(
            f"beyond {curve.proven_to:.4g} m of the capacity curve joints press across their gaps: from "
            "there it is that of a structure whose gaps are filled"
        )
    return tuple(said)


def remarks(model: Model, rates: Array, confidence: float) -> tuple[str, ...]:
    """Return what C8.7.1.2.1 asks that a model and its mechanism (n, 6) do not follow."""
    said = []
    crushing = any(getattr(own.joint, "compressive_strength", None) is not None for own in model.interfaces)
    if confidence < LC1 and not crushing:
        said.append(
            f"FC {confidence:g} with joints without compressive strength: C8.7.1.2.1.3 asks that of LC1,"
            f" {LC1}"
        )
    if any(isinstance(own.joint, Tie) for own in model.interfaces):
        said.append(
            "there are ties: the capacity curve holds them to the end; C8.7.1.2.1.6 counts only what is sure"
            " to be there until collapse, and a tie that breaks before ends SLV"
        )
    if any(isinstance(term, Fill) for _, term in model.dead.terms):
        said.append(
            "there is fill among the dead loads, whose mass is not pushed; masses added to both loads are"
            " (limitblocks.loads.added_mass)"
        )
    if pressing := _pressing(model):
        said.append(
            f"forces among the dead loads press down with {pressing / 1e3:.4g} kN, whose mass is not pushed;"
            " where it moves with the blocks, as of a floor, give it to both loads"
            " (limitblocks.loads.added_mass)"
        )
    if not _plane(model, rates):
        said.append(
            "the mechanism is not parallel to one plane: the equations are calibrated for such (C8.7.1.2.1.6)"
        )
    return tuple(said)


def _pressing(model: Model) -> float:
    """What presses blocks down, N, and is not pushed, beside fill and the prestress of ties."""
    laid = Load(tuple(one for one in model.dead.terms if not isinstance(one[1], MassProportional | Fill)))
    pulls = [of(pull) for own in model.interfaces for pull in prestress(own, model)]
    masses = [(k, replace(one, direction=UP)) for k, one in model.live.terms if isinstance(one, AddedMass)]
    load = laid - sum(pulls, Load()) + Load(tuple(masses))
    down = -load.on(model.free_blocks)[:, 2]
    weight = sum(block.weight for block in model.free_blocks)
    return float(down[down > ROUNDING * weight].sum())


def _plane(model: Model, rates: Array) -> bool:
    """Whether the velocities of all corners are parallel to one plane."""
    velocities = np.concatenate(
        [own[:3] + np.cross(own[3:], block.vertices - block.centroid)
         for block, own in zip(model.blocks, rates, strict=True)]
    )  # fmt: skip
    sizes = np.linalg.svd(velocities, compute_uv=False)
    return bool(sizes[2] <= PLANE * sizes[0])


def other_answers(collapse: Any) -> tuple[str, ...]:
    """Return that alpha0 is one of several answers, where the flow rule leaves room for others."""
    alpha, associated = collapse.load_factor, getattr(collapse, "associated", np.nan)  # of a claim: none
    if not alpha < (1.0 - ROOM) * associated:
        return ()
    return (
        f"alpha0 = {alpha:.4g} is one answer, others may solve as well, up to {associated:.4g} (associated): "
        "load_factor_range (limitblocks range) shows how low those lie that loading reaches; make the "
        "linear checks with the least of them; a capacity curve follows that of nonassociated alone",
    )


def other_mechanisms(model: Model, collapse: Any, share: float, *, curve: bool) -> tuple[str, ...]:
    """Return that other mechanisms have the same alpha0, so that e* is taken as 1.

    By Cauchy and Schwarz' inequality their e* is at most 1. Where the `share` of this one is no less they
    matter to a `curve` alone: the displacement of another may be less.
    """
    if share >= 1.0 - ALIKE and not curve:
        return ()
    problem = model.problem
    rates = collapse.displacement_rates[model.free].ravel()
    si = State(float(collapse.load_factor), collapse.generalised_stresses, rates, collapse.flow_multipliers)
    flow = Flow(problem, collapse.dilatancy, turning_of(collapse.turning))
    shares = np.repeat(np.arange(len(problem.blocks)) * GOLDEN % 1.0, 6)  # numbers without a pattern
    change = change_of_mechanism(flow, problem.dimensionless(si), shares * problem.live)
    if change is not None and change <= ALIKE:
        return ()
    known = "the mechanism is one of many" if change else "the mechanism may be one of many (not found)"
    return (
        f"{known} with this alpha0, in which the blocks move in other proportions: e* (here {share:.4g}) is"
        " taken as 1, so that none of them has a smaller a0*; that is safe, or verify each part that moves by"
        " itself",
    )
