"""Stock that a job states by files: a body, or what an earlier program left."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import TYPE_CHECKING

from styluscam import _engine
from styluscam.errors import JobError
from styluscam.files import read_gcode_text
from styluscam.parts.formats import UNITLESS
from styluscam.parts.part import Part
from styluscam.types import Document, Progress

if TYPE_CHECKING:
    from styluscam.programs.job import Job

JOB, FILE = "setup.stock.job", "setup.stock.file"


def _section(job: Job, kind: str) -> Document | None:
    section: Document | None = job.document["setup"].get("stock")
    return section if section is not None and section["kind"] == kind else None


def files(job: Job) -> list[Path]:
    """The files that a job's stock is read from."""
    if (mesh := _section(job, "mesh")) is not None:
        return [job.folder / mesh["file"]]
    if _section(job, "program") is None:
        return []
    before = _job(job)
    return [*before.inputs(), _program(job, before)]


def body(job: Job, progress: Progress | None = None) -> Part | None:
    """The body in the stock's file; None where the job names none.

    Raises:
        GeometryError: it cannot be read.
    """
    section = _section(job, "mesh")
    if section is None:
        return None
    file, part = job.folder / section["file"], job.document["part"]
    units = section.get("units") or (part.get("units") if file.suffix.lower() in UNITLESS else None)
    return Part.read(file, part["tolerance"], units, progress)


def earlier(job: Job, progress: Progress | None = None) -> _engine.Earlier | None:
    """What the program of the earlier job cut that the stock names; None where it names none.

    Raises:
        JobError: the program was not run yet, or is not that job's; jobs that name each other; or as :meth:`Job.read`.
        VerifyError: its text is not what its machine understands.
    """
    if _section(job, "program") is None:
        return None
    before = _job(job)
    file = _program(job, before)
    if not file.is_file():
        run = f"run the earlier job first: styluscam run {shlex.quote(str(before.file))}"
        raise JobError(f"{file}: no such file", code="no-such-file", where=FILE, hint=run)
    machine = before.machine()
    return _engine.Earlier(before.engine, before.scene(progress), machine.engine, read_gcode_text(file))


def _job(job: Job) -> Job:
    """The earlier job; that it, and those before it, do not come back to this one."""
    own = None if job.file is None else job.file.resolve()
    first, seen, before = _named(job), {own}, job
    while before is not None and _section(before, "program") is not None:
        before = _named(before)
        file = before.file.resolve() if before.file is not None else None
        if file in seen:
            message = f"{file}: this job's stock is what it leaves itself"
            raise JobError(message, code="conflict", where=JOB, hint="name the job that is run before this one")
        seen.add(file)
    return first


def _named(job: Job) -> Job:
    section = _section(job, "program")
    assert section is not None
    return type(job).read(job.folder / section["job"])


def _program(job: Job, before: Job) -> Path:
    section = _section(job, "program")
    assert section is not None
    named = section.get("file")
    return job.folder / named if named else before.folder / before.output
