"""``styluscam new``: a commented job for a part that has none."""

from __future__ import annotations

import os
import shlex
from pathlib import Path
from typing import Annotated

import typer

from styluscam import files
from styluscam.cli import console, progress
from styluscam.cli.options import Debug, Force, Json, PartFile, Quiet, Units
from styluscam.cli.summary import shown_path
from styluscam.errors import JobError
from styluscam.job import Job, starter_job
from styluscam.parts import read_part

LOOK = 0.05
"""Tolerance at which the part is looked at, mm: the job sets its own."""

Out = Annotated[
    Path | None,
    typer.Option("--out", metavar="FILE.toml", help="The job file; beside the part when left out.", show_default=False),
]


def new(
    part: PartFile,
    *,
    units: Units = None,
    out: Out = None,
    force: Force = False,
    json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> int:
    """Write a commented job file for a part.

    It runs as it stands.
    """
    path = out or part.with_suffix(".toml")
    files.require_new(path, force, JobError, "name another --out")
    files.require_writable([path], [part])
    with progress.shown(not (json or quiet)) as report:
        arrays = read_part(part, LOOK, units, report)
    text = starter_job(arrays, _relative(part, path.parent), units)
    Job.check(text)
    files.write_whole(path, text)
    if json:
        console.say_json({"written": [str(path)]})
    elif not quiet:
        console.say(f"written: {shown_path(path)}")
        console.say(f"next:    styluscam run {shlex.quote(shown_path(path))}")
    return 0


def _relative(part: Path, folder: Path) -> str:
    """The part as a job in ``folder`` names it."""
    try:
        return Path(os.path.relpath(part, folder)).as_posix()
    except ValueError:  # another drive
        return part.resolve().as_posix()
