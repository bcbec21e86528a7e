"""Programs to look at: any text that a known controller or the language's tracer understands, with a part or without."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TypeAlias

import numpy as np

from styluscam import _engine
from styluscam.errors import VerifyError
from styluscam.files import read_gcode_text
from styluscam.parts.part import Part
from styluscam.programs.job import MAIN_CHANNEL, Job
from styluscam.programs.machine import Machine
from styluscam.programs.program import Program
from styluscam.report.subject import Subject
from styluscam.types import Progress

Find: TypeAlias = Callable[[str], str | None]
"""A subroutine's text by its name in lower case."""


def viewed(
    text: str,
    name: str,
    machine: Machine | None = None,
    part: Part | None = None,
    *,
    find: Find = lambda _: None,
    progress: Progress | None = None,
) -> Subject:
    """A text as a machine reads it; without a machine, as the first shipped one that understands it.

    What none understands is traced: run as LinuxCNC's language defines, with the subroutines that ``find`` gives. ``name``
    is the file's; a part stands in the program's coordinates as it is.

    Raises:
        VerifyError: the machine does not understand the text; or no machine does, and the tracer neither, or nothing in
            it moves.
    """
    if machine is not None:
        read = Program(_engine.read_gcode(text, machine.engine))
        return Subject(name, name, _going(read, name), machine, part=part)
    machines = [Machine.shipped(one) for one in shipped_by_use()]
    for one in machines:
        understood = _read(text, one)
        if understood is not None:
            return Subject(name, name, understood, one, part=part)
    traced, gaps = _traced(text, find, progress)
    return Subject(name, name, traced, machines[0], part=part, gaps=gaps)


def viewed_for_job(
    text: str, name: str, job: Job, machine: Machine | None = None, channel: str = MAIN_CHANNEL
) -> Subject:
    """A channel's text as the job's machine reads it, or another, with the job's tools, over the job's part.

    Raises:
        JobError: the job has no such channel.
        VerifyError: the machine would not take the text for this job.
    """
    machine = machine or job.machine(channel)
    program = Program(_engine.read_back(job.engine, machine.engine, text, channel))
    scene = job.scene(channel=channel)
    title = str(job.document["title"] or job.name)
    frame = np.array(scene.frame)
    return Subject(title, name, _going(program, name), machine, job, job.part(), frame, scene=scene)


def _read(text: str, machine: Machine) -> Program | None:
    """The program as a machine reads it, if it does and the program goes somewhere."""
    try:
        return _going(Program(_engine.read_gcode(text, machine.engine)), "")
    except VerifyError:
        return None


def _traced(text: str, find: Find, progress: Progress | None) -> tuple[Program, tuple[str, ...]]:
    try:
        program, gaps = _engine.trace_gcode(text, find, progress)
    except VerifyError as error:
        hint = f"{error.hint}; or name its machine" if error.where else error.hint
        raise VerifyError(str(error), code=error.code, where=error.where, hint=hint) from error
    return Program(program), tuple(gaps)


def subroutines_in(folders: Sequence[Path]) -> Find:
    """Finds a subroutine's text by its name, whatever its case: ``NAME.ngc`` in the first folder that has it.

    Raises:
        VerifyError: a folder or a file that cannot be read; by the finder too.
    """
    files: dict[str, Path] = {}
    for folder in folders:
        for path in _listed(folder):
            if path.suffix.lower() == ".ngc":
                files.setdefault(path.stem.lower(), path)

    def find(name: str) -> str | None:
        path = files.get(name)
        return read_gcode_text(path) if path is not None else None

    return find


def _listed(folder: Path) -> list[Path]:
    try:
        return sorted(folder.iterdir())
    except OSError as error:
        message = f"{folder}: not a folder that can be read"
        raise VerifyError(message, code="unreadable", where=str(folder), hint="name the subroutines' folder") from error


def shipped_by_use() -> list[str]:
    """The shipped machines, the one that understands most first."""
    return sorted(Machine.names(), key=lambda name: (name != "linuxcnc", name))


def _going(program: Program, name: str) -> Program:
    """The program, if it goes anywhere."""
    if not np.isfinite(program.positions).all(axis=1).any():
        message = f"{name}: no move in it ends at a known position: there is nothing to see"
        raise VerifyError(message, code="no-moves", where=name, hint="check the file")
    return program
