"""From a job to a program, and from a program to text."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import NamedTuple, TypeAlias

import numpy as np

from styluscam import _engine
from styluscam.arguments import channel_of, document_of, gcode_of, refused
from styluscam.errors import MachineError, PlanError, StylusError
from styluscam.programs.job import MAIN_CHANNEL, Job, JobLike
from styluscam.programs.machine import Machine, MachineLike
from styluscam.programs.program import Program
from styluscam.programs.summary import Summary
from styluscam.types import Document, FloatArray, Progress
from styluscam.words import counted, shortened

NEWLINE = "\n"


class Setting(NamedTuple):
    """What a channel is planned for."""

    scene: _engine.Scene
    """The part as it lies on the machine."""
    machine: Machine

    @classmethod
    def of(cls, job: Job, channel: str, progress: Progress | None = None) -> Setting:
        """As a job has it for a channel."""
        machine = job.machine(channel)
        return cls(job.scene(progress, channel), machine)


class Plan:
    """What planning made of a job.

    A copy of it that went through pickle holds the programs and the summary; it plans again only where the engine's own
    plan is asked for, as for a summary with a verification.
    """

    def __init__(self, job: Job, settings: dict[str, Setting], engine: _engine.Plan) -> None:
        self.job = job
        self.machines = {channel: setting.machine for channel, setting in settings.items()}
        self.settings = settings
        self.engine = engine

    def __repr__(self) -> str:
        """Of which job, and how long its program is."""
        return f"<Plan of {shortened(self.job.title, 30)!r}: {self.programs[MAIN_CHANNEL].extent}, for {self.machine.name}>"

    def __eq__(self, other: object) -> bool:
        """Whether job, machine and programs are the same."""
        if not isinstance(other, Plan):
            return NotImplemented
        return (self.job, self.machines, self.programs) == (other.job, other.machines, other.programs)

    def __hash__(self) -> int:
        """As equality compares."""
        return hash(self.programs[MAIN_CHANNEL])

    def __getstate__(self) -> Document:
        """For pickle and copy."""
        kept = ("job", "machines", "programs", "_summaries")
        return {name: getattr(self, name) for name in kept}

    @property
    def machine(self) -> Machine:
        """The machine of the main channel."""
        return self.machines[MAIN_CHANNEL]

    @property
    def scene(self) -> _engine.Scene:
        """The part as it lies on the machine of the main channel."""
        return self.settings[MAIN_CHANNEL].scene

    @cached_property
    def settings(self) -> dict[str, Setting]:
        """What each channel is planned for."""
        return {name: Setting(self.job.scene(channel=name), machine) for name, machine in self.machines.items()}

    @cached_property
    def engine(self) -> _engine.Plan:
        """The engine's plan."""
        return _planned(self.job, self.settings)

    @cached_property
    def programs(self) -> dict[str, Program]:
        """Programs by channel; ``"main"`` is always there."""
        programs = self.engine.programs
        return {channel: Program(programs[channel]) for channel in self.machines}

    @property
    def trim(self) -> list[FloatArray]:
        """Where a part with an addendum is cut off: points (N, 3) of closed curves in the main channel's work coordinates, mm."""
        rows = np.array(self.scene.frame)
        return [line @ rows[:, :3].T + rows[:, 3] for line in self.job.part().engine.trim]

    def summary(
        self, judgement: _engine.Judgement | None = None, channel: str = MAIN_CHANNEL
    ) -> tuple[Summary, list[str]]:
        """A channel in numbers, and the lines on it in its program's header.

        Raises:
            PlanError: the plan has no such channel.
        """
        channel_of(channel, self.programs, PlanError)
        document, notes = self._summaries[channel] if judgement is None else self._summed(channel, judgement)
        return Summary.of(json.loads(document)), list(notes)

    @cached_property
    def _summaries(self) -> dict[str, tuple[str, list[str]]]:
        return {channel: self._summed(channel, None) for channel in self.programs}

    def _summed(self, channel: str, judgement: _engine.Judgement | None) -> tuple[str, list[str]]:
        scene, machine = self.settings[channel]
        return self.engine.summary(channel, scene, machine.engine, judgement)


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
            raise StylusError(f"text: expected one file, got {len(texts)} ({names})", code="files", hint="use .files")
        return texts[0]


