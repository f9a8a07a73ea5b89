"""What a report says of each kind of result, in the same few fields."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from math import isfinite, isnan
from typing import Any

from limitblocks.errors import LimitBlocksError
from limitblocks.evidence import check as mcp
from limitblocks.evidence.associated import Bounds
from limitblocks.evidence.backward_error import BackwardError
from limitblocks.evidence.claim import Claim
from limitblocks.evidence.load_path_result import LoadPath
from limitblocks.evidence.proof import Proof
from limitblocks.evidence.range_result import LoadFactorRange
from limitblocks.evidence.residuals import TOLERANCE
from limitblocks.evidence.results import Nonassociated
from limitblocks.evidence.stability_result import TOLERANCE as ARISEN
from limitblocks.evidence.stability_result import Stability
from limitblocks.model import Model
from limitblocks.reports.as_read import AS_READ, as_read
from limitblocks.reports.claims import USUAL_OF_BOUNDS, CheckedClaim
from limitblocks.reports.curve import convergence_curve, path_curve
from limitblocks.reports.document import Table
from limitblocks.reports.practice_sections import KINDS, of_practice
from limitblocks.reports.range_section import range_section
from limitblocks.reports.section import Section, checks_of

_ACTIVE_SHOWN = 4


def section(model: Model, result: Any) -> Section:
    """Return what a report says of `result`.

    Raises
    ------
    LimitBlocksError
        The result is of a kind unknown to reports, or belongs to another model.
    """
    make = _SECTIONS.get(type(result)) or of_practice(result)
    if make is None:
        known = ", ".join([*sorted(kind.__name__ for kind in _SECTIONS if kind is not CheckedClaim), *KINDS])
        raise LimitBlocksError(f"a report cannot show {type(result).__name__}; expected a result: {known}")
    if getattr(getattr(result, "collapse", result), "digest", model.digest) != model.digest:
        kind = type(result).__name__
        raise LimitBlocksError(f"this {kind} belongs to another model; give the model it is a result of")
    return as_read(make(model, result), result)


def drawn(results: Iterable[Any], sections: Iterable[Section]) -> Section | None:
    """The section whose mechanism is drawn: the first of its kind would do, one says enough."""
    kinds = {type(result): made for result, made in zip(results, sections, strict=True)}
    return next((made for kind in _SECTIONS if (made := kinds.get(kind)) and made.rates is not None), None)


def shown(result: Any) -> bool:
    """Whether reports know this kind of result; a claim they check first."""
    return isinstance(result, (*_SECTIONS, Claim))


def limits(result: Nonassociated) -> tuple[tuple[str, str, str], tuple[str, str, str]]:
    """Return name, value and meaning of the load factors that no solution is below and above."""
    lower, upper = result.frictionless, result.associated
    if result.from_file:
        least = "not claimed" if isnan(lower) else _number(lower)
        return ("Frictionless", least, AS_READ), ("Associated", _number(upper), AS_READ)
    return (
        ("Frictionless", "not claimed", result.unclaimed)
        if isnan(lower)
        else ("Frictionless", _number(lower), "joints carry no shear: no solution is lower"),
        ("Associated", _number(upper), "joints dilate by the friction angle: no solution is higher")
        if isfinite(upper)
        else ("Associated", _number(upper), "dilating joints jam under this load: nothing is known above"),
    )


def _number(load_factor: float) -> str:
    return f"{load_factor:#.7g}" if isfinite(load_factor) else "unlimited"


def _bounds(_model: Model, bounds: Bounds) -> Section:
    static, kinematic = bounds.solvers
    return Section(
        title="Associated bounds",
        meaning=(
            "If sliding and twisting dilated the joints by the friction angle (associated flow), the "
            "structure would collapse at a load factor between the static value, of stresses in equilibrium "
            "within the yield surface, and the kinematic value, of a mechanism. Each is solved by itself; "
            "where they agree, both are proven for the yield surface below. Real joints dilate less: their "
            "load factor is at most this one and can be smaller."
        ),
        headline=f"{bounds.lower:#.4g}",
        values=(
            ("Static load factor", f"{bounds.lower:#.7g}", f"lower bound, {static}"),
            ("Kinematic load factor", f"{bounds.upper:#.7g}", f"upper bound, {kinematic}"),
            ("Gap", f"{bounds.gap:.1e}", "difference over the load factor"),
            ("Proven", *_proven(bounds.proof)),
        ),
        checks=checks_of(bounds.residuals, bounds.tolerance),
        tolerance=bounds.tolerance,
        rates=bounds.displacement_rates,
        warnings=_loose(bounds.tolerance, USUAL_OF_BOUNDS),
    )


def _nonassociated(_model: Model, result: Nonassociated) -> Section:
    flow = "do not lift" if result.dilatancy == 0.0 else f"lift by {result.dilatancy:g} of what they slide"
    near = "satisfy, for a model as near as was asked for," if result.accepted else "do not yet satisfy"
    proven = "together satisfy" if result.converged else near
    return Section(
        title="Non-associated solution" if result.converged else "Non-associated state, not converged",
        meaning=(
            f"Joints that slide or twist {flow}. Stresses, mechanism and multipliers {proven} equilibrium, "
            "yield, flow rule and complementarity, Eqs (54)-(59), at this load factor."
        ),
        headline=f"{result.load_factor:#.4g}",
        values=(
            ("Load factor", f"{result.load_factor:#.7g}", "others may solve too, within the next two"),
            *limits(result),
            ("Dilatancy", f"{result.dilatancy:g}", "tangent of the dilatancy angle"),
            ("Twist under bending", f"about the {result.turning.value}", "what it turns about"),
            ("Way", result.how, "which path led to this solution"),
            _backward(result.backward_error),
            *_confirmation(result),
        ),
        checks=checks_of(result.residuals, result.tolerance),
        tolerance=result.tolerance,
        rates=result.displacement_rates,
        warnings=_remarks(result) + _loose(result.tolerance),
        curve=convergence_curve(result.history),
    )


SNAP = "load factors before and after, at one displacement of the live load"


def _path(model: Model, path: LoadPath) -> Section:
    end = _nonassociated(model, path.collapse)
    told = ", as the file says" if path.from_file else ""
    last = "is a collapse" if path.collapse.converged else "is not yet a collapse"
    return Section(
        title="Load path" if path.collapse.converged else "Load path, not converged",
        meaning=(
            "The live load grows from nothing, in steps, on the structure under its permanent loads; every "
            f"step is in equilibrium and within the yield surface{told}, and the last {last}, Eqs (54)-(59). "
            "Displacements before collapse are relative to the compliance of the joints."
        ),
        headline=end.headline,
        values=(
            ("Load factor", f"{path.load_factor:#.7g}", f"the last of {len(path.steps)} steps"),
            ("Peak", f"{path.peak:#.7g}", "largest load factor along the path"),
            ("Tracked path", f"{path.tracked:#.7g}", "; ".join(path.remarks)),
            *(
                ("Snap", f"{one.before.load_factor:#.7g} to {one.after.load_factor:#.7g}", SNAP)
                for one in path.snaps
            ),
            *end.values[1:5],
        ),
        checks=end.checks,
        tolerance=end.tolerance,
        rates=end.rates,
        warnings=end.warnings,
        parts=(_steps(path),),
        curve=path_curve(model, path),
    )


def _steps(path: LoadPath) -> Table:
    names = tuple(dict.fromkeys(name for step in path.steps for name in step.residuals))
    rows = tuple(
        (
            str(k),
            f"{step.load_factor:#.6g}",
            *(f"{step.residuals.get(name, float('nan')):.1e}" for name in names),
            _some([f"{interface} {mode}" for interface, mode in step.active]),
        )
        for k, step in enumerate(path.steps)
    )
    heads = ("Step", "Load factor", *names, "Begins to flow")
    return Table.of("Steps of the load path", heads, rows, right=tuple(range(len(heads) - 1)))


def _check(_model: Model, check: mcp.Check) -> Section:
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
            _backward(check.backward_error),
        ),
        checks=checks_of(check.residuals, check.tolerance),
        tolerance=check.tolerance,
        warnings=check.remarks + _loose(check.tolerance),
    )


def _claim(model: Model, claim: CheckedClaim) -> Section:
    check = _check(model, claim.check)
    associated = not isfinite(claim.claim.dilatancy)
    flow = "associated: joints dilate by the friction angle" if associated else f"{claim.claim.dilatancy:g}"
    source = "by the checker, from the claimed state alone"
    return Section(
        title=f"Claimed solution, check {check.headline}",
        meaning=f"A load factor and a state that were read, not computed here. {check.meaning}",
        headline=f"{claim.load_factor:#.4g}" if claim.check.accepted else "not proven",
        quantity="load factor α as claimed",
        values=(
            ("Load factor", _number(claim.load_factor), "as claimed"),
            ("Check", check.headline, source),
            ("Dilatancy", flow, "tangent of the dilatancy angle"),
            *check.values,
        ),
        checks=check.checks,
        tolerance=check.tolerance,
        rates=claim.displacement_rates,
        warnings=check.warnings,
    )


def _stability(_model: Model, answer: Stability) -> Section:
    return Section(
        title="Stability under the dead loads",
        meaning=(
            "The dead loads alone. Stresses within the yield surface that carry them are necessary for the "
            "structure to stand, and not sufficient: friction can hold what is wedged, and nothing may wedge "
            "it. It stands by itself where such stresses arise on unstressed blocks with slightly compliant "
            "joints that slide without lifting."
        ),
        headline=answer.kind.value.split(":")[0],
        quantity=f"margin {answer.margin:.3g} of the weight",
        values=(
            ("Answer", answer.kind.value.split(": ")[1], ""),
            ("Margin", f"{answer.margin:#.4g}", "of the largest dead load tied to an interface; at most 1"),
            ("Blocks that move", _some(list(answer.blocks)) or "none", ""),
        ),
        checks=checks_of(answer.residuals, ARISEN),
        tolerance=ARISEN,
        rates=answer.displacement_rates,
    )


def _range(_model: Model, result: LoadFactorRange) -> Section:
    return range_section(result, limits)


def _backward(error: BackwardError) -> tuple[str, str, str]:
    parts = ", ".join(f"{part.name} {part.value:.1e}" for part in error.parts)
    where = _some([f"{name} ({change:.1e})" for name, change in error.places])
    said = f"exact for a model changed by as much: {parts}" + (f"; most at {where}" if where else "")
    return "Backward error", f"{error.value:.1e}", said


def _proven(proof: Proof) -> tuple[str, str]:
    """Whether the bounds are theorems, and what that means, or why not."""
    if proof.complete:
        return "yes", "theorems about the numbers of the limit problem, rounding errors included"
    return "no", "; ".join(sorted({proof.static, proof.kinematic} - {""}))


def _confirmation(result: Nonassociated) -> tuple[tuple[str, str, str], ...]:
    """The row of the table that says whether the state is a fixed point, where that is known."""
    change = result.fixed_point_change
    if change is None:
        return ()
    said = AS_READ if result.from_file else "change of the load factor with the flow frozen here"
    return (("Fixed point", f"{change:.1e}", said),)


def _remarks(result: Nonassociated) -> tuple[str, ...]:
    return (() if result.converged else (result.status.value,)) + result.remarks


def _loose(tolerance: float, usual: float = TOLERANCE) -> tuple[str, ...]:
    said = f"the tolerance {tolerance:.1e} is looser than the usual {usual:.1e}"
    return (said,) if tolerance > usual else ()


def _some(words: list[str]) -> str:
    more = len(words) - _ACTIVE_SHOWN
    return ", ".join(words[:_ACTIVE_SHOWN]) + (f" and {more} more" if more > 0 else "")


#: In the order in which one is chosen to be drawn.
_SECTIONS: dict[type, Callable[[Model, Any], Section]] = {
    Nonassociated: _nonassociated,
    LoadPath: _path,
    LoadFactorRange: _range,
    CheckedClaim: _claim,
    Bounds: _bounds,
    Stability: _stability,
    mcp.Check: _check,
}
