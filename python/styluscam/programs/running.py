"""The whole job: plan, post, read back, verify, write."""

from __future__ import annotations

import os
import re
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from styluscam import _engine
from styluscam.arguments import A_FILE, FileName, file_of
from styluscam.errors import JobError, StylusError, VerifyError
from styluscam.files import is_file, require_writable, write_all_whole
from styluscam.judging.verification import Report, judge_plan
from styluscam.programs.job import MAIN_CHANNEL, Job, JobLike
from styluscam.programs.planning import Plan, Posted, of_channel, output_name, plan, post
from styluscam.programs.posting import VERDICT
from styluscam.programs.program import Program
from styluscam.programs.summary import Summary
from styluscam.report.page import report_page
from styluscam.report.subject import Subject
from styluscam.report.templates import require_extra
from styluscam.types import Progress
from styluscam.words import shortened

HEADER = 2**18
"""Bytes of a program in which its header ends."""

BLOCK_NUMBER = re.compile(r"^\s*N?\d+\s")
"""What stands before a remark where blocks are numbered."""


@dataclass(frozen=True)
class ChannelResult:
    """What verification found in a channel's text, and the channel in numbers."""

    report: Report
    summary: Summary


@dataclass(frozen=True, repr=False)
class RunResult:
    """What a run made: the programs are written unless verification found an error in one, reports in any case."""

    plan: Plan
    posted: Posted
    channels: dict[str, ChannelResult]
    written: tuple[Path, ...]

    @property
    def ok(self) -> bool:
        """Whether nothing was found in any channel that must not be."""
        return all(channel.report.ok for channel in self.channels.values())

    @property
    def report(self) -> Report:
        """Of the main channel."""
        return self.channels[MAIN_CHANNEL].report

    @property
    def summary(self) -> Summary:
        """Of the main channel."""
        return self.channels[MAIN_CHANNEL].summary

    def __repr__(self) -> str:
        """The verdict, and what was written."""
        names = ", ".join(path.name for path in self.written)
        written = f"written: {shortened(names, 50)}" if names else "nothing written"
        return f"<RunResult of {shortened(self.plan.job.title, 30)!r}: {'ok' if self.ok else 'FAILED'}, {written}>"

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
    The verifier's figures go into the headers: texts are posted again with them, and must hold the very same moves. A job of
    several channels writes a program, and a report, for each.
    """
    work = Job.of(job)
    pages = _report_names(work, None if report is None else file_of(report, "report", A_FILE, JobError))
    named = [also] if isinstance(also, str | os.PathLike) else also
    others = [file_of(each, "also", A_FILE, JobError) for each in named]
    programs = [path for channel in work.channels for path in _names(work, channel)]
    trim = _trim_name(work)
    require_writable([*programs, *pages.values(), *trim, *others], work.inputs())
    if not force:
        _require_own(work)
    if pages:
        require_extra()
    planned = plan(work, progress=progress, cancel=cancel)
    first = {channel: _first(planned, channel) for channel in planned.programs}
    made = {channel: _made(planned, channel, first, progress, cancel) for channel in planned.programs}
    channels = {channel: ChannelResult(each.report, each.summary) for channel, each in made.items()}
    posted = Posted({output_name(work, channel): each.text for channel, each in made.items()})
    files: dict[Path, str] = {}
    if write_despite_findings or all(each.report.ok for each in made.values()):
        for channel, each in made.items():
            gcode, program = _names(work, channel)
            files |= {gcode: each.text, program: each.program.engine.to_json()}
    files |= {path: _trim_table(planned) for path in trim}
    for channel, page in pages.items():
        subject = Subject.judged(made[channel].report, planned.machines[channel], _names(work, channel)[0].name)
        files[page] = report_page(subject, progress)
    write_all_whole(files)
    return RunResult(planned, posted, channels, tuple(files))


class _Made(NamedTuple):
    """A channel, posted and verified."""

    report: Report
    summary: Summary
    program: Program
    text: str


def _first(planned: Plan, channel: str) -> str:
    """A channel's text without the verifier's figures."""
    program = planned.programs[channel].with_notes(planned.summary(channel=channel)[1])
    return post(program, planned.machines[channel]).text


def _made(
    planned: Plan,
    channel: str,
    first: dict[str, str],
    progress: Progress | None,
    cancel: _engine.CancelToken | None,
) -> _Made:
    """Verifies a channel's first text; it is then posted again with the verifier's figures in its header.

    Raises:
        VerifyError: the header changed the moves.
    """
    program, machine = planned.programs[channel], planned.machines[channel]
    partner = planned.job.engine.partner_of(channel)
    report = judge_plan(planned, first[channel], progress, cancel, channel, beside=first[partner] if partner else None)
    summary, notes = planned.summary(report.judgement, channel)
    noted = program.with_notes(notes)
    text = post(noted, machine).text
    _require_same_moves(report, text)
    return _Made(report, summary, noted, text)


def _require_own(job: Job) -> None:
    """Asks whether what the job would replace was written by it: its title, and the verifier's remark in the program.

    Raises:
        JobError: a file of another job, or of none, has that name.
    """
    title = str(job.document["title"] or job.document["part"]["file"])  # as programs have it
    for gcode, program in (_names(job, channel) for channel in job.channels):
        described = not is_file(program) or _title(program) == title
        posted = not is_file(gcode) or _is_verified(gcode, title, is_file(program) and described)
        for path, own in ((gcode, posted), (program, described)):
            if not own:
                message = f"{path}: the file exists, and this job ({job.title}) did not write it"
                hint = "add --force (in Python force=True) to replace it, or name another output.file"
                raise JobError(message, code="exists", where=str(path), hint=hint)


def _title(program: Path) -> str | None:
    """The title of the job that wrote a program document; None of another file."""
    try:
        return Program.load(program).setup.title
    except StylusError:
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


def _require_same_moves(report: Report, text: str) -> None:
    """Comments differ between the verified text and the written one; nothing else may."""
    again = _engine.read_back(report.job.engine, report.machine.engine, text, report.channel)
    if not again.same_moves(report.judgement.program):
        raise VerifyError("the header changed the program's moves", code="internal", hint="please report this")


def _names(job: Job, channel: str) -> tuple[Path, Path]:
    """The G-code's file of a channel and the program's."""
    main = job.folder / output_name(job)
    named = job.document["output"]["program"]
    program = job.folder / named if named else main.with_suffix(".program.json")
    return job.folder / output_name(job, channel), of_channel(program, channel)


def _trim_name(job: Job) -> list[Path]:
    """The file of the trim curve, if the job names one."""
    name = job.document["output"]["trim"]
    return [job.folder / name] if name else []


def _trim_table(planned: Plan) -> str:
    """The trim curves as a table: number of the curve, and its points in work coordinates, mm; the first one again at its end."""
    rows = ["curve,x,y,z"]
    for number, line in enumerate(planned.trim, start=1):
        rows += [f"{number},{x:.4f},{y:.4f},{z:.4f}" for x, y, z in [*line, line[0]]]
    return "\n".join(rows) + "\n"


def _report_names(job: Job, given: Path | None) -> dict[str, Path]:
    """The reports' files by channel, the job's own where none is given; none if it names none."""
    named = job.document["output"]["report"]
    first = given or (job.folder / named if named else None)
    return {} if first is None else {channel: of_channel(first, channel) for channel in job.channels}