def plan(job: JobLike, *, progress: Progress | None = None, cancel: _engine.CancelToken | None = None) -> Plan:
    """Plans every operation of a job: a :class:`Job`, a dict, or the name of a job file.

    Raises:
        JobError, GeometryError, ToolError, PlanError, MachineError: nothing is planned then.
        Cancelled: by ``progress`` or ``cancel``.
    """
    work = Job.of(job)
    settings = {channel: Setting.of(work, channel, progress) for channel in work.channels}
    return Plan(work, settings, _planned(work, settings, progress, cancel))


def _planned(
    job: Job,
    settings: dict[str, Setting],
    progress: Progress | None = None,
    cancel: _engine.CancelToken | None = None,
) -> _engine.Plan:
    pairs = [(setting.scene, setting.machine.engine) for setting in settings.values()]
    return _engine.plan(job.engine, pairs, progress=progress, cancel=cancel)


def post(plan: Plan | Program, machine: MachineLike | None = None, notes: list[str] | None = None) -> Posted:
    """The text of a plan, or of a program, for a machine: by name, file, dict or object.

    ``machine`` may be left out for a plan: the job's own. ``notes`` are lines for the header. Of a plan there is one file a
    channel, and a machine can be given where there is one channel.

    Raises:
        JobError, MachineError: the machine cannot be given this program; nothing is posted then.
    """
    target = None if machine is None else Machine.of(machine)
    if isinstance(plan, Program):
        if target is None:
            raise MachineError(
                "machine: not given, and a program names none",
                code="argument",
                where="machine",
                hint="give one: post(program, machine)",
            )
        work = plan if notes is None else plan.with_notes(notes)
        return Posted({"program.ngc": _engine.post(work.engine, target.engine)})
    if not isinstance(plan, Plan):
        raise refused("plan", plan, "a Plan or a Program", PlanError, "sc.plan(job) makes one")
    if target is not None and len(plan.programs) > 1:
        message = (
            f"machine: expected one for each channel, the plan has {len(plan.programs)} ({', '.join(plan.programs)})"
        )
        hint = "leave it out, or post each of plan.programs"
        raise MachineError(message, code="argument", where="machine", hint=hint)
    files = {}
    for channel, program in plan.programs.items():
        lines = plan.summary(channel=channel)[1] if notes is None else notes
        machine_of = target or plan.machines[channel]
        files[output_name(plan.job, channel)] = _engine.post(program.with_notes(lines).engine, machine_of.engine)
    return Posted(files)


def of_channel(path: Path, channel: str) -> Path:
    """A file for a channel: the main one's as it is, another's with the channel before its endings."""
    stem, dot, endings = path.name.partition(".")
    return path if channel == MAIN_CHANNEL else path.with_name(f"{stem}.{channel}{dot}{endings}")


def output_name(job: Job, channel: str = MAIN_CHANNEL) -> str:
    """The G-code's file as the job names it, or by the job's name."""
    return job.output if channel == MAIN_CHANNEL else str(of_channel(Path(job.output), channel))


TextLike: TypeAlias = "str | os.PathLike[str] | Posted"
"""G-code, its file, or what was posted."""


def text_of(text: TextLike) -> str:
    """The G-code that a call takes: a text, a file that holds one, or what was posted as one file.

    Raises:
        VerifyError: as :func:`styluscam.arguments.gcode_of`.
    """
    return text.text if isinstance(text, Posted) else gcode_of(text)


def text_of_channel(text: TextLike, job: Job, channel: str) -> str:
    """As :func:`text_of`, of a channel where several were posted.

    Raises:
        VerifyError: as :func:`text_of`.
    """
    if isinstance(text, Posted) and len(text.files) > 1:
        return text.files.get(output_name(job, channel)) or text.text
    return text_of(text)


def read_gcode(text: TextLike, machine: MachineLike) -> Program:
    """The program that ``machine`` would read; strict: what it would not understand raises ``VerifyError``.

    ``text`` is G-code, or the name of a file that holds it: a single line that is an existing file, or ends as file names do.
    It is for looking at and measuring: moves to the machine's own positions, and lines behind a ``/``, are no moves of it.
    To post a text for another machine, where such moves must not be lost, there is
    :func:`styluscam.programs.posting.read_program`.
    """
    return Program(_engine.read_gcode(text_of(text), Machine.of(machine).engine))
