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
from styluscam.programs.job import Job
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
        also = [] if picture is None else [picture]
        result = running.run(
            work,
            write_despite_findings=write_despite_findings,
            force=force,
            progress=shown,
            report=report,
            also=also,
        )
        written = list(result.written)
        if picture is not None:
            _draw(result, picture)
            written.append(picture)
    if json:
        console.say_json(_document(result, written))
    else:
        _print(result, written, quiet, result.report.ok or write_despite_findings)
    return 0 if result.report.ok else FOUND


def _draw(result: running.RunResult, path: Path) -> None:
    from styluscam.drawing.picture import plan_picture

    plan_picture(result.plan, path)


def _document(result: running.RunResult, written: list[Path]) -> Document:
    return {
        "ok": result.report.ok,
        "notes": _notes(result),
        "summary": result.summary,
        "report": findings.document(result.report),
        "written": [str(path) for path in written],
    }


def _notes(result: running.RunResult) -> list[str]:
    """What reading the part had to do."""
    arrays = result.plan.job.part().arrays
    return [] if arrays is None else list(arrays.notes)


def _print(result: running.RunResult, written: list[Path], quiet: bool, has_program: bool) -> None:
    if not quiet or not result.report.ok:
        rows = [("note", note) for note in _notes(result)]
        rows += summary.lines_of(result.summary, result.plan.job.document)
        rows += [("written", summary.shown_path(path)) for path in written]
        console.say(summary.title(result.plan.job.document))
        console.fields(rows)
    if not result.report.findings:
        if quiet:
            return
        console.say("verified: the written text was read back and checked, nothing was found")
        return
    for line in findings.lines(result.report):
        console.complain(line)
    if result.report.ok:
        warned = any(finding.severity == "warning" for finding in result.report.findings)
        what = "warnings" if warned else "notes"
        console.complain(f"verified: the written text was read back and checked; it may run, with these {what}")
        return
    if not has_program:
        console.complain("no program was written (--write-despite-findings writes it all the same)")
