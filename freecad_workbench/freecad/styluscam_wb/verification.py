# SPDX-License-Identifier: LGPL-2.1-or-later
"""From a CAM job to a verified text: what may be posted, the program of its objects, its text compared with the model."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import Path.Base.Util as PathUtil

from . import documents, engine, machines, motion, ops
from .long_work import Run

if TYPE_CHECKING:
    from styluscam import Machine, Program
    from styluscam.judging.verification import Report
    from styluscam.report import Subject

NO_REASON = "no reason is known"


class PostError(ValueError):
    """A job that must not be posted as it stands; the message states why."""

    hint = ""  # it stands in the message


# --- what is posted ----------------------------------------------------------------------------------------------


def active_operations(job: Any) -> list[Any]:
    """The operations that are posted."""
    return [obj for obj in job.Operations.Group if is_active(obj)]


def is_active(obj: Any) -> bool:
    """Whether an operation is posted; those that cannot be switched off are."""
    return PathUtil.opProperty(obj, "Active") is not False


def refuse_unfinished(job: Any) -> None:
    """Refuses a job while an operation of ours is not computed from what it shows.

    Raises:
        PostError: it names the operation.
    """
    for obj in active_operations(job):
        if ops.is_ours(obj):
            refuse_uncomputed(obj)
        base = getattr(obj, "Base", None)  # of a dressup
        if ops.is_ours(base):
            refuse_uncomputed(base)
            _refuse_motionless(base, ops.has_motion(base))


def refuse_uncomputed(obj: Any) -> None:
    """Refuses an operation of ours that is not computed from what it shows.

    Raises:
        PostError: it names the operation.
    """
    if "Invalid" in obj.State:
        raise PostError(f"{obj.Label} has failed ({ops.failure(obj) or NO_REASON}): correct it before posting")
    if "Touched" in obj.State:
        raise PostError(f"{obj.Label} has changed since it was computed: recompute the document before posting")
    if obj.ToolController is None or obj.ToolController.Tool is None:
        raise PostError(f"{obj.Label} has no tool: choose one and recompute before posting")


def _refuse_motionless(obj: Any, has_motion: bool) -> None:
    if not has_motion:
        why = ops.failure(obj) or NO_REASON
        raise PostError(f"{obj.Label} has no path ({why}): recompute the document before posting")


# --- programs and texts ------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Draft:
    """The program of what goes into one file, and the operations in it."""

    job: Any
    operations: list[Any]
    program: Program
    machine: str
    """Its name."""
    target: Machine

    @property
    def is_ours(self) -> bool:
        """Whether all of it can be verified."""
        return all(ops.is_ours(obj) for obj in self.operations)

    @property
    def notes(self) -> list[str]:
        """Those of planning."""
        return [note for obj in self.operations for note in obj.Notes]

    def text(self, notes: list[str]) -> str:
        """The machine's text with notes in its header."""
        return engine.text_of(self.program, self.target, notes)

    def text_to_verify(self) -> str:
        """The text with room for the figures of the verification, which are not known yet: its lines are the final ones."""
        return self.text([*self.notes, figures("-.----", "-.----")])

    def report(self, text: str, run: Run) -> Report:
        """What the verifier finds in the text, which is all ours; `run` runs what takes long.

        Raises:
            PostError: it uses several work offsets.
            DocumentError, ToolError, styluscam.StylusError: it cannot be verified.
        """
        if any(event["kind"] == "work-offset" for event in self.program.events):
            raise PostError(
                "several work offsets in one program cannot be verified: order the output by fixture and split it, "
                "or choose one work offset"
            )
        sc = engine.styluscam()
        part = ops.engine_part(self.operations[0], run)
        wcs = self.program.setup["wcs"]
        document = documents.job_document(self.job, self.operations, part, self.machine, wcs)
        checked = sc.Job.from_dict(document, part=part)
        report: Report = run(lambda progress: sc.verify(text, checked, progress=progress))
        return report


def draft_of(job: Any, items: list[Any], machine: str) -> Draft:
    """One file: tool controllers, operations and work offsets in order, as FreeCAD puts them into it.

    Raises:
        PostError, MotionError, ToolError, DocumentError, styluscam.StylusError: it cannot become a program.
    """
    builder = motion.Builder({int(tc.ToolNumber): tc for tc in job.Tools.Group})
    operations = []
    for item in items:
        if item in job.Tools.Group:
            builder.add_tool_change(item)
        elif item in job.Operations.Group:
            if is_active(item):
                operations.append(item)
                controller, coolant = (PathUtil.opProperty(item, name) for name in ("ToolController", "CoolantMode"))
                text = builder.add_operation(item, controller, _kind(item), str(coolant or "None"))
                if ops.is_ours(item):
                    _refuse_motionless(item, motion.moves(text))
        else:
            builder.add_fixture(item)
    if not operations:
        raise PostError(f"{job.Label} has no active operation: there is nothing to post")
    program = builder.program(_setup(job, operations))
    section = documents.machine_section(job, machine)
    target = engine.styluscam().Machine.of_section(section, machines.user_folder())
    return Draft(job, operations, program, machine, target)


def _kind(obj: Any) -> str:
    return str(obj.Strategy) if ops.is_ours(obj) else type(getattr(obj, "Proxy", obj)).__name__


def _setup(job: Any, operations: list[Any]) -> dict[str, Any]:
    """The program's record of the set-up, but for the work offset."""
    boxes = [model.Shape.BoundBox for model in job.Model.Group]
    heights = [obj.ClearanceHeight.Value for obj in operations if hasattr(obj, "ClearanceHeight")]
    top = max(box.ZMax for box in boxes)
    return {
        "title": f"{job.Document.Label}: {job.Label}",
        "zero": f"origin of the FreeCAD document: the model's highest point is at Z {top:.3f}",
        "part_min": [min(getattr(box, key) for box in boxes) for key in ("XMin", "YMin", "ZMin")],
        "part_max": [max(getattr(box, key) for box in boxes) for key in ("XMax", "YMax", "ZMax")],
        "clearance": max(heights, default=top),
        "notes": [],
    }


def figures(gouge: str, excess: str) -> str:
    """The line of a header that states what verification found, mm."""
    return f"judged from this text: worst gouge {gouge} mm, worst excess {excess} mm"


# --- a whole job -------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Verified:
    """The operations of ours in a job, posted in memory and verified."""

    draft: Draft
    report: Report
    left_out: tuple[str, ...]
    """Labels of active operations that are not ours: nothing of them was verified."""

    @property
    def subject(self) -> Subject:
        """What a report's page shows of it."""
        from styluscam.report import Subject

        return Subject.judged(self.report, self.draft.target, self.draft.job.Label)


def verify_job(job: Any, run: Run) -> Verified:
    """Posts all active operations of ours in memory, in the job's order and with its first work offset, and verifies them.

    `run` runs what takes long.

    Raises:
        PostError: there are none, or one of them is not computed from what it shows.
        MotionError, ToolError, DocumentError, styluscam.StylusError: they cannot be posted or verified.
        styluscam.Cancelled: by whom `run` asks.
    """
    active = active_operations(job)
    ours = [obj for obj in active if ops.is_ours(obj)]
    if not ours:
        raise PostError(f"{job.Label} has no active operation of StylusCAM: there is nothing to verify")
    for obj in ours:
        refuse_uncomputed(obj)
    draft = draft_of(job, ours, documents.machine_of(job))
    report = draft.report(draft.text_to_verify(), run)
    return Verified(draft, report, tuple(obj.Label for obj in active if obj not in ours))
