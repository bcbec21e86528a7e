# SPDX-License-Identifier: LGPL-2.1-or-later
"""From operations and their CAM job to the engine's job document.

The program's zero is FreeCAD's: `setup.zero` is "model" and the part is given in the document's coordinates, so a
height, a depth or a coordinate means the same in the operation, in its path and in the posted text. Where that origin
lies on the machine is set by the work offset (the job's fixture, G54).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from . import engine, machines, properties, tools, wires
from .fields import JOB, OPERATION, PART, PROCESS, SECONDS, SETUP, SHEET

if TYPE_CHECKING:
    from styluscam import Part as EnginePart

Document = dict[str, Any]

DEFAULT_MACHINE = "linuxcnc"
"""The machine whose rounding planning takes into account when the job has no post of ours."""

AUTOMATIC = 1e-6
"""Depths that differ from FreeCAD's automatic ones by less (mm) are not sent: the engine finds both ends."""


class DocumentError(ValueError):
    """Operations that make no job; the message states why."""


def machine_of(job: Any) -> str:
    """The machine that the job's post is for."""
    post = str(getattr(job, "PostProcessor", "") or "")
    prefix = machines.POST_PREFIX
    return post.removeprefix(prefix) if post.startswith(prefix) else DEFAULT_MACHINE


def sheet_raise(obj: Any) -> float:
    """How far the sheet lifts the tool over a horizontal face of the model, mm; 0 until the sheet is described."""
    if not properties.takes_sheet(obj):
        return 0.0
    sheet = properties.section(obj, SHEET) | properties.section(obj, PART, "model_face")
    is_described = "model_face" in sheet and sheet["thickness"] > 0.0
    return engine.sheet_raise(sheet) if is_described else 0.0


def job_document(job: Any, operations: list[Any], part: EnginePart, machine: str, wcs: str | None = None) -> Document:
    """The document of these operations of ours, in this order; they must agree on all but the operation's own properties.

    `wcs` is the work offset, the job's first unless it is given.

    Raises:
        DocumentError, properties.PropertyError: they do not, or a value is not one.
        tools.ToolError: a tool bit that has no profile.
    """
    first = operations[0]
    for other in operations[1:]:
        for name in properties.shared():
            if getattr(first, name) != getattr(other, name):
                raise DocumentError(f"{first.Label} and {other.Label} differ in {name}: they cannot be one program")
    top = float(part.bounds[1][2]) + sheet_raise(first)
    return {
        "schema": 1,
        "title": job.Label,
        **_accepted(operations),
        "part": {"file": model_of(first).Label, **properties.section(first, PART)},
        "setup": {
            "zero": "model",
            "wcs": wcs or str(job.Fixtures[0]),
            "clearance": _above("ClearanceHeight", operations, top),
            "retract": _above("SafeHeight", operations, top),
            **properties.section(first, SETUP),
            **({"sheet": properties.section(first, SHEET)} if properties.takes_sheet(first) else {}),
        },
        "process": properties.section(first, PROCESS),
        "tools": {tool_name(obj.ToolController): _tool_section(obj.ToolController) for obj in operations},
        "operations": [operation_section(obj) for obj in operations],
        "machine": machine_section(job, machine),
    }


def _above(name: str, operations: list[Any], top: float) -> float:
    """How far the lowest of the operations' heights is above the model, mm; the document counts from there.

    Raises:
        DocumentError: it is not above.
    """
    lowest = min(operations, key=lambda obj: getattr(obj, name).Value)
    height = getattr(lowest, name).Value
    if height > top:
        return float(height - top)
    raise DocumentError(
        f"{lowest.Label}: {name} is {height:g} mm, and the top of what is worked on lies at {top:g} mm: "
        "raise it, or check the job's stock, from which FreeCAD takes its heights"
    )


def machine_section(job: Any, machine: str) -> Document:
    """The machine and its options: the arguments of the job's post, where that is ours.

    Raises:
        machines.ArgumentError: an argument that is not known.
    """
    return {**machines.section(machine), "options": machines.options(post_arguments(job))}


