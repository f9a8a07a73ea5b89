"""The verbs that analyse one model, and the check of a result."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import typer

from limitblocks.choices import Method, Turning
from limitblocks.cli import analyses
from limitblocks.cli.answers import NOTHING, Kept, answer, keeping, show
from limitblocks.cli.errors import clean_errors, refuse_existing
from limitblocks.cli.options import (
    Along,
    AsJson,
    BackwardLimit,
    ClaimFile,
    CsvFile,
    Dilatancy,
    Exact,
    Mechanisms,
    ModelFile,
    OwnTolerance,
    Paths,
    Seconds,
    Seed,
    SolutionTolerance,
    Tolerance,
    Turns,
    Way,
)
from limitblocks.errors import CheckFailed, ModelError, few

if TYPE_CHECKING:
    from limitblocks.evidence.check import Check
    from limitblocks.model import Model
    from limitblocks.results import Sensitivities

UNJUDGED = ["how answers were reached", "intervals between them", "unlimited load", "wedging", "proven ends"]
DEFAULT_TOLERANCE, BOUNDS_TOLERANCE = 1e-8, 1e-6  # as in Python


@keeping
def stability(model: ModelFile, kept: Kept = NOTHING) -> None:
    """Say whether the structure stands under its dead loads alone; exit code 1 unless it does by itself."""
    with clean_errors():
        found = answer(analyses.stability, model, kept)
    if not found.stands:
        raise typer.Exit(1)


@keeping
def bounds(
    model: ModelFile,
    tolerance: Tolerance = BOUNDS_TOLERANCE,
    kept: Kept = NOTHING,
) -> None:
    """Print the static and the kinematic bound on the associated load factor."""
    with clean_errors():
        answer(analyses.bounds, model, kept, tolerance=tolerance)


@keeping
def sensitivities(
    model: ModelFile,
    tolerance: Tolerance = BOUNDS_TOLERANCE,
    csv: CsvFile = None,
    kept: Kept = NOTHING,
) -> None:
    """Print the friction and the unit weights that govern the associated load factor, the largest first."""
    beside: list[Any] = []

    def solve(structure: Model, **settings: Any) -> Sensitivities:
        from limitblocks.analysis.sensitivities import sensitivities

        beside.append(analyses.bounds(structure, **settings))
        return sensitivities(structure, beside[0])

    with clean_errors():
        refuse_existing(csv, kept.force, model, kept.output, kept.filed, option="--csv")
        found = answer(solve, model, kept, beside, tolerance=tolerance)
        if csv:
            from limitblocks.studies.rows import write_csv

            write_csv(found.rows(), csv, overwrite=kept.force)


@keeping
def nonassociated(
    model: ModelFile,
    dilatancy: Dilatancy = 0.0,
    turning: Turns = Turning.CENTROID,
    method: Way = Method.PATH,
    tolerance: SolutionTolerance = DEFAULT_TOLERANCE,
    backward_error: BackwardLimit = None,
    kept: Kept = NOTHING,
) -> None:
    """Print a load factor for joints that slide without lifting, and its proof."""
    with clean_errors():
        flow: Any = {"dilatancy": dilatancy, "turning": turning, "tolerance": tolerance}
        flow |= {"method": method, "backward_error": backward_error}
        answer(analyses.nonassociated, model, kept, **flow)


@keeping
def path(
    model: ModelFile,
    dilatancy: Dilatancy = 0.0,
    turning: Turns = Turning.CENTROID,
    tolerance: SolutionTolerance = DEFAULT_TOLERANCE,
    along: Along = False,
    kept: Kept = NOTHING,
) -> None:
    """Print the steps from the permanent loads to collapse."""
    with clean_errors():
        flow: Any = {"dilatancy": dilatancy, "turning": turning, "tolerance": tolerance}
        snaps: Any = {"snaps": "along"} if along else {}
        answer(analyses.path, model, kept, **flow, **snaps)


@keeping
def load_factor_range(
    model: ModelFile,
    dilatancy: Dilatancy = 0.0,
    turning: Turns = Turning.CENTROID,
    paths: Paths = 15,
    mechanisms: Mechanisms = 100,
    seed: Seed = 0,
    time_limit: Seconds = 120.0,
    exact: Exact = False,
    kept: Kept = NOTHING,
) -> None:
    """Print certified load factors of many ways, and how far they reach."""
    with clean_errors():
        settings: Any = {"dilatancy": dilatancy, "turning": turning, "paths": paths}
        settings |= {"mechanisms": mechanisms, "seed": seed, "time_limit": time_limit, "exact": exact}
        answer(analyses.load_factor_range, model, kept, **settings)


def check(
    model: ModelFile,
    result: ClaimFile,
    tolerance: OwnTolerance = None,
    backward_error: BackwardLimit = None,
    as_json: AsJson = False,
) -> None:
    """Check a result file against Eqs (54)-(59) of its model; of a range every answer."""
    with clean_errors():
        from limitblocks.evidence.check import check_mcp
        from limitblocks.io import read, read_result
        from limitblocks.results import LoadFactorRange

        structure = read(model)
        claim = read_result(result, structure)
        judged = partial(check_mcp, structure, tolerance=tolerance, backward_error=backward_error)
        if isinstance(claim, LoadFactorRange):
            ends = [end.answer for end in (claim.least, claim.greatest) if end and end.answer]
            _require([(one.load_factor, judged(one.solution)) for one in (*claim.answers, *ends)], as_json)
            return
        checked = judged(claim)
        if not claim.digest:
            typer.echo(f"warning: {result} does not say which model it belongs to", err=True)
        show(structure, checked, as_json)
        checked.require()


def _require(checks: list[tuple[float, Check]], as_json: bool) -> None:
    """Print the checks of a range's answers, with their load factors; raise CheckFailed if one failed."""
    from limitblocks.io.result_file import headed_text

    if not checks:
        raise ModelError("the range has no answer that could be checked")
    failed = [load_factor for load_factor, one in checks if not one.accepted]
    if as_json:
        answers = [{"load_factor": load_factor, "check": one.to_dict()} for load_factor, one in checks]
        typer.echo(
            headed_text(
                {"analysis": "check", "accepted": not failed, "answers": answers, "unjudged": UNJUDGED}
            )
        )
    else:
        for load_factor, one in checks:
            typer.echo(f"load factor {load_factor:.6g}: {one}")
        typer.echo(f"as the file says, not judged: {', '.join(UNJUDGED)}")
    if failed:
        named = few([f"{load_factor:.6g}" for load_factor in failed])
        raise CheckFailed(f"{len(failed)} of {len(checks)} answers failed the check: load factor {named}")
