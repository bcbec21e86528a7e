"""``styluscam compare``: two programs for one job, side by side."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from styluscam.cli import console, findings, pages, progress, summary
from styluscam.cli.failures import FOUND, naming
from styluscam.cli.options import ChannelName, Debug, ForJob, Json, Quiet
from styluscam.errors import VerifyError
from styluscam.files import write_whole
from styluscam.judging import verification
from styluscam.programs.job import MAIN_CHANNEL, Job
from styluscam.report.comparison import comparison_page
from styluscam.report.subject import Subject
from styluscam.report.tables import figures, side_by_side
from styluscam.types import Document, Progress

First = Annotated[Path, typer.Argument(metavar="A.ngc", help="The first program.", show_default=False)]
Second = Annotated[Path, typer.Argument(metavar="B.ngc", help="The second program.", show_default=False)]
Out = Annotated[
    Path | None,
    typer.Option("--out", metavar="FILE.html", help="Also write a page with both pictures.", show_default=False),
]


def compare(
    first: First,
    second: Second,
    job: ForJob,
    *,
    channel: ChannelName = MAIN_CHANNEL,
    out: Out = None,
    json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> int:
    """Put two programs for one job side by side.

    Time, length, depth, gouge, excess, scallop, coverage. Both are verified as `styluscam verify` does; exit code 1 reports
    that one of them must not run.
    """
    with naming(job), progress.shown(not (json or quiet)) as shown:
        work = Job.read(job)
        pages.require(out, None, inputs=[first, second, *work.inputs()])
        subjects = [_verified(file, work, channel, shown) for file in (first, second)]
        if out is not None:
            write_whole(out, comparison_page(subjects))
    if json:
        documents = [_document(file, subject) for file, subject in zip((first, second), subjects, strict=True)]
        console.say_json({"programs": documents, "written": [] if out is None else [str(out)]})
    elif not quiet:
        console.table(_headings(first, second), [list(row) for row in side_by_side(subjects)])
        if out is not None:
            console.fields([("written", summary.shown_path(out))])
    return 0 if all(subject.report is not None and subject.report.ok for subject in subjects) else FOUND


def _verified(file: Path, job: Job, channel: str, shown: Progress | None) -> Subject:
    with naming(file, VerifyError):
        report = verification.verify_file(file, job, channel=channel, progress=shown)
        report.coverage(progress=shown)
    return Subject.judged(report, job.machine(channel), file.name)


def _headings(first: Path, second: Path) -> dict[str, str]:
    """The files' names, or their paths where those are the same."""
    names = (first.name, second.name) if first.name != second.name else (str(first), str(second))
    return {"": "left", names[0]: "right", names[1] if names[1] != names[0] else "again": "right"}


def _document(file: Path, subject: Subject) -> Document:
    assert subject.report is not None
    report = findings.document(subject.report)
    return {"file": str(file), "figures": figures(subject), "report": report, "coverage": subject.report.coverage()}
