"""Faults of a file as lines for the user, each with its place; the same for every kind of file."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from reprlib import repr as _value
from textwrap import shorten
from typing import TYPE_CHECKING, Any, TypeVar, get_args, get_origin

import numpy as np

from limitblocks.errors import MOST_PROBLEMS, ModelError, near

if TYPE_CHECKING:
    from limitblocks.io.block_documents import Document

__all__ = ["Faults", "named", "near", "validated"]

_LONGEST_LINE = 500
#: Faults after which no more are counted.
_COUNTED = 10_000
_MORE = re.compile(r"and \d+ more faults")
_COUNTS = {
    "too_long": "expected at most {max_length} entries",
    "too_short": "expected at least {min_length} entries",
}
#: What the JSON of a report says of itself.
REPORT = "limitblocks report"
D = TypeVar("D", bound="Document")


@contextmanager
def named(path: Path) -> Iterator[None]:
    """Put the name of the file before each fault found within."""
    try:
        with np.errstate(all="ignore"):  # numbers out of all proportion end as a fault, not as a warning
            yield
    except ModelError as error:
        raise ModelError(*(_at(path, fault) for fault in error.problems)) from None


def _at(path: Path, fault: str) -> str:
    said = fault if _MORE.fullmatch(fault) else f"{path}: {fault}"
    return shorten(said, _LONGEST_LINE, placeholder=" ...")


def refuse_report(data: Any, needed: str) -> None:
    """Refuse the JSON of a report where a model or a result is `needed`."""
    if isinstance(data, dict) and data.get("format") == REPORT:
        raise ModelError(f"is a report, which nothing is read from; {needed} is needed")


def validated(form: type[D], text: str, data: Any) -> D:
    """Return the document of the given form in JSON `text`, which parses to `data`.

    Raises
    ------
    ModelError
        With every fault in keys and types, and its place.
    """
    from pydantic import ValidationError  # here, to keep `import limitblocks` quick

    try:
        return form.model_validate_json(text)
    except ValidationError as error:
        faults = error.errors(include_url=False)
    # of a list the first fault alone is told, so its parts are looked at one by one
    parts = {key: _part_of(form, key) for key in form.model_fields}
    lists = [
        key for key in parts if parts[key] and isinstance(data, dict) and isinstance(data.get(key), list)
    ]
    lines: list[str] = []
    for fault in faults:
        if fault["loc"][:1] not in [(key,) for key in lists] or len(fault["loc"]) == 1:
            _tell(lines, "", fault, data, form)
    for key in lists:
        _tell_parts(lines, key, data[key], parts[key], form)
    raise ModelError(*lines)


def _tell(lines: list[str], place: str, fault: Any, data: Any, form: type[Document]) -> None:
    """Add the line of a fault; an empty one where it is counted only."""
    if len(lines) >= MOST_PROBLEMS:
        lines.append("")
        return
    within = _place(fault["loc"], data)
    dot = "." * bool(place and within and not within.startswith("["))
    lines.append(f"{place}{dot}{within or (place and ': ')}{_said(fault, form, place)}")


def _part_of(form: type[Document], key: str) -> Any:
    """Return what checks one part of the list that stands under `key`; None where there is no list."""
    from pydantic import TypeAdapter

    waiting = [form.model_fields[key].annotation]
    while waiting:
        one = waiting.pop()
        if get_origin(one) is list:
            return TypeAdapter(get_args(one)[0])
        waiting += [arg for arg in get_args(one) if get_args(arg)]
    return None


def _tell_parts(lines: list[str], key: str, parts: list[Any], adapter: Any, form: type[Document]) -> None:
    """Add the lines of the faults of the parts of a list."""
    from pydantic import ValidationError

    for k, part in enumerate(parts):
        if len(lines) >= _COUNTED:
            return
        try:
            adapter.validate_json(json.dumps(part), strict=True)  # as a part of a document is
        except ValidationError as error:
            for fault in error.errors(include_url=False):
                _tell(lines, f"{key}[{k}]", fault, part, form)


class Faults(list[str]):
    """Faults with their places, gathered from parts that are made one by one."""

    def made(self, place: str, make: Callable[..., Any], *arguments: Any) -> Any:
        """Return what `make` gives, or None and note why not."""
        try:
            return make(*arguments)
        except ModelError as error:
            self.extend(f"{place}: {fault}" for fault in error.problems)

    def all_made(self, key: str, make: Callable[..., Any], parts: Iterable[Any], *more: Any) -> list[Any]:
        """Return what `make` gives for each part."""
        return [self.made(f"{key}[{k}]", make, part, *more) for k, part in enumerate(parts)]


def _place(steps: tuple[int | str, ...], data: Any) -> str:
    """Path to a fault as the user would write it; pydantic's own steps into unions are not in `data`."""
    path = ""
    for step in steps:
        if isinstance(data, list) and isinstance(step, int):
            path += f"[{step}]"
            data = data[step] if step < len(data) else None
        elif isinstance(data, dict) and (step in data or step == steps[-1]):
            path += f".{step}"
            data = data.get(step)
    return f"{path.lstrip('.')}: " if path else ""


