"""Files that a job states its stock by: a body, or the program of an earlier job."""

from __future__ import annotations

import shlex
from pathlib import Path

from styluscam.errors import JobError
from styluscam.files import read_gcode_text
from styluscam.parts.formats import UNITLESS
from styluscam.parts.part import Part
from styluscam.types import Document, Progress


def section_of(document: Document, kind: str) -> Document | None:
    """The section of a job's stock, where it is of this kind."""
    section: Document | None = document["setup"].get("stock")
    return section if section is not None and section["kind"] == kind else None


def body(document: Document, folder: Path, progress: Progress | None = None) -> Part | None:
    """The body in the stock's file; None where the job names none.

    Raises:
        GeometryError: it cannot be read.
    """
    section = section_of(document, "mesh")
    if section is None:
        return None
    file, part = folder / section["file"], document["part"]
    units = section.get("units") or (part.get("units") if file.suffix.lower() in UNITLESS else None)
    return Part.read(file, part["tolerance"], units, progress)


def program(file: Path, job: Path) -> str:
    """The text in the file of an earlier job's program.

    Raises:
        JobError: there is none yet.
        VerifyError: it cannot be read.
    """
    if not file.is_file():
        hint = f"run the earlier job first: styluscam run {shlex.quote(str(job))}"
        raise JobError(f"{file}: no such file", code="no-such-file", where="setup.stock.file", hint=hint)
    return read_gcode_text(file)


def require_new(file: Path, seen: set[Path]) -> None:
    """Refuses an earlier job that comes after itself.

    Raises:
        JobError: its file was seen.
    """
    if file in seen:
        message = f"{file}: this job's stock is what it leaves itself"
        raise JobError(
            message, code="conflict", where="setup.stock.job", hint="name the job that is run before this one"
        )
