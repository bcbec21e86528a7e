"""Verification: posted text, read back, against the part."""

from __future__ import annotations

import json
from functools import cached_property
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from styluscam import _engine
from styluscam.arguments import A_FILE, FileName, channel_of, file_of, refused
from styluscam.errors import GeometryError, JobError, PlanError, VerifyError
from styluscam.files import read_gcode_text
from styluscam.judging import clearing, flanks
from styluscam.judging.brep import recheck
from styluscam.judging.results import FaceCoverage, Finding, Group, Scallops
from styluscam.programs.job import MAIN_CHANNEL, Job, JobLike
from styluscam.programs.machine import Machine, MachineLike
from styluscam.programs.planning import Plan, Posted, Setting, TextLike, output_name, text_of_channel
from styluscam.programs.program import Program
from styluscam.types import Document, FloatArray, Progress, shaped
from styluscam.types import points as rows
from styluscam.words import counted


class Report:
    """What verification found in a text."""

    def __init__(
        self,
        document: Document,
        judgement: _engine.Judgement,
        job: Job,
        scene: _engine.Scene,
        *,
        machine: Machine,
        text: str,
        channel: str = MAIN_CHANNEL,
        beside: str | None = None,
    ) -> None:
        self._document = document
        self.judgement = judgement
        self.program = Program(judgement.program)
        self.job, self.scene = job, scene
        self.machine = machine
        self.text = text
        self.channel = channel
        self.beside = beside
        """The text of the channel that works together with this one, where it was given."""
        self._coverage: list[FaceCoverage] | None = None

    def __repr__(self) -> str:
        """The verdict and the worst figures."""
        found = counted(len(self.findings), "finding") if self.findings else "nothing found"
        figures = f"worst gouge {self.gouge_max:.4f} mm, worst excess {self.excess_max:.4f} mm"
        return f"<Report: {'ok' if self.ok else 'FAILED'}, {found}, {figures}>"

    def __eq__(self, other: object) -> bool:
        """Whether the same was found in the same text for the same job."""
        if not isinstance(other, Report):
            return NotImplemented
        mine, theirs = (self.text, self.beside, self.machine), (other.text, other.beside, other.machine)
        return mine == theirs and self._document == other._document and self.job == other.job

    def __hash__(self) -> int:
        """As equality compares."""
        return hash(self.text)

    def __getstate__(self) -> Document:
        """For pickle and copy."""
        return {key: value for key, value in vars(self).items() if key not in ("judgement", "scene")}

    @property
    def path(self) -> Program:
        """The moves as the part sees them: those of ``program``, or the spirals that they are to a part that turns."""
        return Program(self.judgement.seen)

    @cached_property
    def scene(self) -> _engine.Scene:
        """The part as it lies on the machine."""
        return self.job.scene(channel=self.channel)

    @cached_property
    def judgement(self) -> _engine.Judgement:
        """The engine's results; a copy that went through pickle verifies again when they are needed."""
        other = _beside(self.job, self.channel, self.beside)
        return _engine.judge(self.job.engine, self.scene, self.machine.engine, self.text, other)

    @property
    def ok(self) -> bool:
        """Nothing was found that must not be."""
        return bool(self._document["ok"])

    @cached_property
    def findings(self) -> list[Finding]:
        """Each with kind, severity, line, position, value, limit, unit and a message."""
        return [Finding(**finding) for finding in self._document["findings"]]

    @cached_property
    def groups(self) -> list[Group]:
        """The findings by kind, and by region of the part where these are clearly separate; errors first."""
        return [Group(**group) for group in self._document["groups"]]

    @property
    def gouge_max(self) -> float:
        """Deepest entry into the part, mm."""
        return float(self._document["gouge_max"])

    @property
    def excess_max(self) -> float:
        """Largest distance from the part along the contact tracks, mm."""
        return float(self._document["excess_max"])

    def coverage(
        self, *, progress: Progress | None = None, cancel: _engine.CancelToken | None = None
    ) -> list[FaceCoverage]:
        """What the program leaves on each face that the job is for.

        What is left at a point is its distance from all that tool and sheet sweep on moves that are meant to touch. A
        point is covered where that is at most a hundredth of the smallest used tool's diameter; the scallop is the most
        among these. Of a sheet, what stays flat by itself needs no forming: where the blank lies before (flat), and level
        floors inside closed passes as deep as they, which go down with them (carried). Whole faces count, whatever
        heights the operations stop at.
        """
        if self._coverage is None:
            found = self.judgement.coverage(self.job.engine, self.scene, progress=progress, cancel=cancel)
            self._coverage = [FaceCoverage(**face) for face in json.loads(found)]
        return self._coverage

    def left(
        self,
        points: npt.ArrayLike,
        *,
        progress: Progress | None = None,
        cancel: _engine.CancelToken | None = None,
    ) -> FloatArray:
        """What the program leaves at points (N, 3) in work coordinates, (N,), mm: as in :meth:`coverage`.

        Negative where a move that is meant to touch sweeps over the point; infinite where there is no such move.

        Raises:
            GeometryError: no array of points.
            Cancelled: by ``progress`` or ``cancel``.
        """
        positions = rows(points, 3)
        odd = np.flatnonzero(~np.isfinite(positions).all(axis=1))
        if len(odd):
            message = f"points[{odd[0]}]: finite numbers expected"
            raise GeometryError(message, code="not-finite", where="points", hint="lengths are in mm")
        return self.judgement.left(self.job.engine, self.scene, positions, progress=progress, cancel=cancel)

    def needs(
        self,
        points: npt.ArrayLike,
        normals: npt.ArrayLike,
        *,
        progress: Progress | None = None,
        cancel: _engine.CancelToken | None = None,
    ) -> npt.NDArray[np.uint8]:
        """What points (N, 3) of the part in work coordinates ask for, with their unit normals (N, 3): as :meth:`coverage` has it.

        (N,) of 0: forming. 1: nothing, the blank lies there. 2: nothing, they go down flat with the passes around them.

        Raises:
            GeometryError: no arrays of points, or not as many of both.
            Cancelled: by ``progress`` or ``cancel``.
        """
        positions = rows(points, 3)
        ups = shaped(rows(normals, 3, "normals"), positions.shape, "normals")
        return self.judgement.needs(self.job.engine, self.scene, positions, ups, progress=progress, cancel=cancel)

    def scallops(
        self, *, count: int = 20_000, progress: Progress | None = None, cancel: _engine.CancelToken | None = None
    ) -> list[Scallops]:
        """The scallops that each operation leaves between its passes, at about ``count`` points of its faces.

        A scallop is measured where two neighbouring passes leave equally much, above the mean of what both leave where they
        touch: the path's tolerance is not in it. Where something else than the distance of the passes keeps the tool off,
        there is none. Operations whose passes have no order have none.

        Raises:
            GeometryError: a count below 1.
            Cancelled: by ``progress`` or ``cancel``.
        """
        if count < 1:
            raise GeometryError(
                f"count = {count}: at least 1", code="out-of-range", where="count", hint="20000 is usual"
            )
        found = self.judgement.scallops(self.job.engine, self.scene, count, progress=progress, cancel=cancel)
        return [Scallops(*arrays) for arrays in found]

    @cached_property
    def engagement(self) -> list[clearing.OperationEngagement]:
        """What each operation that clears stock (``pocket``) engages and removes along its feed moves, in the order of the job.

        It is what the findings ``engagement`` and ``removal-rate`` were looked for in: measured layer by layer on the moves of
        the text, as :func:`styluscam.engagement` does, with the job's stock. Other operations have none.
        """
        return [clearing.of_arrays(arrays) for arrays in self.judgement.engagement()]

    @cached_property
    def flanks(self) -> list[flanks.OperationFlank]:
        """What each operation that mills with the side of a leaning tool (``flank``) leaves of its surfaces, in the job's order.

        It is measured along the surfaces' normals of all that the tool sweeps on the feed moves of the text. Other operations
        have none.
        """
        return [flanks.of_arrays(arrays) for arrays in self.judgement.flanks()]

    @property
    def scallop(self) -> float:
        """Largest scallop on the faces that the job is for, mm: what :meth:`coverage` finds where it is covered."""
        return max((face.scallop for face in self.coverage()), default=0.0)

    def to_dict(self) -> Document:
        """Everything, as plain data."""
        return self._document


