"""``styluscam tool list``, ``show``, ``new``, ``plot`` and ``feeds``: tools, their libraries and their files, what they stand."""

from __future__ import annotations

import math
import shlex
from pathlib import Path
from typing import Annotated

import numpy as np
import typer

from styluscam import files
from styluscam.cli import console
from styluscam.cli.options import CuttingTable, Debug, Force, Json, Quiet
from styluscam.cli.summary import shown_path
from styluscam.errors import ToolError
from styluscam.programs import cutting
from styluscam.tools import library, pointsfile, starters, toolfile
from styluscam.tools.tool import Tool
from styluscam.types import Document

app = typer.Typer(help="Describe, compare and make tools.", rich_markup_mode=None)

TOOL_HELP = "A tool of a library (clothoid:medium, shop.json:a), or a tool file (.json, FreeCAD's .fctb)."
Name = Annotated[str, typer.Argument(metavar="NAME|FILE", help=TOOL_HELP, show_default=False)]
Names = Annotated[list[str], typer.Argument(metavar="NAME|FILE...", help=TOOL_HELP, show_default=False)]
LibraryFile = Annotated[
    Path | None,
    typer.Option("--library", metavar="FILE.json", help="A library of your own.", show_default=False),
]
Stock = Annotated[
    str,
    typer.Option(
        "--material",
        metavar="NAME",
        help="What the workpiece is made of: `styluscam material cutting` lists what is known.",
        show_default=False,
    ),
]
NewFile = Annotated[Path, typer.Argument(metavar="FILE.json", help="The tool file to write.", show_default=False)]
Kind = Annotated[
    str | None,
    typer.Option("--kind", metavar="KIND", help="A profile's kind: ball, clothoid, ...", show_default=False),
]
From = Annotated[str | None, typer.Option("--from", metavar="NAME|FILE", help=TOOL_HELP, show_default=False)]
Points = Annotated[
    Path | None,
    typer.Option("--points", metavar="FILE.csv", help="Measured points: radius, height (mm).", show_default=False),
]
FitTolerance = Annotated[
    float, typer.Option("--fit-tolerance", metavar="MM", help="Largest distance of the curve from the points, mm.")
]
Out = Annotated[Path, typer.Option("--out", metavar="FILE.svg|.png", help="The picture to write.", show_default=False)]
StepDown = Annotated[float, typer.Option("--step-mm", help="Step down between Z-levels, for the scallops, mm.")]


Work = Annotated[
    str, typer.Option("--work", metavar="WORK", help="rough-milling, finish-milling, drilling or tapping.")
]
Cutter = Annotated[
    str | None,
    typer.Option(
        "--cutter", metavar="MATERIAL", help="hss or carbide; what the tool's file states.", show_default=False
    ),
]
Flutes = Annotated[
    int | None, typer.Option("--flutes", help="Cutting edges; what the tool's file states.", show_default=False)
]
Width = Annotated[
    float | None, typer.Option("--width", metavar="MM", help="Width of cut across the path, mm.", show_default=False)
]
Angle = Annotated[
    float | None, typer.Option("--angle", metavar="DEG", help="Engagement angle, degrees.", show_default=False)
]
Depth = Annotated[
    float | None, typer.Option("--depth", metavar="MM", help="Depth of cut along the axis, mm.", show_default=False)
]
Pitch = Annotated[
    float | None, typer.Option("--pitch", metavar="MM", help="Pitch of a thread, mm.", show_default=False)
]
Fastest = Annotated[
    float | None, typer.Option("--max-rpm", help="Fastest spindle, rev/min; the machine's.", show_default=False)
]
Slowest = Annotated[
    float | None, typer.Option("--min-rpm", help="Slowest spindle, rev/min; the machine's.", show_default=False)
]
FastestFeed = Annotated[
    float | None, typer.Option("--max-feed", help="Fastest feed, mm/min; the machine's.", show_default=False)
]
ForMachine = Annotated[
    str | None,
    typer.Option("--machine", "-m", metavar="NAME|FILE", help="The machine whose limits hold.", show_default=False),
]


@app.callback(invoke_without_command=True)
def _top(context: typer.Context) -> None:
    if context.invoked_subcommand is None:
        console.say(context.get_help())


