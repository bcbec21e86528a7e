"""``styluscam view``: any G-code file as a page, with a part or without."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from styluscam.cli import console, pages, progress, summary
from styluscam.cli.failures import naming
from styluscam.cli.options import ChannelName, Debug, GcodeFile, Json, Picture, Quiet, Units
from styluscam.drawing import viewing
from styluscam.errors import JobError, StylusError, VerifyError
from styluscam.files import is_file, read_gcode_text
from styluscam.parts.part import Part
from styluscam.programs.job import MAIN_CHANNEL, Job
from styluscam.programs.machine import Machine
from styluscam.report.tables import figures, in_words

OnMachine = Annotated[
    str | None,
    typer.Option(
        "--machine", metavar="NAME|FILE", help="Machine that reads it; default: the first that can.", show_default=False
    ),
]
WithJob = Annotated[
    Path | None,
    typer.Option("--job", metavar="JOB.toml", help="Its part, tools and machine.", show_default=False),
]
WithPart = Annotated[
    Path | None,
    typer.Option("--part", metavar="PART", help="A part in the program's coordinates.", show_default=False),
]
Subroutines = Annotated[
    list[Path] | None,
    typer.Option(
        "--subroutines",
        metavar="FOLDER",
        help="Another folder with files of O-words, besides the program's own.",
        show_default=False,
    ),
]
Out = Annotated[
    Path | None,
    typer.Option(
        "--out", metavar="FILE.html", help="The page to write; default: beside the G-code.", show_default=False
    ),
]

GENERATOR = '<meta name="generator" content="StylusCAM">'
"""In the head of each page of ours, and in none of others'."""
HEAD = 1000
"""Characters of a page that hold it."""

SHOWN_TOLERANCE = 0.01
"""mm: of a part that is only looked at."""


def view(
    file: GcodeFile,
    *,
    machine: OnMachine = None,
    job: WithJob = None,
    channel: ChannelName = MAIN_CHANNEL,
    part: WithPart = None,
    units: Units = None,
    subroutines: Subroutines = None,
    out: Out = None,
    picture: Picture = None,
    json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> int:
    """Show any G-code file as a page.

    Path, tool and times, and a part if one is given. What no shipped machine reads is traced: loops, subroutines, cycles and
    parameters are run as LinuxCNC does. Nothing is verified; `styluscam verify` does that.
    """
    if job is not None and part is not None:
        raise JobError(
            "--part cannot be given with --job: the job names its part",
            code="usage",
            where="--part",
            hint="give one of them",
        )
    page = out or _own_page(file)
    reader = Machine.find(machine) if machine is not None else None
    with naming(job or file), naming(file, VerifyError), progress.shown(not (json or quiet)) as shown:
        work = Job.read(job) if job is not None else None
        inputs = [path for path in (file, job, part) if path is not None] + (list(work.inputs()) if work else [])
        pages.require(page, picture, inputs=inputs)
        text = read_gcode_text(file)
        if work is not None:
            subject = viewing.viewed_for_job(text, file.name, work, reader, channel)
        else:
            solid = Part.read(part, SHOWN_TOLERANCE, units, shown) if part is not None else None
            find = viewing.subroutines_in((file.parent, *(subroutines or ())))
            subject = viewing.viewed(text, file.name, reader, solid, find=find, progress=shown)
        written = pages.write(lambda: subject, page, picture, shown)
    numbers = figures(subject)
    if json:
        names = [str(path) for path in written]
        gaps = list(subject.gaps or ())
        document = {"file": str(file), "machine": subject.reader, "gaps": gaps, "figures": numbers, "written": names}
        console.say_json(document)
    elif not quiet:
        read = f"as {subject.reader} reads it" if subject.gaps is None else f"read as {subject.reader}"
        console.say(f"{file}: {read}; not verified")
        console.fields([*in_words(numbers), *(("written", summary.shown_path(path)) for path in written)])
        for gap in subject.gaps or ():
            console.say(f"note: {gap}")
    return 0


def _own_page(file: Path) -> Path:
    """The page beside a program, which may replace an older one.

    Raises:
        StylusError: a file that is no page of ours has this name.
    """
    page = file.with_suffix(".html")
    if is_file(page) and not _is_ours(page):
        raise StylusError(
            f"{page}: exists and was not written by StylusCAM",
            code="exists",
            where=str(page),
            hint="name the page with --out",
        )
    return page


def _is_ours(page: Path) -> bool:
    try:
        with page.open(encoding="utf-8", errors="replace") as stream:
            return GENERATOR in stream.read(HEAD)
    except OSError:
        return False
