"""What a report says of bounds, non-associated solutions and load paths."""

from __future__ import annotations

from math import isfinite

from limitblocks.errors import few
from limitblocks.evidence.associated import Bounds
from limitblocks.evidence.load_path_result import LoadPath
from limitblocks.evidence.proof import Proof
from limitblocks.evidence.residuals import OF_BOUNDS
from limitblocks.evidence.results import Nonassociated
from limitblocks.model import Model
from limitblocks.reports.curve import convergence_curve, path_curve
from limitblocks.reports.document import Table
from limitblocks.reports.rows import AS_READ, SHOWN, Row, backward, far, limits, loose
from limitblocks.reports.section import Design, Section
from limitblocks.reports.words import at_least, at_most, cut, figures
from limitblocks.shown import many

ASSOCIATED = "joints dilate by the friction angle: no solution is higher"
NONASSOCIATED = "joints follow the flow rule stated: a collapse that can happen, not the only one"
HISTORY = "the collapse that the live load reaches as it grows from nothing; other histories may reach others"
SNAP = "load factors before and after, at one displacement of the live load"


def bounds_section(model: Model, bounds: Bounds) -> Section:
    """Return the section of bounds."""
    static, kinematic = bounds.solvers
    return Section(
        title="Associated bounds",
        meaning=(
            "If sliding and twisting dilated the joints by the friction angle (associated flow), the "
            "structure would collapse at a load factor between the static value, of stresses in equilibrium "
            "within the yield surface, and the kinematic value, of a mechanism. Each is judged by itself; "
            "where they agree, both are proven for the yield surface of the joints. Real joints dilate less: "
            "their load factor is at most this one and can be smaller."
        ),
        headline=cut(bounds.lower),
        values=(
            ("Static load factor", at_least(bounds.lower), f"lower bound, {static}"),
            ("Kinematic load factor", at_most(bounds.upper), f"upper bound, {kinematic}"),
            ("Gap", f"{bounds.gap:.1e}", "difference over the load factor"),
            ("Proven", *_proven(bounds.proof)),
        ),
        judged=(bounds.residuals, bounds.tolerance),
        rates=bounds.displacement_rates,
        warnings=bounds.remarks + loose(bounds.tolerance, OF_BOUNDS),
        upper=bounds.upper,
        compared=(("Associated", at_most(bounds.upper), ASSOCIATED),),
    )


def nonassociated_section(model: Model, result: Nonassociated) -> Section:
    """Return the section of a non-associated solution."""
    flow = "do not lift" if result.dilatancy == 0.0 else f"lift by {result.dilatancy:g} of what they slide"
    near = "satisfy, for a model as near as was asked for," if result.accepted else "do not yet satisfy"
    proven = "together satisfy" if result.converged else near
    return Section(
        title="Non-associated solution" if result.converged else "Non-associated state, not converged",
        meaning=(
            f"Joints that slide or twist {flow}. Stresses, mechanism and multipliers {proven} equilibrium, "
            "yield, flow rule and complementarity, Eqs (54)-(59), at this load factor."
        ),
        headline="none found" if result.astray else cut(result.load_factor),
        values=(
            ("Load factor", figures(result.load_factor, 7), "others may solve too, within the next two"),
            *limits(result),
            ("Dilatancy", f"{result.dilatancy:g}", "tangent of the dilatancy angle"),
            ("Twist under bending", f"about the {result.turning.value}", "what it turns about"),
            ("Way", result.how, "which path led to this solution"),
            backward(result.backward_error),
            *_confirmation(result),
        ),
        judged=(result.residuals, result.tolerance),
        rates=result.displacement_rates,
        warnings=_remarks(result) + loose(result.tolerance),
        curve=convergence_curve(result.history),
        designs=_designs(result, "non-associated solution"),
        compared=_compared(result, "Non-associated", NONASSOCIATED),
    )


def path_section(model: Model, path: LoadPath) -> Section:
    """Return the section of a load path."""
    end = nonassociated_section(model, path.collapse)
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
            ("Load factor", figures(path.load_factor, 7), f"the last of {many(len(path.steps), 'step')}"),
            ("Peak", figures(path.peak, 7), "largest load factor along the path"),
            ("Tracked path", figures(path.tracked, 7), "; ".join(path.remarks)),
            *(
                ("Snap", f"{figures(one.before.load_factor, 7)} to {figures(one.after.load_factor, 7)}", SNAP)
                for one in path.snaps
            ),
            *end.values[1:5],
        ),
        judged=end.judged,
        rates=end.rates,
        warnings=end.warnings,
        parts=(_steps(path),),
        curve=path_curve(model, path),
        designs=_designs(path.collapse, "load path"),
        compared=_compared(path.collapse, "Load path", HISTORY),
    )


def _steps(path: LoadPath) -> Table:
    names = tuple(dict.fromkeys(name for step in path.steps for name in step.residuals))
    rows = tuple(
        (
            str(k),
            figures(step.load_factor, 6),
            *(f"{step.residuals.get(name, float('nan')):.1e}" for name in names),
            few([f"{interface} {mode}" for interface, mode in step.active], SHOWN),
        )
        for k, step in enumerate(path.steps)
    )
    heads = ("Step", "Load factor", *names, "Begins to flow")
    return Table.of("Steps of the load path", heads, rows, right=tuple(range(len(heads) - 1)))


def _designs(result: Nonassociated, source: str) -> tuple[Design, ...]:
    sound = result.accepted and isfinite(result.load_factor)
    design = Design(result.load_factor, source, _remarks(result), result.dilatancy)
    return (design,) if sound else ()


def _compared(result: Nonassociated, name: str, meaning: str) -> tuple[Row, ...]:
    unproven = "" if result.converged else "; not converged, so not proven"
    name += f", dilatancy {result.dilatancy:g}" if result.dilatancy else ""
    return (*limits(result), (name, figures(result.load_factor, 7), meaning + unproven))


def _proven(proof: Proof) -> tuple[str, str]:
    """Whether the bounds are theorems, and what that means, or why not."""
    if proof.complete:
        return "yes", "theorems about the numbers of the limit problem, rounding errors included"
    return "no", "; ".join(sorted({proof.static, proof.kinematic} - {""}))


def _confirmation(result: Nonassociated) -> tuple[Row, ...]:
    """The row of the table that says whether the state is a fixed point, where that is known."""
    change = result.fixed_point_change
    if change is None:
        return ()
    said = AS_READ if result.from_file else "change of the load factor with the flow frozen here"
    return (("Fixed point", f"{change:.1e}", said),)


def _remarks(result: Nonassociated) -> tuple[str, ...]:
    if not result.converged:
        return (result.status.value, *result.remarks)
    return result.remarks + far(result.backward_error)
