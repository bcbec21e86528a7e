"""The whole job: plan, post, read back, verify, write."""

from __future__ import annotations

import os
import re
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from styluscam import _engine
from styluscam.arguments import A_FILE, FileName, file_of
from styluscam.errors import JobError, StylusError, VerifyError
from styluscam.files import is_file, require_writable, write_all_whole
from styluscam.judging.verification import Report, judge_plan
from styluscam.programs.job import Job, JobLike
from styluscam.programs.planning import MAIN_CHANNEL, Plan, Posted, output_name, plan, post
from styluscam.programs.posting import VERDICT
from styluscam.programs.program import Program
from styluscam.report.page import report_page
from styluscam.report.subject import Subject
from styluscam.report.templates import require_extra
from styluscam.types import Document, Progress
from styluscam.words import shortened

HEADER = 2**18
"""Bytes of a program in which its header ends."""

BLOCK_NUMBER = re.compile(r"^\s*N?\d+\s")
"""What stands before a remark where blocks are numbered."""


@dataclass(frozen=True, repr=False)
class RunResult:
    """What a run made: the program is written unless verification found an error, a report in any case."""

    plan: Plan
    posted: Posted
    report: Report
    summary: Document
    written: tuple[Path, ...]

    def __repr__(self) -> str:
        """The verdict, and what was written."""
        names = ", ".join(path.name for path in self.written)
        written = f"written: {shortened(names, 50)}" if names else "nothing written"
        return (
            f"<RunResult of {shortened(self.plan.job.title, 30)!r}: {'ok' if self.report.ok else 'FAILED'}, {written}>"
        )

    def __hash__(self) -> int:
        """As equality compares."""
        return hash((self.posted, self.written))


def run(
    job: JobLike,
    *,
    write_despite_findings: bool = False,
    progress: Progress | None = None,
    cancel: _engine.CancelToken | None = None,
    force: bool = False,
    report: FileName | None = None,
    also: Sequence[FileName] = (),
) -> RunResult:
    """Plans a job (object, dict or file), posts it, reads the text back, verifies it, and writes it only if no error was found.

    A program that another job wrote, or no job at all, is not replaced without ``force``; one of this job is. ``report``
    names the page to be written, the job's own when left out: whatever was found. ``also`` names files that the caller
    will write beside the program: asked about before the work begins.
    The verifier's figures go into the header: the text is posted again with them, and must hold the very same moves.
    """
    work = Job.of(job)
    page = _report_name(work) if report is None else file_of(report, "report", A_FILE, JobError)
    named = [also] if isinstance(also, str | os.PathLike) else also
    others = [file_of(each, "also", A_FILE, JobError) for each in named]
    require_writable([*_names(work), *([] if page is None else [page]), *others], work.inputs())
    if not force:
        _require_own(work)
    if page is not None:
        require_extra()
    planned = plan(work, progress=progress, cancel=cancel)
    verified = judge_plan(planned, post(planned).text, progress, cancel)
    summary, notes = planned.summary(verified.judgement)
    posted = post(planned, notes=notes)
    _require_same_moves(verified, planned, posted)
    files = _outputs(work, planned, posted, notes) if verified.ok or write_despite_findings else {}
    if page is not None:
        files[page] = report_page(Subject.judged(verified, planned.machine, _names(work)[0].name), progress)
    write_all_whole(files)
    return RunResult(planned, posted, verified, summary, tuple(files))


def _require_own(job: Job) -> None:
    """Asks whether what the job would replace was written by it: its title, and the verifier's remark in the program.

    Raises:
        JobError: a file of another job, or of none, has that name.
    """
    gcode, program = _names(job)
    title = str(job.document["title"] or job.document["part"]["file"])  # as programs have it
    described = not is_file(program) or _title(program) == title
    posted = not is_file(gcode) or _is_verified(gcode, title, is_file(program) and described)
    for path, own in ((gcode, posted), (program, described)):
        if not own:
            message = f"{path}: the file is there already, and this job ({job.title}) did not write it"
            hint = "add --force (in Python force=True) to replace it, or name another output.file"
            raise JobError(message, code="exists", where=str(path), hint=hint)


def _title(program: Path) -> str | None:
    """The title of the job that wrote a program document; None of another file."""
    try:
        return str(Program.load(program).setup["title"])
    except (StylusError, KeyError):
        return None


def _is_verified(gcode: Path, title: str, described: bool) -> bool:
    """Whether a text holds the verifier's remark, and belongs to a job of this title: by its header, or as ``described``."""
    try:
        with gcode.open("rb") as stream:
            head = stream.read(HEADER).decode("utf-8", errors="replace")
    except OSError:
        return False
    head_letters = _letters("".join(BLOCK_NUMBER.sub("", line) for line in head.splitlines()))
    own = _letters(title)
    return _letters(VERDICT) in head_letters and (described or (own != "" and own in head_letters))


def _letters(text: str) -> str:
    """The letters of a text: what every controller's comments keep of it."""
    plain = unicodedata.normalize("NFKD", text).casefold()
    return "".join(letter for letter in plain if letter.isascii() and letter.isalnum())


def _require_same_moves(report: Report, planned: Plan, posted: Posted) -> None:
    """Comments differ between the verified text and the written one; nothing else may."""
    again = _engine.read_back(planned.job.engine, planned.machine.engine, posted.text)
    if not again.same_moves(report.judgement.program):
        raise VerifyError("the header changed the program's moves", code="internal", hint="please report this")


def _outputs(job: Job, planned: Plan, posted: Posted, notes: list[str]) -> dict[Path, str]:
    gcode, program = _names(job)
    return {gcode: posted.text, program: planned.engine.programs[MAIN_CHANNEL].with_notes(notes).to_json()}


def _names(job: Job) -> tuple[Path, Path]:
    """The G-code's file and the program's."""
    gcode = job.folder / output_name(job)
    named = job.document["output"]["program"]
    return gcode, job.folder / named if named else gcode.with_suffix(".program.json")


def _report_name(job: Job) -> Path | None:
    """The report's file, if the job names one."""
    named = job.document["output"]["report"]
    return job.folder / named if named else None
