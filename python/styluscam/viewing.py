"""Programs to look at: any text that a known controller understands, with a part or without."""

from __future__ import annotations

import numpy as np

from styluscam import _engine
from styluscam.errors import StylusError, VerifyError
from styluscam.job import Job
from styluscam.machine import Machine
from styluscam.part import Part
from styluscam.program import Program
from styluscam.report import Subject


def viewed(text: str, name: str, machine: Machine | None = None, part: Part | None = None) -> Subject:
    """A text as a machine reads it; without a machine, as the first shipped one that understands it.

    ``name`` is the file's; a part stands in the program's coordinates as it is.

    Raises:
        VerifyError: no machine understands the text; the first one's reason.
    """
    machine, program = _read(text, machine)
    return Subject(name, name, _going(program, name), machine, part=part)


def viewed_for_job(text: str, name: str, job: Job, machine: Machine | None = None) -> Subject:
    """A text as the job's machine reads it, or another, with the job's tools, over the job's part.

    Raises:
        VerifyError: the machine would not take the text for this job.
    """
    machine = machine or job.machine()
    program = Program(_engine.read_back(job.engine, machine.engine, text))
    scene = _engine.Scene(job.engine, job.part().engine)
    title = str(job.document["title"] or job.name)
    return Subject(title, name, _going(program, name), machine, job, job.part(), np.array(scene.frame))


def _read(text: str, machine: Machine | None) -> tuple[Machine, Program]:
    machines = [machine] if machine is not None else [Machine.shipped(name) for name in shipped_by_use()]
    first: StylusError | None = None
    for one in machines:
        try:
            return one, Program(_engine.read_gcode(text, one.engine))
        except VerifyError as error:
            first = first or error
    assert first is not None
    if machine is not None:
        raise first
    hint = f"{first.hint}; or name its machine: this is what {machines[0].name} says"
    raise VerifyError(str(first), code=first.code, where=first.where, hint=hint) from first


def shipped_by_use() -> list[str]:
    """The shipped machines, the one that understands most first."""
    return sorted(Machine.names(), key=lambda name: (name != "linuxcnc", name))


def _going(program: Program, name: str) -> Program:
    """The program, if it goes anywhere."""
    if not np.isfinite(program.positions).all(axis=1).any():
        message = f"{name}: no move in it goes to a known place: there is nothing to see"
        raise VerifyError(message, code="no-moves", where=name, hint="check the file")
    return program
