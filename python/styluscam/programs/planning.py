"""From a job to a program, and from a program to text."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

from styluscam import _engine
from styluscam.arguments import document_of, gcode_of, refused
from styluscam.errors import MachineError, PlanError, StylusError
from styluscam.programs.job import Job, JobLike
from styluscam.programs.machine import Machine, MachineLike
from styluscam.programs.program import Program
from styluscam.types import Document, Progress
from styluscam.words import counted, shortened

NEWLINE = "\n"

MAIN_CHANNEL = "main"
"""The channel that every plan has."""


class Plan:
    """What planning made of a job.

    A copy of it that went through pickle holds the programs and the summary; it plans again only where the engine's own
    plan is asked for, as for a summary with a verification.
    """

    def __init__(self, job: Job, machine: Machine, scene: _engine.Scene, engine: _engine.Plan) -> None:
        self.job = job
        self.machine = machine
        self.scene = scene
        self.engine = engine

    def __repr__(self) -> str:
        """Of which job, and how long its program is."""
        return f"<Plan of {shortened(self.job.title, 30)!r}: {self.programs[MAIN_CHANNEL].extent}, for {self.machine.name}>"

    def __eq__(self, other: object) -> bool:
        """Whether job, machine and programs are the same."""
        if not isinstance(other, Plan):
            return NotImplemented
        return (self.job, self.machine, self.programs) == (other.job, other.machine, other.programs)

    def __hash__(self) -> int:
        """As equality compares."""
        return hash(self.programs[MAIN_CHANNEL])

    def __getstate__(self) -> Document:
        """For pickle and copy."""
        return {"job": self.job, "machine": self.machine, "programs": self.programs, "_summary": self._summary}

    @cached_property
    def scene(self) -> _engine.Scene:
        """The part as it lies on the machine."""
        return self.job.scene()

    @cached_property
    def engine(self) -> _engine.Plan:
        """The engine's plan."""
        return _engine.plan(self.job.engine, self.scene, self.machine.engine)

    @cached_property
    def programs(self) -> dict[str, Program]:
        """Programs by channel; ``"main"`` is always there."""
        return {channel: Program(program) for channel, program in self.engine.programs.items()}

    def summary(self, judgement: _engine.Judgement | None = None) -> tuple[Document, list[str]]:
        """The job in numbers, and the lines on it in a program's header."""
        document, notes = self._summary if judgement is None else self._summed(judgement)
        return json.loads(document), list(notes)

    @cached_property
    def _summary(self) -> tuple[str, list[str]]:
        return self._summed(None)

    def _summed(self, judgement: _engine.Judgement | None) -> tuple[str, list[str]]:
        return self.engine.summary(MAIN_CHANNEL, self.scene, self.machine.engine, judgement)


@dataclass(frozen=True, repr=False)
class Posted:
    """Posted text by file name."""

    files: dict[str, str]

    def __post_init__(self) -> None:
        """Refuses what are no texts by their names."""
        texts = document_of(self.files, "files", "a dict of texts by their names", StylusError)
        for name, text in texts.items():
            if not isinstance(text, str):
                raise refused(f"files[{name!r}]", text, "a text", StylusError)

    def __repr__(self) -> str:
        """The files with their lines."""
        sizes = [f"{shortened(name, 40)}, {counted(text.count(NEWLINE), 'line')}" for name, text in self.files.items()]
        return f"<Posted: {shortened('; '.join(sizes) or 'nothing', 120)}>"

    def __hash__(self) -> int:
        """As equality compares."""
        return hash(tuple(self.files.items()))

    @property
    def text(self) -> str:
        """The only file's text."""
        texts = list(self.files.values())
        if len(texts) != 1:
            names = ", ".join(self.files) or "none"
            raise StylusError(
                f"text: of one file, and there are {len(texts)} ({names})", code="files", hint="see .files"
            )
        return texts[0]


def plan(job: JobLike, *, progress: Progress | None = None, cancel: _engine.CancelToken | None = None) -> Plan:
    """Plans every operation of a job: a :class:`Job`, a dict, or the name of a job file.

    Raises:
        JobError, GeometryError, ToolError, PlanError, MachineError: nothing is planned then.
        Cancelled: by ``progress`` or ``cancel``.
    """
    work = Job.of(job)
    machine = work.machine()
    scene = work.scene(progress)
    engine = _engine.plan(work.engine, scene, machine.engine, progress=progress, cancel=cancel)
    return Plan(work, machine, scene, engine)


def post(plan: Plan | Program, machine: MachineLike | None = None, notes: list[str] | None = None) -> Posted:
    """The text of a plan, or of a program, for a machine: by name, file, dict or object.

    ``machine`` may be left out for a plan: the job's own. ``notes`` are lines for the header.

    Raises:
        JobError, MachineError: the machine cannot be given this program; nothing is posted then.
    """
    target = None if machine is None else Machine.of(machine)
    if isinstance(plan, Program):
        if target is None:
            raise MachineError(
                "machine: a program names none",
                code="argument",
                where="machine",
                hint="give one: post(program, machine)",
            )
        work = plan if notes is None else plan.with_notes(notes)
        return Posted({"program.ngc": _engine.post(work.engine, target.engine)})
    if not isinstance(plan, Plan):
        raise refused("plan", plan, "a Plan or a Program", PlanError, "sc.plan(job) makes one")
    lines = plan.summary()[1] if notes is None else notes
    program = plan.programs[MAIN_CHANNEL].with_notes(lines)
    return Posted({output_name(plan.job): _engine.post(program.engine, (target or plan.machine).engine)})


def output_name(job: Job) -> str:
    """The G-code's file as the job names it."""
    return str(job.document["output"]["file"]) or f"{job.name}.ngc"


TextLike: TypeAlias = "str | os.PathLike[str] | Posted"
"""G-code, its file, or what was posted."""


def text_of(text: TextLike) -> str:
    """The G-code that a call takes: a text, a file that holds one, or what was posted.

    Raises:
        VerifyError: as :func:`styluscam.arguments.gcode_of`.
    """
    return text.text if isinstance(text, Posted) else gcode_of(text)


def read_gcode(text: TextLike, machine: MachineLike) -> Program:
    """The program that ``machine`` would read; strict: what it would not understand raises ``VerifyError``.

    ``text`` is G-code, or the name of a file that holds it: a single line that is an existing file, or ends as file names do.
    It is for looking at and measuring: moves to the machine's own positions, and lines behind a ``/``, are no moves of it.
    To post a text for another machine, where such moves must not be lost, there is
    :func:`styluscam.programs.posting.read_program`.
    """
    return Program(_engine.read_gcode(text_of(text), Machine.of(machine).engine))
