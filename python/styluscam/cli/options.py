"""Arguments and options that several commands share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, TypeAlias

import typer

JobFile: TypeAlias = Annotated[Path, typer.Argument(metavar="JOB.toml", help="The job file.", show_default=False)]
PartFile: TypeAlias = Annotated[
    Path,
    typer.Argument(metavar="PART", help="STEP, BREP, IGES, STL, OBJ, PLY or 3MF.", show_default=False),
]
Units: TypeAlias = Annotated[
    str | None,
    typer.Option("--units", help="Unit of a file that states none: mm, cm, m, um, in, ft.", show_default=False),
]
Material: TypeAlias = Annotated[
    str | None,
    typer.Option(
        "--material",
        metavar="NAME",
        help="What the workpiece is made of: `styluscam material cutting` lists what is known.",
        show_default=False,
    ),
]
CuttingTable: TypeAlias = Annotated[
    Path | None,
    typer.Option(
        "--cutting-data",
        metavar="FILE.toml",
        help="A table of cutting data of your own, which goes before the shipped one.",
        show_default=False,
    ),
]
Picture: TypeAlias = Annotated[
    Path | None,
    typer.Option("--picture", metavar="FILE.png", help="Also draw a picture.", show_default=False),
]
ReportFile: TypeAlias = Annotated[
    Path | None,
    typer.Option(
        "--report", metavar="FILE.html", help="Also write a report: one page, no network.", show_default=False
    ),
]
SimulationFile: TypeAlias = Annotated[
    Path | None,
    typer.Option(
        "--simulation",
        metavar="FILE.stl",
        help="Also write the material that the moves leave.",
        show_default=False,
    ),
]
GcodeFile: TypeAlias = Annotated[Path, typer.Argument(metavar="FILE.ngc", help="The G-code.", show_default=False)]
ForJob: TypeAlias = Annotated[
    Path, typer.Option("--job", metavar="JOB.toml", help="The job that it is for.", show_default=False)
]
ChannelName: TypeAlias = Annotated[
    str,
    typer.Option(
        "--channel", metavar="NAME", help="The channel of the job that the text is for, where it has several."
    ),
]
BesideFile: TypeAlias = Annotated[
    Path | None,
    typer.Option(
        "--beside",
        metavar="OTHER.ngc",
        help="The G-code of the channel that works together with this one: the two are checked against each other.",
        show_default=False,
    ),
]
Json: TypeAlias = Annotated[bool, typer.Option("--json", help="Print one JSON document, errors included.")]
Quiet: TypeAlias = Annotated[
    bool, typer.Option("--quiet", "-q", help="No progress, and no summary when nothing was found.")
]
Debug: TypeAlias = Annotated[bool, typer.Option("--debug", help="Show the traceback of an error.")]
Force = Annotated[bool, typer.Option("--force", help="Replace a file that exists.")]
