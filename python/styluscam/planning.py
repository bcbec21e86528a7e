"""From a job to a program, and from a program to text."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

from styluscam import _engine
from styluscam.arguments import gcode_of, refused
from styluscam.errors import MachineError, PlanError, StylusError
from styluscam.job import Job, JobLike
from styluscam.machine import Machine, MachineLike
from styluscam.program import Program
from styluscam.types import Document, Progress


@dataclass(frozen=True)
class Plan:
    """What planning made of a job."""

    job: Job
    machine: Machine
    scene: _engine.Scene
    engine: _engine.Plan

    @cached_property
    def programs(self) -> dict[str, Program]:
        """Programs by channel; ``"main"`` is always there."""
        return {"main": Program(self.engine.program)}

    def summary(self, judgement: _engine.Judgement | None = None) -> tuple[Document, list[str]]:
        """The job in numbers, and the lines that a program's header says of it."""
        document, notes = self.engine.summary(self.scene, self.machine.engine, judgement)
        return json.loads(document), notes


@dataclass(frozen=True)
class Posted:
    """Posted text by file name."""

    files: dict[str, str]

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
    scene = _engine.Scene(work.engine, work.part(progress).engine)
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
    program = plan.programs["main"].with_notes(lines)
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
    It is for looking at and measuring: ways to the machine's own places, and lines behind a ``/``, are no moves of it. To post a
    text for another machine, where such things must not be lost, there is :func:`styluscam.posting.read_program`.
    """
    return Program(_engine.read_gcode(text_of(text), Machine.of(machine).engine))