@app.command("list")
def list_(own: LibraryFile = None, json: Json = False, debug: Debug = False) -> int:
    """List the tools of the shipped libraries, or of yours."""
    libraries = library.shipped() if own is None else (library.read_library(own),)
    if json:
        console.say_json(
            [
                {"name": shelf.name, "title": shelf.title, "tools": [_listed(tool) for tool in shelf.tools.values()]}
                for shelf in libraries
            ]
        )
        return 0
    for number, shelf in enumerate(libraries):
        if number:
            console.say()
        console.say(f"{shelf.name}: {shelf.title}" if shelf.title else shelf.name)
        console.fields([(f"  {name}", _what(tool)) for name, tool in shelf.tools.items()])
    return 0


@app.command("show")
def show(name: Name, own: LibraryFile = None, json: Json = False, debug: Debug = False) -> int:
    """Describe a tool: its profile's kind and numbers, its size, its slopes."""
    tool = find(name, own)
    document = _document(tool)
    if json:
        console.say_json(document)
    else:
        console.fields(_lines(document))
    return 0


@app.command("new")
def new(
    file: NewFile,
    *,
    kind: Kind = None,
    from_: From = None,
    points: Points = None,
    fit_tolerance: FitTolerance = 0.01,
    own: LibraryFile = None,
    force: Force = False,
    json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> int:
    """Write a tool file: typical numbers of a kind, an existing tool, or measured points.

    The ending chooses the format: this also turns a tool file into FreeCAD's, and back.
    """
    files.require_new(file, force, ToolError, "choose another name")
    if file.suffix.lower() not in (".json", ".fctb"):
        hint = f"call it {file.stem or 'tool'}.json"
        raise ToolError(f"{file}: a tool file ends in .json or .fctb", code="ending", where=str(file), hint=hint)
    if sum(choice is not None for choice in (kind, from_, points)) != 1:
        hint = "give one of --kind, --from and --points"
        raise ToolError(
            "the source of the new tool is not stated, or stated twice", code="usage", where="tool new", hint=hint
        )
    name = toolfile.file_name(file.stem)
    if from_ is not None:
        document = find(from_, own).to_file()
        document = {"schema": toolfile.SCHEMA, "name": name} | document
    elif points is not None:
        document = starters.measured(pointsfile.read_points(points), fit_tolerance, name)
    else:
        document = starters.starter(str(kind), name)
    tool = Tool.from_dict(document)
    if file.suffix.lower() == ".fctb":
        tool.write(file)
    else:  # as it was typed in: without what the engine adds
        files.write_whole(file, toolfile.text_of(document))
    if json:
        console.say_json({"written": [str(file)]})
    elif not quiet:
        console.say(f"written: {shown_path(file)}")
        console.say(
            f"next:    styluscam tool plot {shlex.quote(shown_path(file))} --out {shlex.quote(file.stem + '.svg')}"
        )
    return 0


@app.command("plot")
def plot(
    tools: Names,
    out: Out,
    *,
    own: LibraryFile = None,
    step_mm: StepDown = 0.5,
    json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> int:
    """Draw tools to scale, with radius of curvature by slope and the scallop that each leaves by wall angle."""
    from styluscam.drawing.toolplot import tool_picture

    files.require_writable([out])
    tool_picture([find(name, own) for name in tools], out, step_mm)
    if json:
        console.say_json({"written": [str(out)]})
    elif not quiet:
        console.say(f"written: {shown_path(out)}")
    return 0


@app.command("feeds")
def feeds(
    name: Name,
    material: Stock,
    *,
    work: Work = "rough-milling",
    cutter: Cutter = None,
    flutes: Flutes = None,
    width: Width = None,
    angle: Angle = None,
    depth: Depth = None,
    pitch: Pitch = None,
    machine: ForMachine = None,
    min_rpm: Slowest = None,
    max_rpm: Fastest = None,
    max_feed: FastestFeed = None,
    cutting_data: CuttingTable = None,
    own: LibraryFile = None,
    json: Json = False,
    debug: Debug = False,
) -> int:
    """Speed of the spindle and feeds of a tool in a material, with what they follow from and the sources."""
    data = cutting.cutting_data(
        find(name, own),
        material,
        work,
        cutter_material=cutter,
        flutes=flutes,
        width=width,
        angle_deg=angle,
        depth=depth,
        pitch=pitch,
        machine=machine,
        min_rpm=min_rpm,
        max_rpm=max_rpm,
        max_feed=max_feed,
        table=cutting_data,
    )
    if json:
        console.say_json(data)
        return 0
    rows = [
        ("spindle", f"{data.rpm:.0f} rev/min"),
        ("feed", f"{data.feed:.0f} mm/min"),
        ("plunge", f"{data.plunge:.0f} mm/min"),
        ("chip", f"{data.chip:.3g} mm"),
    ]
    rows += [("" if number else "because", reason) for number, reason in enumerate(data.reasons)]
    console.fields(rows + [("source", source) for source in data.sources])
    return 0


def find(name: str, own: Path | None) -> Tool:
    """A tool by file, or by its name in a library: one's own first, then the shipped ones."""
    if toolfile.file_and_name(name)[0]:
        return Tool.find(name)
    if files.is_file(Path(name)):
        return Tool.read(name)
    shelf = None if own is None else library.read_library(own)
    if shelf is not None and name in shelf.tools:
        return Tool.of_library(shelf, name)
    return Tool.from_dict(library.find(name, libraries=([] if shelf is None else [shelf]) + list(library.shipped())))


def _what(document: Document) -> str:
    listed = _listed(document)
    return (
        f"{listed.get('description', ''):<22}  {listed.get('title', '')}" if "error" not in listed else listed["error"]
    )


def _listed(document: Document) -> Document:
    """A tool of a library, described; or why it cannot be built."""
    try:
        return {**document, "description": Tool.from_dict(document).description}
    except ToolError as error:
        return {**document, "error": f"cannot be built: {error}"}


def _document(tool: Tool) -> Document:
    report = tool.report()
    radius = float(tool.curvature_radius_at(0.0))
    return {
        "name": tool.name,
        "title": tool.title,
        "description": tool.description,
        **tool.to_dict(),
        "diameter_mm": tool.diameter,
        "height_mm": float(tool.height_at(tool.max_slope)),
        "max_slope_deg": math.degrees(tool.max_slope),
        "tip_flat_radius_mm": float(tool.radius_range_at(0.0)[1]),
        "tip_curvature_radius_mm": radius if math.isfinite(radius) else None,
        "fit_deviation_mm": report["fit_deviation_mm"],
        "notes": report["notes"],
    }


def _lines(document: Document) -> list[tuple[str, str]]:
    profile = dict(document["profile"])
    rows = [("name", document["name"]), ("what", document["title"])]
    rows = [row for row in rows if row[1]]
    rows += [("profile", document["description"]), ("kind", profile.pop("kind"))]
    rows += [(f"  {key}", _value(value)) for key, value in profile.items() if value not in (None, 0.0)]
    rows += [
        ("diameter", f"{document['diameter_mm']:.6g} mm"),
        ("height", f"{document['height_mm']:.6g} mm"),
        ("max slope", f"{document['max_slope_deg']:.4g} deg"),
        ("at the tip", _tip(document)),
    ]
    for key in toolfile.TOOL[1:]:
        if document.get(key) is not None:
            rows.append((key.replace("_", " "), _value(document[key])))
    if document["fit_deviation_mm"] is not None:
        rows.append(("fit", f"within {document['fit_deviation_mm']:.3g} mm of the points"))
    return rows + [("note", note) for note in document["notes"]]


def _tip(document: Document) -> str:
    flat, radius = document["tip_flat_radius_mm"], document["tip_curvature_radius_mm"]
    if flat > 0.0:
        return f"flat, {2.0 * flat:.6g} mm across"
    if radius is None:
        return "curvature vanishes: infinitely flat"
    return f"radius of curvature {radius:.6g} mm" if radius > 0.0 else "pointed"


def _value(value: object) -> str:
    if isinstance(value, dict):
        return ", ".join(f"{key} {_value(part)}" for key, part in value.items())
    if isinstance(value, list):
        shown = " ".join(f"({_value(part)})" if isinstance(part, list) else _value(part) for part in value[:4])
        return shown + (f" ... {len(value)} in all" if len(value) > 4 else "")
    return f"{value:g}" if isinstance(value, int | float | np.floating) else str(value)
