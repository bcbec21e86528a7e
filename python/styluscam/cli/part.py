"""``styluscam part show``: the faces of a part, as jobs name them."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from styluscam import files
from styluscam.cli import console, progress
from styluscam.cli.options import Debug, Json, PartFile, Picture, Quiet, Units
from styluscam.cli.summary import shown_path
from styluscam.parts.arrays import FaceInfo, PartArrays
from styluscam.parts.reading import read_part
from styluscam.types import Document

app = typer.Typer(help="Show parts.", rich_markup_mode=None)

Tolerance = Annotated[
    float, typer.Option("--tolerance", help="Largest deviation of the shown triangles from the surfaces, mm.")
]


@app.callback(invoke_without_command=True)
def _top(context: typer.Context) -> None:
    if context.invoked_subcommand is None:
        console.say(context.get_help())


@app.command("show")
def show(
    part: PartFile,
    *,
    units: Units = None,
    tolerance: Tolerance = 0.01,
    picture: Picture = None,
    json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> int:
    """List a part's faces, and draw them.

    Name, kind, area, centre, slopes against +Z (over 90: faces down).
    """
    if picture is not None:
        files.require_writable([picture], [part])
    with progress.shown(not (json or quiet)) as report:
        arrays = read_part(part, tolerance, units, report)
        if picture is not None:
            _draw(arrays, picture)
    if json:
        console.say_json(_document(arrays, picture))
    elif not quiet:
        _print(arrays, picture)
    return 0


def _draw(arrays: PartArrays, path: Path) -> None:
    from styluscam.drawing.picture import part_picture

    part_picture(arrays, path)


def _document(arrays: PartArrays, picture: Path | None) -> Document:
    low, high = arrays.box
    return {
        "source": arrays.source,
        "units": arrays.units,
        "box_min": list(low),
        "box_max": list(high),
        "closed": arrays.is_closed,
        "triangles": len(arrays.triangles),
        "notes": list(arrays.notes),
        "faces": [{"name": face.name, **asdict(face)} for face in arrays.faces],
        "written": [] if picture is None else [str(picture)],
    }


def _print(arrays: PartArrays, picture: Path | None) -> None:
    headings = {"face": "left", "kind": "left", "area mm2": "right", "centre X": "right", "Y": "right", "Z": "right"}
    console.table(headings | {"slope deg": "right"}, [_row(face) for face in arrays.faces])
    low, high = arrays.box
    console.say()
    box = ", ".join(f"{axis} {a:.3f} to {b:.3f}" for axis, a, b in zip("XYZ", low, high, strict=True))
    rows = [
        ("box", f"{box} mm"),
        ("units", f"{arrays.units} in the file"),
        ("body", "closed" if arrays.is_closed else "open: the faces do not enclose a volume"),
        *(("note", note) for note in arrays.notes),
    ]
    console.fields(rows + ([("written", shown_path(picture))] if picture is not None else []))


def _row(face: FaceInfo) -> list[str]:
    x, y, z = (f"{round(value, 3) + 0.0:.3f}" for value in face.centre)
    return [face.name, face.kind, f"{face.area_mm2:.1f}", x, y, z, _slopes(face)]


def _slopes(face: FaceInfo) -> str:
    """One figure for a plane, else the range; over 90 faces down."""
    low, high = f"{face.slope_min_deg:.1f}", f"{face.slope_max_deg:.1f}"
    return low if low == high else f"{low} to {high}"
