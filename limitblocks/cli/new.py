"""`limitblocks new`: model files of the generators in `limitblocks.structures`, parameters as options."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

import typer

from limitblocks import structures
from limitblocks.cli.answers import ask
from limitblocks.cli.errors import clean_errors, refuse_existing
from limitblocks.cli.joints import DEFAULT, Friction, JointName, Slip, Strength, make_joint
from limitblocks.cli.options import LIVE, Force
from limitblocks.cli.progress import of_stages
from limitblocks.cli.vectors import Command, vector

new = typer.Typer(rich_markup_mode=None)

NewFile = Annotated[
    Path | None,
    typer.Option("--output", "-o", metavar="MODEL", help="Model file (JSON) [default: STRUCTURE.json]."),
]
COMMON: dict[str, tuple[Any, Any]] = {
    "joint": (JointName, DEFAULT),
    "friction": (Friction, inspect.Parameter.empty),
    "slip": (Slip, None),
    "compressive_strength": (Strength, None),
    "output": (NewFile, None),
    "force": (Force, False),
}


def generators() -> dict[str, Callable[..., Any]]:
    """Return every public function of `limitblocks.structures` that takes a joint, by its name there."""
    named = ((name, getattr(structures, name)) for name in structures.__all__)
    return {
        name: make
        for name, make in named
        if inspect.isfunction(make) and "joint" in inspect.signature(make).parameters
    }


def command(make: Callable[..., Any]) -> Callable[..., None]:
    """Return a function for typer with those parameters of the generator that a command line can give."""
    own = {p.name: p for p in _options(make)}
    common = {
        name: inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=hint)
        for name, (hint, default) in COMMON.items()
    }

    def run(**values: Any) -> None:
        given = {name: values[name] for name in own if values[name] is not None and values[name] != []}
        with clean_errors():
            options = {option: values[option] for option in ("slip", "compressive_strength")}
            joint = make_joint(values["joint"], values["friction"], **options)
            file = values["output"] or Path(f"{make.__name__}.json")
            refuse_existing(file, values["force"])
            _ask_before(given)
            with of_stages(f"making {make.__name__}"):
                model = make(joint=joint, **given)
            ask(model)
            typer.echo(f"{model.save(file, overwrite=values['force'])}: {model}")

    parameters = {**own, **common}
    run.__name__ = make.__name__
    run.__signature__ = inspect.Signature(list(parameters.values()))  # type: ignore[attr-defined]
    run.__annotations__ = {name: parameter.annotation for name, parameter in parameters.items()}
    return run


def _ask_before(given: Mapping[str, Any]) -> None:
    """Ask about dimensions in mm, of which a structure of many blocks takes minutes to make."""
    from limitblocks.analysis.magnitudes_of_size import of_dimensions

    lengths = {
        f"--{name.replace('_', '-')}": value
        for name, value in given.items()
        if isinstance(value, float) and name != "unit_weight"  # angles are refused where they are so large
    }
    for question in of_dimensions(lengths):
        typer.echo(f"warning: {question}", err=True)


def left_out(make: Callable[..., Any]) -> list[str]:
    """Return the parameters of a generator that need Python."""
    offered = {"joint", *(parameter.name for parameter in _options(make))}
    return [name for name in inspect.signature(make).parameters if name not in offered]


def _options(make: Callable[..., Any]) -> Iterator[inspect.Parameter]:
    hints, said = get_type_hints(make), _texts(make)
    for name, parameter in inspect.signature(make).parameters.items():
        kind, settings, keeps_default = _kind(hints[name], parameter.default)
        if name == "joint" or kind is None:
            continue
        option = typer.Option(f"--{name.replace('_', '-')}", help=said.get(name, ""), **settings)
        if kind is bool:
            option = typer.Option(help=said.get(name, ""))
        elif kind is Any and not settings:
            shown = ",".join(f"{part:g}" for part in parameter.default)
            words = {"names": "X,Y,Z", "help": said.get(name, "")} if name != "direction" else LIVE
            alias = ("--live",) if name == "direction" else ()
            option = vector(*alias, f"--{name.replace('_', '-')}", **words, show_default=shown)
        default = parameter.default if keeps_default or parameter.default is parameter.empty else None
        yield inspect.Parameter(
            name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=Annotated[kind, option]
        )


def _kind(hint: Any, default: Any) -> tuple[Any, dict[str, Any], bool]:
    """Type for typer (None: not offered), settings of the option, whether typer gets the default."""
    kinds = get_args(hint) if get_origin(hint) in (Union, UnionType) else (hint,)
    kind = next(part for part in kinds if part is not NoneType)
    if kind in (float, int, bool, str) or get_origin(kind) is Literal:
        return hint, {"show_default": default not in (None, inspect.Parameter.empty)}, True
    if _is_record(kind):
        return Any, {**_record(kind), "show_default": False}, False
    if get_origin(kind) is not Sequence:
        return None, {}, False
    (part,) = get_args(kind)
    record = next((option for option in get_args(part) or (part,) if _is_record(option)), None)
    if record:
        return list[Any], {**_record(record), "show_default": False}, False
    if part is float and isinstance(default, tuple) and len(default) == 3:
        return Any, {}, True
    return None, {}, False


def _is_record(kind: Any) -> bool:
    return isinstance(kind, type) and issubclass(kind, tuple) and hasattr(kind, "_fields")


def _record(kind: Any) -> dict[str, Any]:
    """Settings of an option whose value is numbers with commas between them, the fields of a named tuple."""
    hints, least = get_type_hints(kind), len(kind._fields) - len(kind._field_defaults)
    names = [name.upper() for name in kind._fields]
    shown = ",".join(names[:least]) + "".join(f"[,{name}]" for name in names[least:])

    def parse(text: str) -> Any:
        words = text.split(",")
        if not least <= len(words) <= len(names):
            raise typer.BadParameter(f"{text!r}: expected {shown}")
        try:
            return kind(*(hints[name](word) for name, word in zip(kind._fields, words, strict=False)))
        except ValueError:
            raise typer.BadParameter(f"{text!r}: expected numbers, {shown}") from None

    return {"parser": parse, "metavar": shown}


def parameter_texts(doc: str) -> dict[str, str]:
    """Return what the section Parameters of a numpydoc docstring says of each parameter, on one line."""
    section = re.search(r"^Parameters\n-+\n(.*?)(?=^\w[^\n]*\n-+\n|\Z)", doc, re.MULTILINE | re.DOTALL)
    entries = re.findall(
        r"^(\w[^:\n]*) : [^\n]*\n((?:[ \t]+[^\n]*\n?|\n)*)", section[1] if section else "", re.M
    )
    texts: dict[str, str] = {}
    for names, text in entries:
        which = f"{names.replace('_', '-')}: " if "," in names else ""  # of several that share a text
        texts |= dict.fromkeys(names.split(", "), which + " ".join(text.split()))
    return texts


def _texts(make: Callable[..., Any]) -> dict[str, str]:
    """What is said of each parameter, there or in the generators that the docstring refers to."""
    doc = inspect.getdoc(make) or ""
    others = (getattr(structures, name, None) for name in re.findall(r":func:`(\w+)`", doc))
    texts: dict[str, str] = {}
    for text in (*(inspect.getdoc(other) or "" for other in others), doc):
        texts |= {name: said for name, said in parameter_texts(text).items() if "As for" not in said}
    return {name: _plain(said) for name, said in texts.items()}


def _plain(text: str) -> str:
    """Text without reStructuredText roles."""
    return re.sub(r":\w+:`~?([^`]*)`", r"\1", text)


for _make in generators().values():
    _about = (inspect.getdoc(_make) or "").split("\n\nParameters\n")[0].removeprefix("Return ")
    _about = _plain(_about[:1].upper() + _about[1:])
    if _rest := left_out(_make):
        _about += f"\n\nOnly in Python: {', '.join(_rest)}."
    new.command(_make.__name__.replace("_", "-"), help=_about, cls=Command)(command(_make))
