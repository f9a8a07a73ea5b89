"""Arguments and options: one place for all commands; joints are in `joints`, vectors in `vectors`."""

from pathlib import Path
from typing import Annotated, Any

import typer

from limitblocks.choices import Method, Turning
from limitblocks.cli.vectors import vector

ModelFile = Annotated[Path, typer.Argument(metavar="MODEL", help="Model file (JSON).", show_default=False)]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON and nothing else.")]
Tolerance = Annotated[float, typer.Option(help="Largest gap and residual accepted.", min=0.0)]
SolutionTolerance = Annotated[
    float, typer.Option("--tolerance", help="Largest residual accepted, dimensionless.", min=0.0)
]
BackwardLimit = Annotated[
    float | None,
    typer.Option(
        "--backward-error",
        help="Also accept what is exact for a model changed by no more than this, such as 1e-4.",
        min=0.0,
        show_default=False,
    ),
]
OwnTolerance = Annotated[
    float | None,
    typer.Option(help="Largest gap and residual accepted [default: 1e-06 of bounds, else 1e-08].", min=0.0),
]
Dilatancy = Annotated[float, typer.Option(help="Tangent of the dilatancy angle of sliding.", min=0.0)]
Turns = Annotated[Turning, typer.Option("--turning", help="What twisting under bending turns about.")]
Along = Annotated[
    bool, typer.Option("--along", help="Steps along snaps, too: the unstable states that they jump over.")
]
Way = Annotated[Method, typer.Option("--method", help="How a solution is looked for.")]
Force = Annotated[bool, typer.Option("--force", help="Replace the output file if it exists.")]
ResultFile = Annotated[
    Path | None, typer.Option("--output", "-o", metavar="RESULT", help="Also write the result as JSON.")
]
NewModel = Annotated[
    Path, typer.Option("--output", "-o", metavar="MODEL", help="Model file to write.", show_default=False)
]
ReportFile = Annotated[
    Path | None,
    typer.Option(
        "--output",
        "-o",
        metavar="FILE",
        help="HTML, JSON, Markdown or PDF file [default: HTML beside the model].",
    ),
]
Filed = Annotated[
    Path | None, typer.Option("--report", help="Write a report with this chapter: .pdf, .html, .md or .json.")
]
Animation = Annotated[
    Path | None,
    typer.Option("--animation", metavar="FILE", help="Write the motion at true size as a .glb animation."),
]
ClaimFile = Annotated[Path, typer.Argument(metavar="RESULT", help="Result file (JSON).", show_default=False)]
ExportFile = Annotated[
    Path,
    typer.Argument(
        metavar="FILE",
        help="3dm, JSON (COMPAS), GLB or VTU file to write; PVD of a load path.",
        show_default=False,
    ),
]
Scale = Annotated[
    float | None,
    typer.Option(
        help="Length of the arrow of 1 N, m [default: 1 m is a round number of N].", show_default=False
    ),
]
ResultFiles = Annotated[
    list[Path],
    typer.Argument(metavar="[RESULT...]", help="Result files that --output wrote.", show_default=False),
]
WithStability = Annotated[
    bool, typer.Option("--stability", help="Also whether it stands under its dead loads by itself.")
]
WithBounds = Annotated[bool, typer.Option("--bounds", help="Also the bounds.")]
WithNonassociated = Annotated[bool, typer.Option("--nonassociated", help="Also the non-associated solution.")]
WithPath = Annotated[bool, typer.Option("--path", help="Also the load path.")]
Paths = Annotated[int, typer.Option(help="Load paths and other ways to a solution.", min=1)]
Mechanisms = Annotated[int, typer.Option(help="Mechanisms drawn at random.", min=0)]
Seed = Annotated[int, typer.Option(help="Of all that is random.", min=0)]
Seconds = Annotated[float, typer.Option("--time-limit", help="Seconds; of each exact program, too.", min=0.0)]
Exact = Annotated[
    bool, typer.Option("--exact", help="Also the least and greatest of all solutions from zero up.")
]
BlocksFile = Annotated[Path, typer.Argument(metavar="FILE", help="File of blocks.", show_default=False)]
Supports = Annotated[
    list[str],
    typer.Option(
        "--supports",
        metavar="WHICH",
        help="Blocks that do not move: a block or layer, layer:LAYER, a pattern such as 'ground*', "
        "or 'z<0.05'; repeat. [default: those that FILE marks]",
        show_default=False,
    ),
]
MaterialsFile = Annotated[
    Path | None,
    typer.Option(
        "--materials",
        metavar="TOML",
        help="Unit weights and joints by layer or name, instead of --friction; see docs/from-a-drawing.md.",
        show_default=False,
    ),
]
LIVE = {"names": "X,Y,Z", "help": "Direction of the live load, which is the weight."}
Live = Annotated[Any, vector("--live", "--direction", **LIVE)]
UnitWeights = Annotated[
    list[str],
    typer.Option("--unit-weight", metavar="[LAYER=]N/M3", help="Of all blocks, or of a layer; repeat."),
]
Units = Annotated[
    str | None,
    typer.Option(help="Unit of length of FILE: m, cm, mm, in or ft [default: as FILE says, or m]."),
]
Up = Annotated[
    str | None, typer.Option(help="Axis of FILE that points up: y or z [default: as FILE says, or z].")
]
Thickness = Annotated[
    float | None, typer.Option(help="FILE is a DXF elevation; depth of its blocks along Y, m.")
]
Layers = Annotated[
    list[str],
    typer.Option(
        metavar="LAYER", help="Layer of the elevation to take outlines from; repeat [default: all]."
    ),
]
Count = Annotated[int, typer.Option(help="Number of directions or places.", min=1)]
Workers = Annotated[
    int | None, typer.Option(help="Processes [default: one for each core].", min=1, show_default=False)
]
CsvFile = Annotated[Path | None, typer.Option("--csv", metavar="FILE", help="Also write the rows as CSV.")]
Title = Annotated[str, typer.Option(help="Title of the report [default: name of the model].")]
Author = Annotated[str, typer.Option(help="Who answers for the report.")]
Project = Annotated[str, typer.Option(help="Name or number of the project.")]
Notes = Annotated[str, typer.Option(help="What else the report should say.")]
Demand = Annotated[
    float | None,
    typer.Option(help="Load factor that is needed; the report compares it.", min=0.0, show_default=False),
]
Version = Annotated[bool, typer.Option("--version", help="Print the version and leave.")]
TwistedFaces = Annotated[
    str | None,
    typer.Option(
        "--twisted",
        metavar="HOW",
        help="Faces whose corners lie in no plane: triangulate, fit or refuse [default: triangles within the "
        "accuracy of FILE, else refused].",
    ),
]
