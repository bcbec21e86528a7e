"""From a job to a program, and from a program to text."""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cached_property

from styluscam import _engine
from styluscam.errors import MachineError
from styluscam.job import Job
from styluscam.machine import Machine
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
        (text,) = self.files.values()
        return text


def plan(job: Job, *, progress: Progress | None = None, cancel: _engine.CancelToken | None = None) -> Plan:
    """Plans every operation.

    Raises:
        JobError, GeometryError, ToolError, PlanError, MachineError: nothing is planned then.
        Cancelled: by ``progress`` or ``cancel``.
    """
    machine = job.machine()
    scene = _engine.Scene(job.engine, job.part(progress).engine)
    engine = _engine.plan(job.engine, scene, machine.engine, progress=progress, cancel=cancel)
    return Plan(job, machine, scene, engine)


def post(plan: Plan | Program, machine: Machine | None = None, notes: list[str] | None = None) -> Posted:
    """The text of a plan, or of a program, for a machine.

    ``machine`` may be left out for a plan: the job's own. ``notes`` are lines for the header.

    Raises:
        JobError, MachineError: the machine cannot be given this program; nothing is posted then.
    """
    if isinstance(plan, Program):
        if machine is None:
            raise MachineError(
                "a program names no machine", code="machine-missing", hint="give one: post(program, machine)"
            )
        work = plan if notes is None else plan.with_notes(notes)
        return Posted({"program.ngc": _engine.post(work.engine, machine.engine)})
    program = plan.engine.program
    lines = plan.summary()[1] if notes is None else notes
    text = _engine.post(program.with_notes(lines), (machine or plan.machine).engine)
    return Posted({output_name(plan.job): text})


def output_name(job: Job) -> str:
    """The G-code's file as the job names it."""
    return str(job.document["output"]["file"]) or f"{job.name}.ngc"


def read_gcode(text: str, machine: Machine) -> Program:
    """The program that ``machine`` would read; strict: what it would not understand raises ``VerifyError``.

    It is for looking at and measuring: ways to the machine's own places, and lines behind a ``/``, are no moves of it. To post a
    text for another machine, where such things must not be lost, there is :func:`styluscam.posting.read_program`.
    """
    return Program(_engine.read_gcode(text, machine.engine))
