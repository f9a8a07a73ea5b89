"""What a report says of a check, of a claim with its check, and of stability."""

from __future__ import annotations

from math import isfinite

from limitblocks.errors import few
from limitblocks.evidence.check import Check
from limitblocks.evidence.stability_result import TOLERANCE as ARISEN
from limitblocks.evidence.stability_result import Stability
from limitblocks.model import Model
from limitblocks.reports.claims import CheckedClaim
from limitblocks.reports.rows import SHOWN, backward, far, loose, number
from limitblocks.reports.section import Design, Section
from limitblocks.reports.words import cut, figures

OF_LOADS = "of the largest dead load tied to an interface"


def check_section(_model: Model, check: Check) -> Section:
    """Return the section of a check."""
    source = "found by the checker, from the stresses alone" if check.mechanism_found else "as claimed"
    return Section(
        title="Check",
        meaning=(
            "A claimed solution put into Eqs (54)-(59) of the model, without a word from any solver. It is a "
            "solution if every residual is within the tolerance; that does not make it the only one."
        ),
        headline="passed" if check.passed else "near" if check.accepted else "failed",
        quantity=f"worst residual {check.worst.value:.1e} ({check.worst.name})",
        values=(
            ("Mechanism and multipliers", source, "by which the flow rule was checked"),
            backward(check.backward_error),
        ),
        judged=(check.residuals, check.tolerance),
        warnings=check.remarks
        + (far(check.backward_error) if check.passed else ())
        + loose(check.tolerance, check.usual),
    )


def claim_section(model: Model, claim: CheckedClaim) -> Section:
    """Return the section of a claim and its check."""
    check = check_section(model, claim.check)
    associated = not isfinite(claim.claim.dilatancy)
    flow = "associated: joints dilate by the friction angle" if associated else f"{claim.claim.dilatancy:g}"
    source = "by the checker, from the claimed state alone"
    most = claim.load_factor if claim.claim.upper is None else claim.claim.upper
    return Section(
        title=f"Claimed solution, check {check.headline}",
        meaning=f"A load factor and a state that were read, not computed here. {check.meaning}",
        headline=cut(claim.load_factor) if claim.check.accepted else "not proven",
        quantity="load factor α as claimed",
        values=(
            ("Load factor", number(claim.load_factor), "as claimed"),
            ("Check", check.headline, source),
            ("Dilatancy", flow, "tangent of the dilatancy angle"),
            *check.values,
        ),
        judged=check.judged,
        rates=claim.displacement_rates,
        warnings=check.warnings,
        designs=(
            Design(claim.load_factor, "claimed solution, checked", check.warnings, claim.claim.dilatancy),
        )
        if claim.certified
        else (),
        upper=most if claim.check.accepted and not claim.certified else None,
    )


def stability_section(_model: Model, answer: Stability) -> Section:
    """Return the section of the answer whether a structure stands."""
    return Section(
        title="Stability under the dead loads",
        meaning=(
            "The dead loads alone. Stresses within the yield surface that carry them are necessary for the "
            "structure to stand, and not sufficient: friction can hold what is wedged, and nothing may wedge "
            "it. It stands by itself where such stresses arise on unstressed blocks with slightly compliant "
            "joints that slide without lifting."
        ),
        headline=answer.kind.value.split(":")[0],
        quantity=f"with a margin of {answer.margin:.3g} {OF_LOADS}",
        values=(
            ("Answer", answer.kind.value.split(": ")[1], ""),
            ("Margin", figures(answer.margin, 4), f"{OF_LOADS}; at most 1"),
            ("Blocks that move", few(answer.blocks, SHOWN) or "none", ""),
        ),
        judged=(answer.residuals, ARISEN),
        rates=answer.displacement_rates,
        warnings=answer.remarks,
        own=not answer.stands,
        judges=not answer.stands,
    )
