"""``styluscam new``: a commented job for a part that has none."""

from __future__ import annotations

import contextlib
import os
import shlex
from pathlib import Path
from typing import Annotated

import typer

from styluscam import files
from styluscam.cli import console, progress
from styluscam.cli.options import CuttingTable, Debug, Force, Json, Material, PartFile, Quiet, Units
from styluscam.cli.summary import shown_path
from styluscam.errors import GeometryError, JobError
from styluscam.parts.arrays import PartArrays
from styluscam.parts.reading import read_part, require_part
from styluscam.programs.cutting import table_text
from styluscam.programs.job import Job, starter_job
from styluscam.types import Progress

LOOK = 0.05
"""Tolerance at which the part is looked at, mm: the job sets its own."""

FINE, FINEST = 1e-3, 1e-3
"""The same as a share of a small part's size, and its least, mm."""

LIKELY_INCH = 12.0
"""A part whose numbers are no larger than this was likely drawn in inch."""

Out = Annotated[
    Path | None,
    typer.Option(
        "--out", metavar="FILE.toml", help="The job file to write; default: beside the part.", show_default=False
    ),
]


def new(
    part: PartFile,
    *,
    units: Units = None,
    material: Material = None,
    cutting_data: CuttingTable = None,
    out: Out = None,
    force: Force = False,
    json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> int:
    """Write a commented job file for a part.

    It forms what a sheet can be formed to and mills the rest, with a tool that fits the part and feeds for its material,
    and states why. It runs as it stands.
    """
    require_part(part)
    path = out or part.with_suffix(".toml")
    files.require_new(path, force, JobError, "name another --out")
    files.require_writable([path], [part])
    with progress.shown(not (json or quiet)) as report:
        arrays = _looked_at(part, units, report)
    named = _relative(part, path.parent)
    made = starter_job(arrays, named, units, material=material, cutting_data=_table(cutting_data, path.parent))
    Job.check(made.text)
    files.write_whole(path, made.text)
    if json:
        operations = [{"id": name, "reasons": reasons} for name, reasons in made.operations]
        document = {
            "written": [str(path)],
            "notes": list(arrays.notes),
            "reasons": made.reasons,
            "operations": operations,
        }
        console.say_json(document)
    elif not quiet:
        console.fields([("note", note) for note in arrays.notes])
        console.fields([("" if number else "because", reason) for number, reason in enumerate(made.reasons)])
        for name, reasons in made.operations:
            console.fields([("" if number else name, reason) for number, reason in enumerate(reasons)])
        console.say(f"written: {shown_path(path)}")
        console.say(f"next:    styluscam run {shlex.quote(shown_path(path))}")
    with progress.shown(not (json or quiet)) as report:
        _read_ahead(path, report)
    return 0


def _table(file: Path | None, folder: Path) -> tuple[str, str] | None:
    """A table of cutting data as a job in ``folder`` names it, and its text."""
    return None if file is None else (_relative(file, folder), table_text(file))


def _looked_at(part: Path, units: str | None, report: Progress | None) -> PartArrays:
    """The part; where its file has no units, the error states what size it would have."""
    try:
        arrays = read_part(part, LOOK, units, report)
        low, high = arrays.box
        fine = FINE * max(b - a for a, b in zip(low, high, strict=True))
        return arrays if fine >= LOOK else read_part(part, max(fine, FINEST), units, report)
    except GeometryError as error:
        if error.code != "part-units-missing":
            raise
        low, high = read_part(part, LOOK, "mm", report).box
        size = [b - a for a, b in zip(low, high, strict=True)]
        mm, inch = (" x ".join(f"{factor * length:.4g}" for length in size) for factor in (1.0, 25.4))
        likely = "in" if max(size) <= LIKELY_INCH else "mm"
        hint = f"as mm the part is {mm} mm, as inch {inch} mm: likely --units {likely}"
        raise GeometryError(f"{error}; {hint}", code=error.code, where=error.where, hint=hint) from error


def _read_ahead(job: Path, report: Progress | None) -> None:
    """Read the part as its job wants it, while the CAD kernel is loaded: `run` finds it in the cache of parts."""
    with contextlib.suppress(GeometryError, JobError, OSError):  # `run` reports what is wrong
        Job.read(job).part(report)


def _relative(part: Path, folder: Path) -> str:
    """The part as a job in ``folder`` names it."""
    try:
        return Path(os.path.relpath(part, folder)).as_posix()
    except ValueError:  # another drive
        return part.resolve().as_posix()
