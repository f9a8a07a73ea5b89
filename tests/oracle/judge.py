"""What the library says of a case, compared with the truth; calls nothing but the public interface."""

import json
from dataclasses import asdict, dataclass
from pathlib import Path

from coulomb import Truth, truth
from random_models import Case

import limitblocks as lb

RELATIVE = 1e-6  # what the library promises
PROVEN = (
    1e-14  # of the load factor: the truth is that of the geometry, the proof that of the assembled numbers
)
ROUNDING = 1e-14  # load factors are per weight: some 50 units in the last place of an equilibrium of weights
RECORD = Path(__file__).with_name("truths.json")
WRONG = (
    "lower too high",
    "upper too low",
    "number for falls",
    "number for unlimited",
    "says unlimited",
    "says falls",
    "exceeds the associated",
    "differs",
    "check fails",
)


@dataclass(frozen=True)
class Verdict:
    """`outcome` is "right", one of `WRONG`, "wide", "refused", "not converged", "crashed" or "undecided".

    `width` is that of a proven interval over the load factor; None where nothing is proven.
    """

    outcome: str
    said: str = ""
    width: float | None = None


def truth_of(case: Case, record: dict[str, dict] | None = None) -> Truth:
    """The truth by formula, from a record of earlier runs, or by the oracle; `interior` may be unknown."""
    if case.known is not None:
        return case.known
    digest = case.model.digest
    if record is not None and digest in record:
        return Truth(**record[digest])
    known = truth(case.model)
    if record is not None:
        record[digest] = asdict(known)
    return known


def recorded(file: Path = RECORD) -> dict[str, dict]:
    """Truths of earlier runs by digest of the model."""
    return json.loads(file.read_text(encoding="utf-8")) if file.exists() else {}


def write(record: dict[str, dict], file: Path = RECORD) -> None:
    rows = [f" {json.dumps(digest)}: {json.dumps(record[digest])}" for digest in sorted(record)]
    file.write_text("{\n" + ",\n".join(rows) + "\n}\n", encoding="utf-8")


def judged(model: lb.Model, expected: Truth) -> Verdict:
    """Compare `lb.bounds`, checked by `lb.check_mcp`, with the truth."""
    if expected.verdict == "undecided":
        return Verdict("undecided")
    try:
        result = lb.bounds(model)
    except (lb.errors.NoEquilibrium, lb.errors.UnlimitedLoad) as error:
        word = "falls" if isinstance(error, lb.errors.NoEquilibrium) else "unlimited"
        return Verdict("right" if expected.verdict == word else f"says {word}", str(error))
    except lb.errors.SolverFailure as error:
        return Verdict("refused", str(error))
    except Exception as error:
        return Verdict("crashed", f"{type(error).__name__}: {error}")
    said = f"{result.lower:.12g} to {result.upper:.12g}"
    if expected.verdict != "number":
        return Verdict(f"number for {expected.verdict}", said)
    value = expected.load_factor
    slack = (PROVEN if result.proven else RELATIVE) * value + ROUNDING
    said += f", truth {value:.12g}"
    if result.lower > value + slack:
        return Verdict("lower too high", said)
    if result.upper < value - slack:
        return Verdict("upper too low", said)
    width = result.upper - result.lower
    # bounds that hold but lie farther apart than the library promises
    wide = width > 2 * (RELATIVE * value + ROUNDING)
    silent = result.residuals.worst.value <= result.tolerance  # else the bounds say themselves how far off
    if not wide and silent and not lb.check_mcp(model, result).passed:
        return Verdict("check fails", said)
    return Verdict("wide" if wide else "right", said, width / value if result.proven and value else None)


def judged_nonassociated(case: Case, expected: Truth) -> Verdict:
    """Compare `lb.nonassociated`, checked by `lb.check_mcp`, with the associated truth."""
    if expected.verdict == "undecided":
        return Verdict("undecided")
    try:
        result = lb.nonassociated(case.model)
        passed = lb.check_mcp(case.model, result).passed
    except lb.errors.NoEquilibrium as error:
        return Verdict("right" if expected.verdict == "falls" else "says falls", str(error))
    except lb.NotConverged as error:
        return Verdict("not converged", str(error))
    except lb.SolveError as error:
        return Verdict("refused", str(error))
    except Exception as error:
        return Verdict("crashed", f"{type(error).__name__}: {error}")
    said = f"{result.load_factor:.12g}, associated truth {expected.load_factor:.12g}"
    if expected.verdict == "falls":
        return Verdict("number for falls", said)
    if not passed:
        return Verdict("check fails", said)
    return Verdict(_nonassociated_number(case, expected, result.load_factor), said)


def _nonassociated_number(case: Case, expected: Truth, value: float) -> str:
    if expected.verdict == "unlimited":
        return "right"
    slack = RELATIVE * expected.load_factor + ROUNDING
    if value > expected.load_factor + slack:
        return "exceeds the associated"
    # a single block on its own is statically determinate: no dilatancy in its load factor, sliding or rocking
    alone = case.kind == "forest" and len(case.model.free_blocks) == 1
    return "differs" if alone and value < expected.load_factor - 10 * slack else "right"