def judge_plan(
    plan: Plan,
    text: str,
    progress: Progress | None = None,
    cancel: _engine.CancelToken | None = None,
    channel: str = MAIN_CHANNEL,
    *,
    beside: str | None = None,
) -> Report:
    """Checks the ``text`` of a plan's channel against its part, and its contacts against the exact model.

    ``beside`` is the text of the channel that works together with it, where the process has one.
    """
    other = _beside(plan.job, channel, beside, plan.settings)
    return _checked(plan.job, plan.settings[channel], channel, text, beside=other, progress=progress, cancel=cancel)


def verify(
    text: TextLike,
    job: JobLike,
    machine: MachineLike | None = None,
    *,
    channel: str = MAIN_CHANNEL,
    beside: TextLike | None = None,
    progress: Progress | None = None,
    cancel: _engine.CancelToken | None = None,
) -> Report:
    """Verifies posted text: gouge, excess, rapids, order; nothing of planning is used.

    ``text`` is G-code, what was posted, or the name of a file that holds it (see :func:`styluscam.read_gcode`); the job's
    machine reads it unless another is given. ``channel`` is the one that the text is for, where the job has several.
    ``beside`` is the text of the channel that works together with it (of double-sided forming: main and support); where all
    channels were posted at once, it is taken from there. Without it a warning states what is not checked.

    Raises:
        JobError: the job has no such channel.
        VerifyError: the text is not what the machine understands, or the file cannot be read.
    """
    work = Job.of(job)
    reader = work.machine(channel) if machine is None else Machine.of(machine)
    partner = work.engine.partner_of(channel)
    if beside is None and isinstance(text, Posted):
        beside = text.files.get(output_name(work, partner)) if partner else None
    other = None if beside is None or partner is None else text_of_channel(beside, work, partner)
    own = text_of_channel(text, work, channel)
    return _verified(own, work, reader, channel, beside=other, progress=progress, cancel=cancel)


