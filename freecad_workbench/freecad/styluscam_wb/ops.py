# SPDX-License-Identifier: LGPL-2.1-or-later
"""The operation: FreeCAD's properties in, one entry of the engine's job document planned, a path out.

A failed operation holds no motion: its path is one comment with the reason, and its state is Invalid.
StartDepth and FinalDepth are heights of the tool's tip; at their automatic values the engine finds both ends.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import FreeCAD
import Path
import Path.Op.Base as PathOp
from PathScripts import PathUtils

from . import documents, engine, motion, post_list, properties, tools
from .part import part_of

if TYPE_CHECKING:
    from styluscam import Part as EnginePart

post_list.register()

NAME = "Stylus"

WHOLE_MODEL = "All faces that face up, when no face is selected"
"""Tool tip."""


class OperationError(ValueError):
    """An operation that cannot be computed; the message states why and what to do."""


class ObjectStylus(PathOp.ObjectOp):
    """An operation of the engine's, whatever its strategy."""

    _choosing = False
    _chosen: Any = None

    def __init__(self, obj: Any, name: str, parentJob: Any = None) -> None:
        # Without a window nobody can be asked, and FreeCAD's search fails over two suitable tools (its issue 31849):
        # while the operation is made only the first one is offered.
        self._choosing = not FreeCAD.GuiUp
        super().__init__(obj, name, parentJob)
        self._choosing = False

    # What FreeCAD asks of an operation

    def opFeatures(self, obj: Any) -> int:
        """Which of FreeCAD's standard properties it has."""
        return (
            PathOp.FeatureTool
            | PathOp.FeatureDepths
            | PathOp.FeatureHeights
            | PathOp.FeatureBaseFaces
            | PathOp.FeatureCoolant
        )

    def initOperation(self, obj: Any) -> None:
        """Adds the properties."""
        update_properties(obj)

    def opSetDefaultValues(self, obj: Any, job: Any) -> None:
        """Selected faces alone; the other properties begin with the engine's defaults when they are added."""
        obj.WholeModel = False

    def isToolSupported(self, obj: Any, tool: Any) -> bool:
        """Whether there is a profile for the tool."""
        supported = tools.is_supported(tool)
        if not (supported and self._choosing):
            return supported
        self._chosen = self._chosen or tool
        return bool(tool == self._chosen)

    def sanitizeBase(self, obj: Any) -> bool:
        """Keeps a Base whose faces are gone: computing reports it, instead of planning something else."""
        return False

    def updateDepths(self, obj: Any, ignoreErrors: bool = False) -> Any:
        """Leaves the depths alone while Base is not whole."""
        return None if stale_faces(obj) else super().updateDepths(obj, ignoreErrors)

    def opUpdateDepths(self, obj: Any) -> None:
        """The automatic depths: where the tool's tip stands on the highest and on the lowest point of the faces."""
        boxes = [face.BoundBox for face in _selected_faces(obj)]
        if not boxes or not engine.is_there() or not properties.are_complete(obj):
            return
        lift = documents.sheet_raise(obj)
        top, bottom = max(box.ZMax for box in boxes) + lift, min(box.ZMin for box in boxes) + lift
        if abs(obj.OpStartDepth.Value - top) > documents.AUTOMATIC:
            obj.OpStartDepth = top
        if abs(obj.OpFinalDepth.Value - bottom) > documents.AUTOMATIC:
            obj.OpFinalDepth = bottom

    def opOnChanged(self, obj: Any, prop: str) -> None:
        """A change of the sheet moves the automatic depths; one of a kind, which properties apply."""
        if "Restore" in obj.State or obj.getGroupOfProperty(prop) != properties.GROUP or not engine.is_there():
            return
        if prop in properties.kind_properties():
            properties.show_owned(obj)
        if prop == "WholeModel" or prop in properties.shared():
            self.updateDepths(obj, True)

    def execute(self, obj: Any) -> Any:
        """Computes the path; whatever goes wrong, none of an older one stays."""
        if not obj.Active:
            return super().execute(obj)
        obj.Path = _only_comment("not computed")
        try:
            check(obj)
            update_properties(obj)
            return super().execute(obj)
        except BaseException as error:
            obj.Path = _only_comment(reason(error))
            obj.CycleTime = ""
            obj.Notes = []
            raise

    def opExecute(self, obj: Any) -> None:
        """Plans the operation and fills the command list."""
        sc = engine.styluscam()
        part = engine_part(obj)
        document = documents.job_document(self.job, [obj], part, documents.machine_of(self.job))
        plan = sc.plan(sc.Job.from_dict(document, part=part))
        self.commandlist.extend(motion.commands_of(plan.programs["main"]))
        obj.Notes = plan.summary()[1][:-1]  # the last line is for a verified text


