"""Arguments and options that the verbs share."""

from pathlib import Path
from typing import Annotated

import typer

from limitblocks.choices import Method, Turning

ModelFile = Annotated[Path, typer.Argument(metavar="MODEL", help="Model file (JSON).", show_default=False)]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON and nothing else.")]
Tolerance = Annotated[float, typer.Option(help="Largest gap and residual accepted.", min=0.0)]
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
ReportFile = Annotated[
    Path | None,
    typer.Option(
        "--output",
        "-o",
        metavar="FILE",
        help="HTML, JSON, Markdown or PDF file [default: HTML beside the model].",
    ),
]
ClaimFile = Annotated[Path, typer.Argument(metavar="RESULT", help="Result file (JSON).", show_default=False)]
WithNonassociated = Annotated[bool, typer.Option("--nonassociated", help="Also the non-associated solution.")]
WithPath = Annotated[bool, typer.Option("--path", help="Also the load path.")]
Paths = Annotated[int, typer.Option(help="Load paths and other ways to a solution.", min=1)]
Mechanisms = Annotated[int, typer.Option(help="Mechanisms drawn at random.", min=0)]
Seed = Annotated[int, typer.Option(help="Of all that is random.", min=0)]
Seconds = Annotated[float, typer.Option("--time-limit", help="Seconds; of each exact program, too.", min=0.0)]
Exact = Annotated[bool, typer.Option("--exact", help="Also the least and the greatest of all solutions.")]
Version = Annotated[bool, typer.Option("--version", help="Print the version and leave.")]
