"""``styluscam run``: plan, post, read back, verify, write."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from styluscam.advice import estimate
from styluscam.cli import console, findings, progress, summary
from styluscam.cli.failures import FOUND, naming
from styluscam.cli.options import Debug, Force, JobFile, Json, Picture, Quiet, ReportFile
from styluscam.programs import running
from styluscam.programs.job import MAIN_CHANNEL, Job
from styluscam.programs.planning import of_channel
from styluscam.types import Document

Despite = Annotated[
    bool, typer.Option("--write-despite-findings", help="Write the files even where verification found errors.")
]


def run(
    job: JobFile,
    *,
    write_despite_findings: Despite = False,
    report: ReportFile = None,
    picture: Picture = None,
    force: Force = False,
    json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> int:
    """Plan, post, verify, and write a job's program.

    The posted text is read back and verified; it is written only if no error was found. A program that this job wrote before
    is replaced, another file only with --force.
    """
    with naming(job), progress.shown(not (json or quiet)) as shown:
        work = Job.read(job)
        for sentence in [] if quiet else estimate.too_long(work, shown):
            console.complain(sentence)
        pictures = {} if picture is None else {channel: of_channel(picture, channel) for channel in work.channels}
        result = running.run(
            work,
            write_despite_findings=write_despite_findings,
            force=force,
            progress=shown,
            report=report,
            also=list(pictures.values()),
        )
        _draw(result, pictures)
        written = [*result.written, *pictures.values()]
    if json:
        console.say_json(_document(result, written))
    else:
        _print(result, written, quiet, result.ok or write_despite_findings)
    return 0 if result.ok else FOUND


def _draw(result: running.RunResult, pictures: dict[str, Path]) -> None:
    if pictures:
        from styluscam.drawing.picture import plan_picture

        for channel, path in pictures.items():
            plan_picture(result.plan, path, channel)


def _document(result: running.RunResult, written: list[Path]) -> Document:
    channels = {
        name: {"summary": channel.summary, "report": findings.document(channel.report)}
        for name, channel in result.channels.items()
    }
    main = channels.pop(MAIN_CHANNEL)
    document = {"ok": result.ok, "notes": _notes(result), **main, "written": [str(path) for path in written]}
    trim = [curve.tolist() for curve in result.plan.trim]
    document |= {"trim": trim} if trim else {}
    return {**document, "channels": channels} if channels else document


def _notes(result: running.RunResult) -> list[str]:
    """What reading the part had to do."""
    arrays = result.plan.job.part().arrays
    return [] if arrays is None else list(arrays.notes)


def _print(result: running.RunResult, written: list[Path], quiet: bool, has_program: bool) -> None:
    if not quiet or not result.ok:
        rows = [("note", note) for note in _notes(result)]
        rows += summary.rows_of(
            {name: each.summary for name, each in result.channels.items()}, result.plan.job.document
        )
        rows += [("written", summary.shown_path(path)) for path in written]
        console.say(summary.title(result.plan.job.document))
        console.fields(rows)
    found = [finding for each in result.channels.values() for finding in each.report.findings]
    if not found:
        if not quiet:
            console.say("verified: the written text was read back and checked, nothing was found")
        return
    for name, channel in result.channels.items():
        for line in findings.lines(channel.report):
            console.complain(f"{name}: {line}" if len(result.channels) > 1 else line)
    if result.ok:
        what = "warnings" if any(finding.severity == "warning" for finding in found) else "notes"
        console.complain(f"verified: the written text was read back and checked; it may run, with these {what}")
        return
    if not has_program:
        console.complain("no program was written (--write-despite-findings writes it all the same)")
