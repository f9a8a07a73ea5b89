"""The blocks of a model file as pydantic classes, and what all its parts share."""

from __future__ import annotations

from typing import Annotated, Any, Literal, TypeVar

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, model_validator
from pydantic_core import PydanticCustomError

# far beyond any structure, and its powers are still finite
Number = Annotated[float, Field(gt=-1e30, lt=1e30)]
Vector = tuple[Number, Number, Number]
Place = tuple[Number, Number]
T = TypeVar("T")
#: A list of which the first fault is told; a file of a million zeros would take gigabytes of them otherwise.
Many = Annotated[list[T], Field(fail_fast=True)]


def _no_truth(version: Any) -> Any:
    if isinstance(version, bool):  # True equals 1
        raise PydanticCustomError("literal_error", "Input should be 1")
    return version


Version = Annotated[Literal[1], BeforeValidator(_no_truth)]
_ONE_FORM = {"oneOf": [{"required": ["vertices", "faces"]}, {"required": ["box"]}, {"required": ["prism"]}]}


class Document(BaseModel):
    """Part of a model file: no unknown keys, no conversion of types, finite numbers."""

    model_config = ConfigDict(
        extra="forbid",
        strict=True,
        allow_inf_nan=False,
        use_attribute_docstrings=True,
        protected_namespaces=(),  # of `model_`, which model_digest begins with
    )


class Box(Document):
    """A box along the global axes."""

    size: Vector
    """Dimensions along X, Y, Z, m."""
    at: Vector
    """Centre, m."""


class Prism(Document):
    """A prism along one of the global axes."""

    outline: Annotated[Many[Place], Field(min_length=3)]
    """Vertices in the other two axes, X before Y before Z, m."""
    between: Place
    """The two places along the axis between which it lies, the lesser first, m."""
    along: Literal["x", "y", "z"] = "y"
    """The axis."""


class BlockDocument(Document):
    """A rigid block: vertices with faces, a box or a prism."""

    model_config = ConfigDict(json_schema_extra=_ONE_FORM)  # type: ignore[typeddict-item] # a schema is JSON

    name: str
    """Name, unique in the model."""
    unit_weight: Annotated[float, Field(ge=0.0, lt=1e30)] | None = None
    """Weight per volume, N/m3; may be left out for supports."""
    layer: str = ""
    """Layer or group that it is on."""
    material: str = ""
    """What it is made of, a word; it picks the one of `materials` of this name that lists no `blocks`."""
    groups: Many[str] = []
    """Groups that it belongs to."""
    colour: Annotated[str, Field(pattern=r"^(#[0-9a-fA-F]{6})?$")] = ""
    """Its colour in a drawing, as #rrggbb."""
    vertices: Many[Vector] | None = None
    """Vertices in global axes, m."""
    faces: Many[Many[int]] | None = None
    """Vertex indices (from 0) of each face, counter-clockwise seen from outside."""
    box: Box | None = None
    prism: Prism | None = None

    @model_validator(mode="after")
    def _one_form(self) -> BlockDocument:
        given = [key for key in ("vertices", "faces", "box", "prism") if getattr(self, key) is not None]
        if given not in (["vertices", "faces"], ["box"], ["prism"]):
            raise ValueError(
                f"has {' and '.join(given) or 'no shape'}; expected vertices and faces, or box, or prism"
            )
        return self
