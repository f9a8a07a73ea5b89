"""The result file as pydantic classes: what a claimed solution needs, and what is kept beside it."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import ConfigDict, Discriminator, Field, Tag

from limitblocks.io.block_documents import Document, Many, Number, Version
from limitblocks.problem import ASSOCIATED, Turning

Six = tuple[Number, Number, Number, Number, Number, Number]


def _form(rows: Any) -> str:
    return "by name" if isinstance(rows, dict) else "in order"


Rows = Annotated[
    Annotated[Many[Six], Tag("in order")] | Annotated[dict[str, Six], Tag("by name")], Discriminator(_form)
]


class VersionedDocument(Document):
    """What has a version, whatever else there is."""

    model_config = ConfigDict(extra="ignore")

    schema_version: Version = 1
    """Version of this file format."""


class StateDocument(Document):
    """A state with what the analysis said of it. SI units: m, rad, N."""

    schema_version: Version = 1
    """Version of this file format."""
    model_digest: str = ""
    """SHA-256 of the model."""
    stress_resultants: Rows
    """(V1, V2, N, M1, M2, T) of each interface."""
    generalised_stresses: Many[Number] | None = None
    """What the rows of the joints act on."""
    displacement_rates: Rows | None = None
    """(du, dv, dw, dwX, dwY, dwZ) of each block."""
    flow_multipliers: Many[Number] | None = None
    """Of each row of the limit problem."""
    dead_load_stresses: Many[Number] | None = None
    """Generalised stresses that carry the dead loads alone."""
    # kept for the reader; no check believes a word of it
    remarks: Any = None
    residuals: Any = None
    residual_details: Any = None
    tolerance: Any = None
    versions: Any = None


class ResultDocument(StateDocument):
    """A claimed solution of Eqs (54)-(59)."""

    analysis: Literal["nonassociated"] = "nonassociated"
    load_factor: Number
    """Load factor."""
    dilatancy: Annotated[float, Field(ge=0.0, lt=1e30)] = 0.0
    """Tangent of the dilatancy angle."""
    turning: Literal["centroid", "centre of pressure"] = "centroid"
    """What twisting under bending turns about."""
    frictionless: Any = None
    unclaimed: Any = None
    associated: Any = None
    status: Any = None
    backward_error: Any = None
    how: Any = None
    fixed_point_change: Any = None
    history: Any = None


class BoundsDocument(StateDocument):
    """Bounds: the stress state of the lower one and the mechanism of the upper one, associated flow."""

    analysis: Literal["bounds"]
    lower: Number
    """Static load factor, which the check judges."""
    upper: Number | None = None
    """Kinematic load factor, which the check judges."""
    proven: bool = False
    """Whether both are claimed to be theorems, rounding errors included."""
    proof: Any = None
    gap: Any = None
    worth: Any = None
    solvers: Any = None

    @property
    def load_factor(self) -> float:
        """The lower bound."""
        return self.lower

    @property
    def dilatancy(self) -> float:
        """Infinite: the flow is associated at every interface."""
        return ASSOCIATED

    @property
    def turning(self) -> str:
        """Of no account where the flow is associated."""
        return Turning.CENTROID.value


class PathDocument(Document):
    """A load path; its collapse is the claimed solution."""

    schema_version: Version = 1
    analysis: Literal["path"]
    steps: Any = None
    snaps: Any = None
    trace: Any = None
    tracked: Any = None
    remarks: Any = None
    collapse: ResultDocument
    versions: Any = None
