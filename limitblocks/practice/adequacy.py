"""Partial factors on loads and strengths: the load factor of the design model is the adequacy factor.

Sources: EN 1990:2002, Eqs (6.1) F_d = gamma_F F_rep, (6.3) X_d = X_k / gamma_M, (6.8) E_d <= R_d;
EN 1996-1-1:2005, Section 2.4.3 (gamma_M of masonry); EN 1997-1:2004, Table A.4 (gamma_phi on tan phi).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from limitblocks.analysis.bounds import bounds
from limitblocks.analysis.nonassociated.loop import nonassociated
from limitblocks.errors import ModelError, NoEquilibrium, SolveError, UnlimitedLoad, refuse_kind
from limitblocks.evidence.associated import Bounds
from limitblocks.geometry.polygon import areas
from limitblocks.joints import Dowel, Guide, Joint, Tie
from limitblocks.joints.base import STRENGTHS, joint_of, refuse_nameless_strength, stress_words
from limitblocks.model import Model, checked_model
from limitblocks.practice.adequacy_result import Adequacy, DesignValue
from limitblocks.practice.partial_factors import DesignModel, PartialFactors, with_design_values
from limitblocks.shown import many

FRICTION = "friction"
SYMBOLS = {FRICTION: "mu", "cohesion": "c", "tensile_strength": "f_t", "compressive_strength": "f_cef"}


def adequacy(model: Model, factors: PartialFactors, *, without_dilatancy: bool = True) -> Adequacy:
    """Return the load factor of a model whose loads and strengths have their design values.

    The live load of `model` is the characteristic one, so that a load factor of one means E_d = R_d. Where
    dead loads help, as the weight of a wall against overturning, ask again with a `gamma_G` of 1 or less: the
    smaller adequacy factor counts.

    Parameters
    ----------
    model : Model
        With characteristic values.
    factors : PartialFactors
    without_dilatancy : bool
        Whether both models are analysed without dilatancy as well.

    Raises
    ------
    ModelError
        If a joint has no friction or strength that could be factored, or a model with ties, dowels or passive
        fill no `gamma_S`.
    UnlimitedLoad
        If the load factor of the design model is without limit, by the flow rule that was asked for.
    LimitBlocksError
        As :func:`~limitblocks.bounds` and :func:`~limitblocks.nonassociated`.
    """
    design = design_model(model, factors)
    values = tuple(_values(model, factors))
    try:
        pair = _limited(design) if without_dilatancy else bounds(design)
    except NoEquilibrium as error:
        raise NoEquilibrium(error.blocks, error.left_out, "with design values the dead loads alone") from None
    result = given = nonassociated(design) if without_dilatancy else None
    if without_dilatancy and design.digest != model.digest:
        try:
            given = nonassociated(model)
        except SolveError:  # the adequacy factor does not depend on it
            given = None
    return Adequacy(factors, values, _limited(model), design, pair, result, given, model.digest)


def _limited(model: Model) -> Bounds | None:
    """The bounds of a model; None where dilatancy lets the load grow without limit."""
    try:
        return bounds(model)
    except UnlimitedLoad:
        return None


def design_model(model: Model, factors: PartialFactors) -> Model:
    """Return the model with design loads and design strengths; see :func:`adequacy`.

    What puts another live load in the place of its own, as :func:`~limitblocks.practice.worst_position`,
    multiplies that by gamma_Q. Model and result files keep this.

    Raises
    ------
    ModelError
        If the model is a design model already, a joint has no strengths that the factors divide, a tie, a
        dowel or passive fill has no gamma_S, or the design prestress of a tie is not below its design
        strength.
    """
    checked_model(model)
    refuse_kind(factors, PartialFactors, "factors")
    if isinstance(model, DesignModel):
        raise ModelError("the model has its design values already; expected one with characteristic values")
    made = {joint: _design(joint, factors) for joint in _joints(model)}
    interfaces = [replace(one, joint=made[one.joint]) for one in model.interfaces]  # type: ignore[index]
    dead, live = factors.gamma_G * model.dead, factors.gamma_Q * model.live
    design = replace(model, interfaces=interfaces, dead=dead, live=live)
    return with_design_values(design, factors.gamma_Q)


def _design(joint: Joint, factors: PartialFactors) -> Joint:
    """The joint with design strengths."""
    if isinstance(joint, Guide):  # holds whatever comes
        return joint
    _, strength = factors.of_strength(joint)
    if isinstance(joint, Dowel):
        return replace(joint, strength=joint.strength / strength)
    if isinstance(joint, Tie):
        prestress = factors.gamma_G * joint.prestress
        if not prestress < joint.strength / strength:
            raise ModelError(
                f"{joint.word} with a prestress of {stress_words(joint.prestress)}: times gamma_G "
                f"{factors.gamma_G:g} it is not below the strength {stress_words(joint.strength)} over "
                f"gamma_S {strength:g}; expected one that has something left to yield"
            )
        return replace(joint, strength=joint.strength / strength, prestress=prestress)
    refuse_nameless_strength(joint, "partial factors")
    changes = {name: value / strength for name, value in _strengths(joint).items()}
    try:
        changes[FRICTION] = joint.friction / factors.of_friction[1]
        return replace(joint, **changes)  # type: ignore[type-var]
    except TypeError:
        raise ModelError(f"{joint}: no dataclass with a friction that partial factors could divide") from None


def _values(model: Model, factors: PartialFactors) -> Iterator[DesignValue]:
    yield DesignValue("G", "dead loads", 1.0, "gamma_G", factors.gamma_G, "")
    yield DesignValue("Q", "live loads", 1.0, "gamma_Q", factors.gamma_Q, "")
    count = _joints(model)
    for joint, number_of in count.items():
        where = f"{number_of} of {many(len(model.interfaces), 'interface')}"
        if isinstance(joint, Tie | Dowel | Guide):
            continue
        word, divisor = factors.of_friction
        yield DesignValue(SYMBOLS[FRICTION], where, joint.friction, word, joint.friction / divisor, "")
        for name, value in _strengths(joint).items():
            word, divisor = factors.of_strength(joint)
            yield DesignValue(SYMBOLS[name], where, value, word, value / divisor, "Pa")
    for one in model.interfaces:
        if isinstance(one.joint, Tie | Dowel):
            word, divisor = factors.of_strength(one.joint)
            most = one.joint.strength * float(areas(one.polygon))
            yield DesignValue("F", one.name, most, word, most / divisor, "N")


def _strengths(joint: Joint) -> dict[str, float]:
    """Strengths of a joint by name, Pa; the tensile one as it counts, or less friction adds to it."""
    found = {name: getattr(joint, name, None) for name in STRENGTHS}
    found["tensile_strength"] = getattr(joint, "counted_tension", found["tensile_strength"])
    return {name: value for name, value in found.items() if value}


def _joints(model: Model) -> dict[Joint, int]:
    """Joints of a model, each with the number of its interfaces."""
    found: dict[Joint, int] = {}
    for one in model.interfaces:
        joint = joint_of(one)
        found[joint] = found.get(joint, 0) + 1
    return found
