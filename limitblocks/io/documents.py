"""The model file as pydantic classes; joints and load terms are derived from their dataclasses."""

from __future__ import annotations

from dataclasses import MISSING, fields
from inspect import getdoc
from typing import TYPE_CHECKING, Annotated, Any, Literal, Union, get_type_hints

from pydantic import ConfigDict, Discriminator, Field, Tag, create_model

from limitblocks.io.block_documents import BlockDocument, Document, Many, Number, Place, Vector, Version
from limitblocks.io.registry import JOINTS, TERMS
from limitblocks.io.units import Force, Length

_BOUNDED: dict[Any, Any] = {
    float: Number,
    tuple[float, float]: Place,
    tuple[float, float] | None: Place | None,
    tuple[float, float, float]: Vector,
    tuple[float, float, float] | None: Vector | None,
    tuple[str, ...]: Annotated[tuple[str, ...], Field(fail_fast=True)],
}


class InterfaceDocument(Document):
    """A plane convex contact polygon between two blocks."""

    block_i: str
    """Block that the normal points out of."""
    block_j: str
    centroid: Vector
    """Centroid of the polygon, global axes, m."""
    axes: tuple[Vector, Vector, Vector]
    """Right-handed unit vectors s1, s2, n in global axes."""
    polygon: Annotated[Many[Place], Field(min_length=3)]
    """Vertices along s1, s2 about the centroid, counter-clockwise about n, m."""
    joint: str
    """A name in `joints`."""


class FindSettings(Document):
    """Settings of contact detection, as for limitblocks.find_interfaces."""

    joint: str | None
    """The name in `joints` that every interface gets; null for the joints of `materials`."""
    gap: Number | None = None
    """Distance that counts as touching, in block lengths; left out, chosen by the accuracy of the faces."""
    angle: Number | None = None
    """Angle between face normals that counts as opposed, rad; left out, chosen as the gap is."""
    width: Number | None = None
    """Least mean width of an interface, in block lengths; left out, the gap."""


class TolerancesDocument(Document):
    """Tolerances that the interfaces were found with; `limitblocks info` judges the contacts with them."""

    gap: Annotated[float, Field(gt=0.0, lt=1.0)]
    """Distance that counts as touching, in block lengths."""
    angle: Annotated[float, Field(gt=0.0, lt=0.7853981633974483)]
    """Angle between face normals that counts as opposed, rad."""
    width: Annotated[float, Field(gt=0.0, lt=1.0)]
    """Least mean width of an interface, in block lengths."""
    accuracy: Annotated[float, Field(ge=0.0, lt=1.0)] | None = None
    """Accuracy of the vertices that the faces which touch show, in block lengths; null if not known."""


class Find(Document):
    """Interfaces to be found by contact detection."""

    find: FindSettings


def _derived(cls: Any, **extra: Any) -> Any:
    """The document class of a frozen dataclass: its fields, its class name as `type`, and `extra`."""
    hints = {key: _BOUNDED.get(hint, hint) for key, hint in get_type_hints(cls).items()}
    parts: dict[str, Any] = {
        field.name: (hints[field.name], ... if field.default is MISSING else field.default)
        for field in fields(cls)
        if field.init
    }
    parts["type"] = (Literal[cls.__name__], ...)
    about = (getdoc(cls) or "").split("\n\n")[0]
    return create_model(cls.__name__, __base__=Document, __doc__=about, **parts, **extra)


class SelfWeight(Document):
    """The weight of every block, along -Z."""

    type: Literal["SelfWeight"]
    factor: Number = 1.0


def _one_of(documents: tuple[Any, ...]) -> Any:
    return Annotated[Union[documents], Field(discriminator="type")]  # noqa: UP007


if TYPE_CHECKING:
    JointDocument = Any
    TermDocument = Any
else:  # built from the classes that exist, which a type checker cannot follow
    JointDocument = _one_of(tuple(_derived(cls) for cls in JOINTS.values()))
    TermDocument = _one_of((SelfWeight, *(_derived(cls, factor=(Number, 1.0)) for cls in TERMS.values())))


class MaterialDocument(Document):
    """What blocks are made of."""

    blocks: Many[str] = []
    """Its blocks: names, patterns, "layer:PATTERN"; left out, those whose layer or material has its name."""
    unit_weight: Annotated[float, Field(ge=0.0, lt=1e30)] | None = None
    """Weight per volume, N/m3; left out for blocks that have one, and for supports."""
    joint: JointDocument | None = None
    """What an interface between two such blocks can carry; left out, that of the other material."""


class PairDocument(Document):
    """The joint between two materials."""

    between: tuple[str, str]
    """Two names in `materials`."""
    joint: JointDocument
    """What the interface can carry."""


class UnitsDocument(Document):
    """Units of all numbers of the file, those of pressures and unit weights included."""

    length: Length = "m"
    """Unit of lengths."""
    force: Force = "N"
    """Unit of forces."""


class MaterialsDocument(Document):
    """A table of materials."""

    units: UnitsDocument = UnitsDocument()
    """Units of all numbers of the file; m and N if left out."""
    materials: dict[str, MaterialDocument]
    """The materials by name; a block is of the first that picks it."""
    pairs: Many[PairDocument] = []
    """Joints between two materials; other pairs get the weaker joint of both."""


def _form(interfaces: Any) -> str:
    return "find" if isinstance(interfaces, dict | Find) else "list"


Interfaces = Annotated[
    Annotated[Many[InterfaceDocument], Tag("list")] | Annotated[Find, Tag("find")], Discriminator(_form)
]


class ModelDocument(Document):
    """A structure of rigid blocks for limit analysis with limitblocks."""

    model_config = ConfigDict(title="limitblocks model")

    editor_schema: Annotated[str | None, Field(alias="$schema")] = None
    """Where an editor finds the JSON Schema of this file; not used."""
    schema_version: Version
    """Version of this file format."""
    name: str = ""
    """Title in reports."""
    units: UnitsDocument = UnitsDocument()
    """Units of all numbers of the file; m and N if left out."""
    blocks: Many[BlockDocument]
    """All blocks, those of the supports included."""
    supports: Many[str]
    """Names of the blocks that do not move."""
    materials: dict[str, MaterialDocument] = {}
    """Unit weights and joints of the blocks, by the name of a material."""
    pairs: Many[PairDocument] = []
    """Joints between two materials; other pairs get the weaker joint of both."""
    joints: dict[str, JointDocument]
    """What interfaces can carry, by name; empty where `materials` say it."""
    interfaces: Interfaces
    """The interfaces, or how to find them."""
    tolerances: TolerancesDocument | None = None
    """Tolerances that a list of interfaces was found with."""
    left_out: Many[str] = []
    """Parts of the file the model comes from that are no blocks of it."""
    dead: Many[TermDocument] = [SelfWeight(type="SelfWeight")]
    """Terms of the constant loads; self weight if left out."""
    live: Many[TermDocument]
    """Terms of the loads that the load factor multiplies."""
    gamma_Q: Number | None = None
    """What the loads of `live` were multiplied by where loads and strengths have their design values."""
