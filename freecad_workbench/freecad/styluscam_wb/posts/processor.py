# SPDX-License-Identifier: LGPL-2.1-or-later
"""From a CAM job to a machine's text: FreeCAD's commands as a program, posted, and verified where all of it is ours."""

from __future__ import annotations

from typing import Any

import Path.Base.Util as PathUtil
from Path.Post.Processor import PostProcessor

from .. import documents, engine, machines, motion, ops


class PostError(ValueError):
    """A job that must not be posted as it stands; the message states why."""


def post_for(machine: str) -> type[PostProcessor]:
    """The class that FreeCAD makes for each job that it posts for this machine."""

    class MachinePost(PostProcessor):
        """Posts for one machine."""

        def __init__(self, job: Any) -> None:
            super().__init__(job, tooltip="", tooltipargs="", units="Metric")

        @property
        def tooltip(self) -> str:
            return f"StylusCAM's post for the machine {machine}: verifies what it posts where all of it is StylusCAM's."

        @property
        def tooltipArgs(self) -> str:
            words = [*machines.ARGUMENTS, *(f"{name}=..." for name in machines.VALUES)]
            return "Arguments: " + ", ".join(words)

        def export(self) -> list[tuple[str, str]]:
            """Sections of text, as FreeCAD writes them to files.

            Raises:
                PostError, MotionError, ToolError, DocumentError, styluscam.StylusError: nothing must be written.
            """
            refuse_unfinished(self._job)
            return [(name, section_text(self._job, items, machine)) for name, items in self._buildPostList()]

    return MachinePost


def refuse_unfinished(job: Any) -> None:
    """Posts nothing while an operation of ours is not computed from what it shows."""
    for obj in active_operations(job):
        for ours in filter(ops.is_ours, (obj, getattr(obj, "Base", None))):
            if "Invalid" in ours.State:
                raise PostError(f"{ours.Label} has failed ({_reason(ours)}): correct it before posting")
            if "Touched" in ours.State:
                raise PostError(
                    f"{ours.Label} has changed since it was computed: recompute the document before posting"
                )
            if ours.ToolController is None or ours.ToolController.Tool is None:
                raise PostError(f"{ours.Label} has no tool: choose one and recompute before posting")
            if not has_motion(ours):
                raise PostError(f"{ours.Label} has no path ({_reason(ours)}): recompute the document before posting")


def active_operations(job: Any) -> list[Any]:
    """The operations that are posted."""
    return [obj for obj in job.Operations.Group if is_active(obj)]


def is_active(obj: Any) -> bool:
    """Whether an operation is posted; those that cannot be switched off are."""
    return PathUtil.opProperty(obj, "Active") is not False


def has_motion(obj: Any) -> bool:
    """Whether an operation's path moves the tool."""
    return any(command.Name in motion.MOTIONS for command in obj.Path.Commands)


def _reason(obj: Any) -> str:
    commands = obj.Path.Commands
    return str(commands[0].Name.strip("()")) if commands else "no reason is known"


def section_text(job: Any, items: list[Any], machine: str) -> str:
    """One file: what FreeCAD puts into it, in order."""
    builder = motion.Builder({int(tc.ToolNumber): tc for tc in job.Tools.Group})
    operations = []
    for item in items:
        if item in job.Tools.Group:
            builder.add_tool_change(item)
        elif item in job.Operations.Group:
            if is_active(item):
                operations.append(item)
                controller, coolant = (PathUtil.opProperty(item, name) for name in ("ToolController", "CoolantMode"))
                builder.add_operation(item, controller, _kind(item), str(coolant or "None"))
        else:
            builder.add_fixture(item)
    if not operations:
        raise PostError(f"{job.Label} has no active operation: there is nothing to post")
    program = builder.program(_setup(job, operations))
    sc = engine.styluscam()
    target = sc.Machine.of_section(documents.machine_section(job, machine), machines.user_folder())
    if all(ops.is_ours(obj) for obj in operations):
        if any(event["kind"] == "work-offset" for event in program.events):
            raise PostError(
                "several work offsets in one program cannot be verified: order the output by fixture and split it, "
                "or choose one work offset"
            )
        return _verified_text(job, operations, program, machine, target)
    return engine.text_of(program, target, ["not judged: operations that are not StylusCAM's are in it"])


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


def _verified_text(job: Any, operations: list[Any], program: Any, machine: str, target: Any) -> str:
    """The text of a program that is all ours, after the engine's verifier has read it against the model.

    The figures go into the header, so it is posted again with them; nothing but comments differs then.
    """
    sc = engine.styluscam()
    notes = [note for obj in operations for note in obj.Notes]
    text = engine.text_of(program, target, [*notes, _verdict("-.----", "-.----")])
    part = ops.engine_part(operations[0])
    document = documents.job_document(job, operations, part, machine, program.setup["wcs"])
    report = sc.verify(text, sc.Job.from_dict(document, part=part))
    if not report.ok:
        raise PostError(f"the posted text fails verification: {report.findings[0]['message']}")
    final = engine.text_of(program, target, [*notes, _verdict(f"{report.gouge_max:.4f}", f"{report.excess_max:.4f}")])
    if _code(final) != _code(text):
        raise PostError("the header changed the program: please report this")
    return final


def _verdict(gouge: str, excess: str) -> str:
    return f"judged from this text: worst gouge {gouge} mm, worst excess {excess} mm"


def _code(text: str) -> list[str]:
    return [line for line in text.splitlines() if not line.startswith(("(", ";"))]