def _said(fault: Any, form: type[Document], within: str) -> str:
    """What pydantic found `within` a part of a list, or the whole file, in a sentence for the user."""
    context = fault.get("ctx", {})
    match fault["type"]:
        case "missing":
            return "is missing"
        case "extra_forbidden":
            key, top = str(fault["loc"][-1]), not within and len(fault["loc"]) == 1
            return f"unknown key{_meant(key, form, top)}"
        case "union_tag_not_found":
            return "type is missing"
        case "union_tag_invalid":
            own = "; no file can tell a joint of your own" if fault["loc"][:1] == ("joints",) else ""
            return f"type {_value(context['tag'])} is unknown; expected {context['expected_tags']}{own}"
        case "json_invalid":
            return f"not JSON: {context['error']}"
        case "value_error":
            return str(context["error"])
        case "less_than" | "greater_than":
            return f"expected a number less than 1e30 in size, not {_value(fault['input'])}"
        case "tuple_type" | "list_type":
            return f"expected a list [...], not {_value(fault['input'])}"
        case "model_type" | "model_attributes_type" | "dict_type":
            return f"expected an object {{...}}, not {_value(fault['input'])}"
        case _:
            return f"{_expected(fault)}, not {_value(fault['input'])}{_newer(fault)}"


def _meant(key: str, form: type[Document], top: bool) -> str:
    """What was meant by an unknown key: one like it, or that it stands in the wrong place."""
    homes = _homes(form)
    alike = near(key, form.model_fields if top else {*homes} - {key})
    if homes.get(key) and not (top and alike):
        return f" here; it belongs in {' or '.join(map(repr, homes[key]))}"
    return alike


def _expected(fault: Any) -> str:
    """What pydantic expected; its own words where a user knows them."""
    if fault["type"] == "string_type" and fault["loc"][-1:] == ("joint",):
        return "expected the name of one of the joints"
    if fault["type"] in _COUNTS:
        return _COUNTS[fault["type"]].format(**fault["ctx"])
    said = fault["msg"].partition(", unable to parse")[0]
    return str(said.replace("Input should be", "expected").replace(" valid", ""))


def _newer(fault: Any) -> str:
    """Why a version is none that can be read, where it is a later one."""
    later = fault["loc"] == ("schema_version",) and isinstance(fault["input"], int) and fault["input"] > 1
    return ": written by a newer version of limitblocks, which reads it" * later


@cache
def _homes(form: type[Document]) -> dict[str, list[str]]:
    """Every key of a file, with the keys whose objects may have it; none of what stands at the top."""
    schema = form.model_json_schema()
    kinds = {f'"#/$defs/{name}"': part for name, part in schema.get("$defs", {}).items()}
    homes: dict[str, set[str]] = {}
    for part in (schema, *kinds.values()):
        for home, held in part.get("properties", {}).items():
            homes.setdefault(home, set())
            inner = [kind for ref, kind in kinds.items() if ref in json.dumps(held)]
            for key in {key for kind in inner for key in kind.get("properties", ())}:
                homes.setdefault(key, set()).add(home)
    return {key: sorted(found) for key, found in homes.items()}
