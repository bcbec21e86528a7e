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
from styluscam.programs.job import MAIN_CHANNEL, Job
from styluscam.programs.planning import of_channel

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
    """Plan a job and print its summary.

    Nothing is posted or verified, and only the files that options ask for are written.
    """
    with naming(job), progress.shown(not (json or quiet)) as report:
        work = Job.read(job)
        programs = {} if program is None else {channel: of_channel(program, channel) for channel in work.channels}
        pictures = {} if picture is None else {channel: of_channel(picture, channel) for channel in work.channels}
        outputs = [*programs.values(), *pictures.values()]
        files.require_writable(outputs, work.inputs())
        for sentence in [] if quiet else estimate.too_long(work, report):
            console.complain(sentence)
        planned = planning.plan(work, progress=report)
        summaries = {channel: planned.summary(channel=channel) for channel in planned.programs}
        files.write_all_whole(
            {
                path: planned.engine.programs[channel].with_notes(summaries[channel][1]).to_json()
                for channel, path in programs.items()
            }
        )
        _draw(planned, pictures)
    figures = {channel: numbers for channel, (numbers, _) in summaries.items()}
    if json:
        others = {channel: {"summary": numbers} for channel, numbers in figures.items() if channel != MAIN_CHANNEL}
        document = {"summary": figures[MAIN_CHANNEL], "written": [str(path) for path in outputs]}
        console.say_json({**document, "channels": others} if others else document)
    elif not quiet:
        console.say(summary.title(work.document))
        written = [("written", summary.shown_path(path)) for path in outputs]
        console.fields(summary.rows_of(figures, work.document) + written)
        console.say("planned only: not posted, not verified")
    return 0


def _draw(planned: planning.Plan, pictures: dict[str, Path]) -> None:
    if pictures:
        from styluscam.drawing.picture import plan_picture

        for channel, path in pictures.items():
            plan_picture(planned, path, channel)
