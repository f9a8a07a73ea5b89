"""The result file: what an analysis found, as JSON that anybody's program can write and check."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from importlib import metadata
from math import isclose
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from limitblocks.arrays import Array, read_only
from limitblocks.errors import ModelError, path_of
from limitblocks.evidence.claim import Claim
from limitblocks.io import faults, strict_json
from limitblocks.kinds import KINDS, kind_of, named
from limitblocks.model import Model
from limitblocks.problem import turning_of
from limitblocks.written import write

if TYPE_CHECKING:
    from limitblocks.io.result_documents import BoundsDocument, ResultDocument

RESULT_SCHEMA_VERSION = 1
_STATED = ("limitblocks", "numpy", "scipy", "cvxpy", "clarabel")
_STILL = (0.0,) * 6
_CLAIMS = "expected the result of bounds, nonassociated or path"
_PARTIAL = f"holds a {{}} that is not all there; {_CLAIMS}"
_NO_CLAIM = {  # where more can be said
    "range": f"holds a range of load factors that is not all there; {_CLAIMS}, or one of its answers, which "
    'has its own under "solution"',
    "study": f"holds a study, the load factors of many models; {_CLAIMS}",
    "stability": "holds the answer whether the dead loads stand, no load factor, and not all of it; "
    f"{_CLAIMS}",
}


class Result(Protocol):
    """What every analysis returns has at least this."""

    def to_dict(self) -> dict[str, Any]:
        """Return the result as plain numbers, lists and text."""


def read_result(file: str | Path, model: Model | None = None) -> Any:
    """Return the result in `file`, a JSON document as described in docs/result-file.md.

    It is of the class that was saved, such as :class:`limitblocks.results.Nonassociated`, where the file has
    all that the class needs; else, as of another program, a :class:`limitblocks.results.Claim`. Nothing in
    the file is evidence: :func:`limitblocks.check_mcp` says whether it is a solution, and reports judge its
    numbers anew.

    Parameters
    ----------
    file : str or Path
        Name of the file: a result of limitblocks, written by hand, or by another program.
    model : Model, optional
        The model it is a result of; needed where the file gives stress resultants by interface name.

    Raises
    ------
    ModelError
        The file cannot be read, what it says is wrong, or it belongs to another model; `problems` has one
        line per fault, each with the file and the place in it.
    """
    path = path_of(file)
    with faults.named(path):
        text = strict_json.read_text(path)
        data = strict_json.parse(text)
        made, lacks = _made(data)
        kind = kind_of(made)
        if made is not None:
            _refuse_copies(data, strict_json.finite(made.to_dict()))
        if kind and not kind.document:  # no claimed solution
            from limitblocks.io.result_documents import VersionedDocument  # here, as pydantic takes its time

            faults.validated(VersionedDocument, text, data)
            _refuse_other(model, made.digest, data.get("versions"))
            return made
        claim = _claim(_document(text, data, lacks), model, data.get("versions"))
        return claim if made is None else made


def write_result(result: Result, file: str | Path, *, overwrite: bool = False) -> Path:
    """Write the result of an analysis to a JSON file and return its path.

    Raises
    ------
    LimitBlocksError
        If the file exists and `overwrite` is false, or it cannot be written.
    """
    return write(file, result_text(result) + "\n", overwrite)


def result_text(result: Result) -> str:
    """Return the text of the result file; undefined and infinite numbers are null."""
    return headed_text(result.to_dict())


def headed_text(numbers: dict[str, Any]) -> str:
    """Return numbers as JSON below the versions that they are of."""
    head = {"schema_version": RESULT_SCHEMA_VERSION, "versions": versions()}
    return strict_json.text(head | numbers)


def versions() -> dict[str, str]:
    """Return the versions of limitblocks and of the packages its numbers come from."""
    return {name: metadata.version(name) for name in _STATED}


def _made(data: Any) -> tuple[Any, str]:
    """The result as its own class; None and what the file lacks, where it lacks something."""
    from limitblocks.io.saved import Lacking, result_of  # here, to keep `import limitblocks` quick

    try:
        return result_of(data), ""
    except Lacking as lacking:
        return None, str(lacking)


def _refuse_copies(said: Any, made: Any, place: str = "") -> None:
    """Refuse a number that does not follow from the others, such as a load factor told twice."""
    if isinstance(said, dict) and isinstance(made, dict):
        for key in said.keys() & made.keys():
            _refuse_copies(said[key], made[key], f"{place}.{key}" if place else key)
    elif isinstance(said, list) and isinstance(made, list) and len(said) == len(made):
        for k, (one, other) in enumerate(zip(said, made, strict=True)):
            _refuse_copies(one, other, f"{place}.{k}")
    elif isinstance(said, str) and isinstance(made, str):  # earlier versions may have worded it otherwise
        return
    elif said != made and not (isinstance(said, float) and isinstance(made, float) and isclose(said, made)):
        raise ModelError(f"{place} is {said!r}, but by what else the file says it is {made!r}")


def _refuse_other(model: Model | None, digest: str, stated: Any) -> None:
    if model and digest and digest != model.digest:
        said = f"belongs to model {digest[:12]}, not to this model {model.digest[:12]}"
        saved = stated.get("limitblocks") if isinstance(stated, dict) else None
        own = versions()["limitblocks"]
        if saved and saved != own:
            said += (
                f"; it was saved by limitblocks {saved}, this is limitblocks {own}, which may know the same "
                "model by another digest: analyse it again"
            )
        raise ModelError(said)


def _document(text: str, data: Any, lacks: str) -> ResultDocument | BoundsDocument:
    if isinstance(data, dict) and "blocks" in data and not data.keys() & {"analysis", "stress_resultants"}:
        raise ModelError("is a model, not a result; the model comes first, then the result")
    faults.refuse_report(data, "a result file")
    word = data.get("analysis") if isinstance(data, dict) else None
    kind = KINDS.get(word) if isinstance(word, str) else None
    if word == "study" or (kind and not kind.document):
        raise ModelError(f"{_NO_CLAIM.get(str(word), _PARTIAL.format(word))} ({lacks})")
    document = faults.validated(named((kind or KINDS["nonassociated"]).document), text, data)
    found: ResultDocument | BoundsDocument = getattr(document, "collapse", document)
    return found


def _claim(document: ResultDocument | BoundsDocument, model: Model | None, stated: Any) -> Claim:
    digest = document.model_digest
    _refuse_other(model, digest, stated)
    wrong = faults.Faults()
    interfaces = [interface.name for interface in model.interfaces] if model else None
    resultants = wrong.made("stress_resultants", _rows, document.stress_resultants, interfaces)
    blocks = [block.name for block in model.blocks] if model else None
    still = model.supports if model else ()
    rates = wrong.made("displacement_rates", _rows, document.displacement_rates, blocks, still)
    if wrong:
        raise ModelError(*wrong)
    return Claim(
        load_factor=document.load_factor,
        stress_resultants=resultants,
        displacement_rates=rates,
        flow_multipliers=_array(document.flow_multipliers),
        generalised_stresses=_array(document.generalised_stresses),
        dead_load_stresses=_array(document.dead_load_stresses),
        dilatancy=document.dilatancy,
        turning=turning_of(document.turning),
        upper=getattr(document, "upper", None),
        proven=getattr(document, "proven", False),
        digest=digest,
    )


def _array(numbers: list[float] | None) -> Array | None:
    return None if numbers is None else read_only(numbers)


def _rows(given: Any, names: list[str] | None, still: Sequence[str] = ()) -> Array | None:
    """Rows of six in the order of `names`; those of `still` may be left out and are zero."""
    if given is None:
        return None
    if isinstance(given, dict):
        if names is None:
            raise ModelError("is given by name, which takes the model to put in order; give the model too")
        twice = [name for name, count in Counter(names).items() if count > 1]
        wrong = [f"two are named {name!r} in the model; give a list in its order" for name in twice]
        known = set(names)
        wrong += [_unknown(name, known) for name in given if name not in known]
        wrong += [f"{name!r} is missing" for name in names if name not in given and name not in still]
        if wrong:
            raise ModelError(*wrong)
        given = [given.get(name, _STILL) for name in names]
    return read_only(given).reshape(-1, 6)


def _unknown(name: str, known: set[str]) -> str:
    """A line for a name that the model does not have; it may have the interface the other way round."""
    i, bar, j = name.partition("|")
    if bar and (turned := f"{j}|{i}") in known:
        return f"no {name!r} in the model, but {turned!r}: forces on {j!r}, n out of it"
    return f"no {name!r} in the model{faults.near(name, known)}"
