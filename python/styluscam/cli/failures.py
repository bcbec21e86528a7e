"""From an exception to an exit code and one line: what, where, what to do."""

from __future__ import annotations

import contextlib
import errno
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import typer

from styluscam.errors import StylusError
from styluscam.programs.job import job_schema

FOUND, INPUT, CANCELLED, FAULT, INTERRUPTED = 1, 2, 3, 4, 130
"""Exit codes besides 0: verification found an error; wrong input; cancelled; a fault of ours; Ctrl-C."""

USAGE_ERROR: type[Exception] = typer.BadParameter.__bases__[0]
"""What typer raises for a command line that it cannot use; it is click's, or typer's own copy of it."""

REPORT = "please report this, with --debug, at https://github.com/styluscam/styluscam/issues"


class JobFailedError(Exception):
    """Carries an error, its cause, past the command that was working on a job file."""

    def __init__(self, job: Path) -> None:
        super().__init__(str(job))
        self.job = job


@dataclass(frozen=True)
class Failure:
    """An error as scripts (``--json``) and people get it."""

    exit_code: int
    kind: str
    code: str
    where: str
    message: str
    hint: str
    file: str = ""
    """The job file, where ``where`` is a key path in it."""

    @property
    def line(self) -> str:
        """One line for a terminal."""
        names = [self.file, self.where if self.where not in self.message else ""]
        prefix = "".join(f"{name}: " for name in names if name)
        hint = f"; {self.hint}" if self.hint and self.hint not in self.message else ""
        return " ".join(f"error: {prefix}{self.message}{hint}".split())

    def to_dict(self) -> dict[str, dict[str, str]]:
        """The document that ``--json`` prints."""
        what = {"class": self.kind, "code": self.code, "where": self.where, "message": self.message, "hint": self.hint}
        return {"error": what}


@contextlib.contextmanager
def naming(file: Path, failures: type[StylusError] = StylusError) -> Iterator[None]:
    """Errors that name a key of the job document, or a line, get to name the file too: the job, or the G-code."""
    try:
        yield
    except failures as error:
        raise JobFailedError(file) from error


def failure_of(error: BaseException) -> Failure:
    """What is reported of an error that came out of a command."""
    if isinstance(error, JobFailedError) and error.__cause__ is not None:
        failure = failure_of(error.__cause__)
        in_document = failure.exit_code == INPUT and _is_in_document(failure.where)
        return replace(failure, file=str(error.job)) if in_document else failure
    if isinstance(error, KeyboardInterrupt | typer.Abort):
        return Failure(INTERRUPTED, "Cancelled", "interrupted", "", "interrupted", "")
    if isinstance(error, StylusError):
        return _known(error)
    if isinstance(error, USAGE_ERROR):
        return _usage(error)
    return _of_the_machine(error) or Failure(
        FAULT, type(error).__name__, "internal", "", f"a fault of StylusCAM: {error!r}", REPORT
    )


def _of_the_machine(error: BaseException) -> Failure | None:
    """What a full disk behind stdout, or too little memory, is called; None for other errors."""
    if isinstance(error, OSError) and error.errno in (errno.ENOSPC, errno.EDQUOT):
        message = f"cannot be written: {error.strerror}"
        return Failure(INPUT, "StylusError", "unwritable", "", message, "redirect it elsewhere")
    if isinstance(error, MemoryError):
        message = "not enough memory for this part at this tolerance"
        return Failure(INPUT, "GeometryError", "memory", "part.tolerance", message, "give a larger tolerance")
    return None


def _known(error: StylusError) -> Failure:
    exit_code = {"cancelled": CANCELLED, "internal": FAULT}.get(error.code, INPUT)
    hint = REPORT if exit_code == FAULT else error.hint
    return Failure(exit_code, type(error).__name__, error.code, error.where, str(error), hint)


def _is_in_document(where: str) -> bool:
    """Whether an error's location is a key of a job, a line of its text, or the whole of it."""
    first = where.replace("[", ".").replace(" ", ".").partition(".")[0]
    return where == "" or first == "line" or first in job_schema()["properties"]


def _usage(error: Exception) -> Failure:
    message = str(getattr(error, "format_message", lambda: str(error))()).rstrip(".")
    context = getattr(error, "ctx", None)
    command = context.command_path if context is not None else "styluscam"
    return Failure(INPUT, "UsageError", "usage", command, message, f"see {command} --help")