def verify_file(
    path: FileName,
    job: JobLike,
    machine: MachineLike | None = None,
    *,
    channel: str = MAIN_CHANNEL,
    beside: FileName | None = None,
    progress: Progress | None = None,
    cancel: _engine.CancelToken | None = None,
) -> Report:
    """As :func:`verify`, for files alone: ``path`` and ``beside`` are never taken for G-code."""
    named = "sc.verify(text, job) takes a text"
    file = file_of(path, "path", A_FILE, VerifyError, named)
    other = None if beside is None else read_gcode_text(file_of(beside, "beside", A_FILE, VerifyError, named))
    work = Job.of(job)
    reader = work.machine(channel) if machine is None else Machine.of(machine)
    return _verified(read_gcode_text(file), work, reader, channel, beside=other, progress=progress, cancel=cancel)


def check_program(
    plan: Plan | Program,
    job: JobLike | None = None,
    *,
    channel: str = MAIN_CHANNEL,
    progress: Progress | None = None,
    cancel: _engine.CancelToken | None = None,
) -> Report:
    """The same probes on a plan, or a program for a job, that was not posted for its machine yet; never called verified.

    Raises:
        JobError: a program without a job.
    """
    if isinstance(plan, Program):
        if job is None:
            hint = "give one: check_program(program, job)"
            raise JobError("job: not given, and a program names none", code="argument", where="job", hint=hint)
        work = Job.of(job)
        machine = work.machine(channel)
        text = _engine.post(plan.engine, machine.engine)
        return _verified(text, work, machine, channel, progress=progress, cancel=cancel)
    if not isinstance(plan, Plan):
        raise refused("plan", plan, "a Plan or a Program", PlanError, "sc.plan(job) makes one")
    channel_of(channel, plan.programs, PlanError)
    texts = {one: _engine.post(plan.engine.programs[one], plan.machines[one].engine) for one in plan.programs}
    partner = plan.job.engine.partner_of(channel)
    return judge_plan(plan, texts[channel], progress, cancel, channel, beside=texts[partner] if partner else None)


_Beside: TypeAlias = "tuple[_engine.Scene, _engine.Machine, str]"
"""What the engine takes for the channel that works together with another."""


def _beside(job: Job, channel: str, text: str | None, settings: dict[str, Setting] | None = None) -> _Beside | None:
    partner = job.engine.partner_of(channel)
    if text is None or partner is None:
        return None
    setting = settings[partner] if settings else Setting.of(job, partner)
    return setting.scene, setting.machine.engine, text


def _verified(
    text: str,
    job: Job,
    machine: Machine,
    channel: str,
    *,
    beside: str | None = None,
    progress: Progress | None,
    cancel: _engine.CancelToken | None,
) -> Report:
    setting = Setting(job.scene(progress, channel), machine)
    other = _beside(job, channel, beside)
    return _checked(job, setting, channel, text, beside=other, progress=progress, cancel=cancel)


def _checked(
    job: Job,
    setting: Setting,
    channel: str,
    text: str,
    *,
    beside: _Beside | None,
    progress: Progress | None,
    cancel: _engine.CancelToken | None,
) -> Report:
    scene, machine = setting
    judgement = _engine.judge(job.engine, scene, machine.engine, text, beside, progress=progress, cancel=cancel)
    document: Document = json.loads(judgement.report())
    recheck(document, job, scene)
    other = beside[2] if beside else None
    return Report(document, judgement, job, scene, machine=machine, text=text, channel=channel, beside=other)
