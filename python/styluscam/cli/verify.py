"""``styluscam verify``: judges a G-code file against a job's part."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from styluscam import judging
from styluscam.cli import console, findings, progress
from styluscam.cli.failures import FOUND, naming
from styluscam.cli.options import Debug, Json, Quiet
from styluscam.cli.summary import place
from styluscam.errors import VerifyError
from styluscam.job import Job
from styluscam.types import Document

GcodeFile = Annotated[Path, typer.Argument(metavar="FILE.ngc", help="The G-code.", show_default=False)]
ForJob = Annotated[Path, typer.Option("--job", metavar="JOB.toml", help="The job that it is for.", show_default=False)]


def verify(file: GcodeFile, job: ForJob, json: Json = False, quiet: Quiet = False, debug: Debug = False) -> int:
    """Judge a G-code file against a job's part.

    The text is read as the job's machine reads it: gouges, excess, rapids, order; and what it leaves on each face.
    """
    with naming(job), naming(file, VerifyError), progress.shown(not (json or quiet)) as report:
        work = Job.read(job)
        judged = judging.verify_file(file, work, progress=report)
        covered = judged.coverage(progress=report) if json or not quiet else []
    if json:
        document = {"file": str(file), "job": str(job), **findings.document(judged), "coverage": covered}
        console.say_json(document)
    elif not (quiet and judged.ok):
        _tell(judged, file)
    return 0 if judged.ok else FOUND


def _tell(report: judging.Report, file: Path) -> None:
    document = report.to_dict()
    console.say(f"{file}: {'nothing was found' if report.ok else 'must not run'}")
    for line in findings.lines(report):
        console.say(line)
    console.fields(
        [
            ("worst gouge", f"{report.gouge_max:.4f} mm{_at(document['gouge_at'])}"),
            ("worst excess", f"{report.excess_max:.4f} mm{_at(document['excess_at'])}"),
            ("probed", f"{document['samples']} places, {document['brep_checked']} held against the exact model"),
            *(("coverage", _coverage(face)) for face in report.coverage()),
        ]
    )


def _coverage(face: Document) -> str:
    most = "nothing touches it" if face["left"] is None else f"most left {face['left']:.3f} mm at {place(face['at'])}"
    scallop = f"scallop {face['scallop']:.4f} mm (mean {face['mean']:.4f}), " if face["covered"] > 0.0 else ""
    return f"Face{face['face']}: {100 * face['covered']:.1f} % of {face['area']:.1f} mm2, {scallop}{most}"


def _at(where: dict[str, object] | None) -> str:
    if not where:
        return ""
    return f" (line {where['line']}, {place(where['position'])})"  # type: ignore[arg-type]
