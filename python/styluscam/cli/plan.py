"""``styluscam plan``: what a job amounts to, with nothing posted."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from styluscam import files
from styluscam.advice import estimate
from styluscam.cli import console, progress, summary
from styluscam.cli.failures import naming
from styluscam.cli.options import Debug, JobFile, Json, Picture, Quiet
from styluscam.programs import planning
from styluscam.programs.job import Job

ProgramFile = Annotated[
    Path | None,
    typer.Option("--program", metavar="FILE.json", help="Write the planned program.", show_default=False),
]


def plan(
    job: JobFile,
    *,
    program: ProgramFile = None,
    picture: Picture = None,
    json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> int:
    """Plan a job and sum it up.

    Nothing is posted or verified, and only the files that options ask for are written.
    """
    outputs = [path for path in (program, picture) if path is not None]
    with naming(job), progress.shown(not (json or quiet)) as report:
        work = Job.read(job)
        files.require_writable(outputs, work.inputs())
        for sentence in [] if quiet else estimate.too_long(work, report):
            console.complain(sentence)
        planned = planning.plan(work, progress=report)
        figures, notes = planned.summary()
        if program is not None:
            files.write_whole(program, planned.engine.programs[planning.MAIN_CHANNEL].with_notes(notes).to_json())
        if picture is not None:
            _draw(planned, picture)
    if json:
        console.say_json({"summary": figures, "written": [str(path) for path in outputs]})
    elif not quiet:
        console.say(summary.title(work.document))
        written = [("written", summary.shown_path(path)) for path in outputs]
        console.fields(summary.lines_of(figures, work.document) + written)
        console.say("planned only: not posted, not verified")
    return 0


def _draw(planned: planning.Plan, path: Path) -> None:
    from styluscam.drawing.picture import plan_picture

    plan_picture(planned, path)
