"""One vocabulary of joints for every command: the class names of the model file, written as words."""

from __future__ import annotations

import inspect
import re
from functools import cache
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from limitblocks.errors import ModelError

if TYPE_CHECKING:
    from limitblocks.joints import Joint

NAMES = ("exact-torsion", "orduna-lourenco", "point-contact")  # here so that --help need not load them
DEFAULT = "orduna-lourenco"


@cache
def joints() -> dict[str, Any]:
    """Return the class of every joint by its name on the command line."""
    from limitblocks.io.registry import JOINTS

    contacts = {name: kind for name, kind in JOINTS.items() if not hasattr(kind, "word")}  # no ties
    return {re.sub(r"(?<=[a-z])(?=[A-Z])", "-", name).lower(): kind for name, kind in contacts.items()}


def joint_name(text: str) -> str:
    """Return the name that `text` means: one of NAMES, or the class name as in a model file."""
    plain = {name.replace("-", ""): name for name in NAMES}
    name = plain.get(text.lower().replace("-", ""))
    if name is None:
        raise typer.BadParameter(f"{text!r} is no joint; expected one of {', '.join(NAMES)}")
    return name


def make_joint(name: str, friction: float, **options: Any) -> Joint:
    """Return the joint of that name; options that are None are left out.

    Raises
    ------
    ModelError
        An option is given that the joint does not have, or a value is wrong.
    """
    kind: Any = joints()[name]
    given = {option: value for option, value in options.items() if value is not None}
    for option in given.keys() - inspect.signature(kind).parameters:
        fit = [other for other, cls in joints().items() if option in inspect.signature(cls).parameters]
        raise ModelError(
            f"--{option.replace('_', '-')} is {given[option]!r}, but --joint {name} has no "
            f"{option.replace('_', ' ')}; leave it out or choose --joint {' or '.join(fit)}"
        )
    return kind(friction, **given)  # type: ignore[no-any-return]


JointName = Annotated[
    Any,
    typer.Option("--joint", parser=joint_name, metavar="|".join(NAMES), help="What an interface can carry."),
]
MaybeJoint = Annotated[
    Any,
    typer.Option(
        "--joint",
        parser=joint_name,
        metavar="|".join(NAMES),
        help=f"What every interface can carry [default: {DEFAULT}].",
        show_default=False,
    ),
]
Friction = Annotated[
    float, typer.Option(help="Coefficient of friction of every interface.", show_default=False)
]
MaybeFriction = Annotated[
    float | None, typer.Option("--friction", help="Coefficient of friction of every interface.")
]
Slip = Annotated[
    Literal["exact", "paper", "inner", "outer"] | None,
    typer.Option(
        help="Friction of orduna-lourenco: exact (Coulomb's circle), the paper's octagon, or an octagon "
        "within the circle or around it [default: exact].",
        show_default=False,
    ),
]
Strength = Annotated[
    float | None,
    typer.Option(help="Effective compressive strength, Pa [default: infinite].", show_default=False),
]