def engine_part(obj: Any) -> EnginePart:
    """The engine's part of the model that an operation works on."""
    model = documents.model_of(obj)
    return part_of(model.Shape, obj.ModelTolerance.Value, model.Label)


# --- properties --------------------------------------------------------------------------------------------------


def update_properties(obj: Any) -> None:
    """Adds what is missing and brings choices up to date with the engine; values stay."""
    properties.update(obj)
    if not hasattr(obj, "WholeModel"):
        obj.addProperty("App::PropertyBool", "WholeModel", properties.GROUP, WHOLE_MODEL)
    if not hasattr(obj, "Notes"):
        obj.addProperty("App::PropertyStringList", "Notes", properties.GROUP, "Summary and warnings of planning")
        obj.setEditorMode("Notes", 1)


# --- checks ------------------------------------------------------------------------------------------------------


def check(obj: Any) -> None:
    """Refuses what FreeCAD would ignore in silence.

    Raises:
        OperationError: no job, no model, no tool, no face, or a face that the model no longer has.
    """
    job = PathUtils.findParentJob(obj)
    if job is None:
        raise OperationError("the operation belongs to no CAM job: create it in one")
    models = job.Model.Group if job.Model else []
    if len(models) != 1:
        raise OperationError(
            f"the job has {len(models)} models: StylusCAM plans for one; fuse them or make jobs of them"
        )
    _check_tool(obj)
    if not obj.WholeModel and not documents.face_names(obj):
        raise OperationError("no face is selected: select faces of the model, or set WholeModel")
    for base, _ in obj.Base:
        if base != models[0]:
            raise OperationError(f"the selected faces are of {base.Label}, not of the job's model {models[0].Label}")
    missing = stale_faces(obj)
    if missing:
        raise OperationError(
            f"the model has no {', '.join(missing)} any more (it has Face1 to Face{len(models[0].Shape.Faces)}): "
            "select the faces again"
        )


def _check_tool(obj: Any) -> None:
    controller = obj.ToolController
    if controller is None or controller.ToolNumber == 0:
        raise OperationError("the operation has no tool: choose a tool controller with a number")
    tool = controller.Tool
    if tool is None or not float(tool.Diameter) > 0.0:
        raise OperationError(f"tool controller {controller.Label} has no tool bit with a diameter: choose one")


def stale_faces(obj: Any) -> list[str]:
    """Selected faces that the model's shape does not have."""
    missing = []
    for base, names in getattr(obj, "Base", None) or ():
        count = len(base.Shape.Faces)
        for name in (name.lstrip("?") for name in names if name):  # FreeCAD marks those that it misses
            number = name.removeprefix("Face")
            if not (name.startswith("Face") and number.isdecimal() and 1 <= int(number) <= count):
                missing.append(name)
    return missing


def _selected_faces(obj: Any) -> list[Any]:
    """The faces behind Base, or the whole model's shape."""
    selected = [base.Shape.getElement(name) for base, names in obj.Base or () for name in names if name]
    if not selected and getattr(obj, "WholeModel", False):
        return [documents.model_of(obj).Shape]
    return selected


def reason(error: BaseException) -> str:
    """An error's message, and its hint what to do."""
    hint = getattr(error, "hint", "")
    message = str(error) or type(error).__name__
    return f"{message}: {hint}" if hint and hint not in message else message


def _only_comment(text: str) -> Any:
    return Path.Path([Path.Command(motion.comment(text))])


# --- creation ----------------------------------------------------------------------------------------------------


def SetupProperties() -> list[str]:
    """Properties that a job's setup sheet may set for new operations.

    Raises:
        EngineMissingError: there is no engine.
    """
    return [field.name for field in properties.fields()]


def Create(name: str = NAME, obj: Any = None, parentJob: Any = None) -> Any:
    """A new operation in a job, the only one of the document unless it is given.

    Raises:
        EngineMissingError: there is no engine; the document is as it was.
    """
    engine.styluscam()
    if obj is None:
        obj = FreeCAD.ActiveDocument.addObject("Path::FeaturePython", name)
    obj.Proxy = ObjectStylus(obj, name, parentJob)
    return obj


def is_ours(obj: Any) -> bool:
    """Whether a document object is an operation of ours, computed or not."""
    return isinstance(getattr(obj, "Proxy", None), ObjectStylus)