def post_arguments(job: Any) -> str:
    """The arguments of the job's post, where that is ours: another post's are none of ours."""
    post = str(getattr(job, "PostProcessor", "") or "")
    return str(getattr(job, "PostProcessorArgs", "") or "") if post.startswith(machines.POST_PREFIX) else ""


def _accepted(operations: list[Any]) -> Document:
    """Keys of the job itself, lists: what any of the operations has in them."""
    found: dict[str, set[str]] = {}
    for obj in operations:
        for key, words in properties.section(obj, JOB).items():
            found.setdefault(key, set()).update(words)
    return {key: sorted(words) for key, words in found.items()}


def model_of(obj: Any) -> Any:
    """The model that an operation works on: the clone in its job."""
    from PathScripts import PathUtils

    return PathUtils.findParentJob(obj).Model.Group[0]


def tool_name(controller: Any) -> str:
    """The tool's name in the document."""
    return f"T{controller.ToolNumber}"


def _tool_section(controller: Any) -> Document:
    return {"number": int(controller.ToolNumber), **tools.tool_document(controller.Tool)}


def operation_section(obj: Any) -> Document:
    """One [[operations]] entry from the operation's properties."""
    controller = obj.ToolController
    section: Document = {
        **properties.section(obj, OPERATION),
        "id": obj.Label,
        "tool": tool_name(controller),
        "faces": face_names(obj),
        **_feeds(controller),
        "spindle": _spindle(controller),
        "coolant": {"None": "off"}.get(obj.CoolantMode, str(obj.CoolantMode).lower()),
    }
    for key, depth, automatic in (
        ("z_top", obj.StartDepth.Value, obj.OpStartDepth.Value),
        ("z_bottom", obj.FinalDepth.Value, obj.OpFinalDepth.Value),
    ):
        if abs(depth - automatic) > AUTOMATIC:
            section[key] = depth
    linked = wires.loops(obj)
    if linked:
        boundary = section.setdefault("boundary", {})
        boundary["wire"] = [*boundary.get("wire", []), *linked]
    return section


def face_names(obj: Any) -> list[str] | str:
    """The selected faces, or "all" where WholeModel is set."""
    if obj.WholeModel:
        return "all"
    return [name for _, names in obj.Base for name in names if name]


def _feeds(controller: Any) -> Document:
    """The tool controller's feeds, mm/min; the engine's defaults where it states none, which FreeCAD writes as 0."""
    names = {"cut": "HorizFeed", "plunge": "VertFeed", "approach": "LeadInFeed", "exit": "LeadOutFeed"}
    # FreeCAD 1.0 has no feeds of leads
    stated = {key: getattr(controller, name).Value for key, name in names.items() if hasattr(controller, name)}
    feeds = {key: feed * SECONDS for key, feed in stated.items() if feed != 0.0}
    return {"feeds": feeds} if feeds else {}


def notes_on_feeds(controller: Any) -> list[str]:
    """A sentence where the tool controller states no feed."""
    missing = [name for name in ("HorizFeed", "VertFeed") if getattr(controller, name).Value == 0.0]
    if not missing:
        return []
    return [f"{controller.Label} states no {' and no '.join(missing)}: the engine's default feed is used"]


def notes_on_spindle(obj: Any) -> list[str]:
    """A sentence where the operation mills with a spindle that stands."""
    if str(obj.Process) != "milling" or _spindle(obj.ToolController)["mode"] != "off":
        return []
    return [f"{obj.ToolController.Label} leaves the spindle off: set its direction and speed before you mill"]


def _spindle(controller: Any) -> Document:
    """What the tool controller's own commands do to the spindle."""
    senses = {"M3": "clockwise", "M03": "clockwise", "M4": "counterclockwise", "M04": "counterclockwise"}
    for command in controller.Path.Commands:
        if command.Name in senses:
            return {"mode": "fixed", "rpm": command.Parameters.get("S", 0.0), "direction": senses[command.Name]}
    return {"mode": "off"}
