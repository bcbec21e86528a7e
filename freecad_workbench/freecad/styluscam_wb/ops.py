# SPDX-License-Identifier: LGPL-2.1-or-later
"""The operation: FreeCAD's properties in, one entry of the engine's job document planned, a path out.

A failed operation holds no motion: its path is one comment with the reason, and its state is Invalid.
StartDepth and FinalDepth are heights of the tool's tip; at their automatic values the engine finds both ends.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

import FreeCAD
import Path
import Path.Op.Base as PathOp
from PathScripts import PathUtils

from . import documents, engine, motion, post_list, properties, quiet, setup_sheet, tools, views, wires
from .long_work import Run, long_work
from .mistakes import OperationError, in_labels, is_fault, reason
from .part import part_of

if TYPE_CHECKING:
    from styluscam import Part as EnginePart

post_list.register()
setup_sheet.register()

MODEL = "PlannedModel"
"""The property through which FreeCAD knows that a path depends on its model, whether faces are selected or not."""

NO_ROTARY_AXES = "no-rotary-axes"
"""The engine's code for an operation whose tool leans on a machine that cannot turn it."""

WHOLE_MODEL = "All faces that face up, when no face is selected"
"""Tool tip."""


class ObjectStylus(PathOp.ObjectOp):
    """An operation of the engine's, whatever its strategy."""

    error: BaseException | None = None
    """Why the last computation failed; None where it did not."""

    _choosing = False
    _chosen: Any = None
    _program: Any = None
    """What was planned, until it is in the path."""

    _seconds = 0.0
    """Time on the machine, acceleration counted: FreeCAD takes the vertical feed wherever Z changes."""

    def __init__(self, obj: Any, name: str, parentJob: Any = None) -> None:
        # Without a window nobody can be asked, and FreeCAD's search fails over two suitable tools (its issue 31849):
        # while the operation is made only the first one is offered.
        self._choosing = not FreeCAD.GuiUp
        super().__init__(obj, name, parentJob)
        self._choosing = False

    @property
    def failed_key(self) -> str:
        """Where in the job document the last computation found its error: `operations[0].step`; empty where it found none."""
        return str(getattr(self.error, "where", "") or "")

    # What FreeCAD asks of an operation

    def onDocumentRestored(self, obj: Any) -> None:
        """Gives an operation that was made without a window its view."""
        super().onDocumentRestored(obj)
        views.attach(obj)

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
        self.error = None
        if not obj.Active:
            return super().execute(obj)
        quiet.restore()
        obj.Path = _only_comment("not computed")
        self._program = None
        try:
            check(obj)
            update_properties(obj)
            _depend_on_model(obj)
            result = super().execute(obj)
            self._insert_moves(obj)
            return result
        except BaseException as error:
            text = reason(error)
            self.error = error
            obj.Path = _only_comment(text)
            obj.CycleTime = ""
            obj.Notes = []
            if is_fault(error):
                raise
            quiet.without_traceback()
            raise OperationError(text) from None

    def opExecute(self, obj: Any) -> None:
        """Plans the operation; its moves come into the path that FreeCAD makes around them."""
        sc = engine.styluscam()
        with long_work(obj.Label) as run:
            part = engine_part(obj, run)
            document = documents.job_document(self.job, [obj], part, documents.machine_of(self.job))
            job = sc.Job.from_dict(document, part=part)
            try:
                plan = run(lambda report: sc.plan(job, progress=report))
            except sc.JobError as error:
                raise self._without_rotary_axes() if error.code == NO_ROTARY_AXES else error from None
        self._program = plan.programs["main"]
        self._seconds = float(self._program.times(plan.machines["main"])[-1])
        notes = map(in_labels, plan.summary()[1][:-1])  # the last line is for a verified text
        obj.Notes = [*notes, *documents.notes_on_feeds(obj.ToolController), *documents.notes_on_spindle(obj)]

    def _without_rotary_axes(self) -> OperationError:
        """A tool that leans, where the post's machine cannot turn it."""
        post = str(self.job.PostProcessor or "") or "none"
        return OperationError(
            f"the tool leans, and the machine of the job's post ({post}) has no rotary axes: choose that of a machine "
            "with them on the job's page Output, such as styluscam_linuxcnc-trunnion"
        )

    def _insert_moves(self, obj: Any) -> None:
        """Puts the planned moves before FreeCAD's last retract, and its comments before them."""
        program, self._program = self._program, None
        if program is None:
            return
        comments = [text for text in (obj.Label, obj.Comment) if text]
        obj.Path = motion.path_of(comments, program, obj.Path.Commands[-1:])
        obj.CycleTime = time.strftime("%H:%M:%S", time.gmtime(round(self._seconds)))
        self.job.Proxy.getCycleTime()


def engine_part(obj: Any, run: Run) -> EnginePart:
    """The engine's part of the model that an operation works on."""
    model = documents.model_of(obj)
    shape, tolerance, name = model.Shape, properties.number_in_range(obj, "ModelTolerance"), model.Label
    part: EnginePart = run(lambda report: part_of(shape, tolerance, name, report))
    return part


# --- properties --------------------------------------------------------------------------------------------------


def update_properties(obj: Any) -> None:
    """Adds what is missing and brings choices up to date with the engine; values stay."""
    properties.update(obj)
    if not hasattr(obj, "WholeModel"):
        obj.addProperty("App::PropertyBool", "WholeModel", properties.GROUP, WHOLE_MODEL)
    if not hasattr(obj, wires.PROPERTY):
        obj.addProperty("App::PropertyLinkSubList", wires.PROPERTY, properties.GROUP, wires.TEXT)
    if not hasattr(obj, MODEL):
        obj.addProperty("App::PropertyLink", MODEL, "Path", "The model that the path is for")
        obj.setEditorMode(MODEL, ["Hidden"])
    if not hasattr(obj, "Notes"):
        obj.addProperty("App::PropertyStringList", "Notes", properties.GROUP, "Summary and warnings of planning")
        obj.setEditorMode("Notes", 1)


def _depend_on_model(obj: Any) -> None:
    """Makes an edit of the model touch the operation."""
    model = documents.model_of(obj)
    if getattr(obj, MODEL) != model:
        setattr(obj, MODEL, model)


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


def failure(obj: Any) -> str:
    """Why an operation has no path; empty where it has one, or was never computed."""
    commands = [] if has_motion(obj) else obj.Path.Commands
    return str(commands[0].Name.strip("()")) if commands else ""


def has_motion(obj: Any) -> bool:
    """Whether an operation's path moves the tool."""
    return bool(obj.Path.Length > 0.0)  # in FreeCAD's own code: a list of all commands takes longer than posting them


def _only_comment(text: str) -> Any:
    return Path.Path([Path.Command(motion.comment(text))])


# --- creation ----------------------------------------------------------------------------------------------------


def SetupProperties() -> list[str]:
    """Properties that a job's setup sheet may set for new operations."""
    return setup_sheet.property_names()


def Create(name: str = setup_sheet.NAME, obj: Any = None, parentJob: Any = None) -> Any:
    """A new operation in a job, the only one of the document unless it is given.

    Raises:
        EngineMissingError: there is no engine; the document is as it was.
    """
    engine.styluscam()
    if obj is None:
        obj = FreeCAD.ActiveDocument.addObject("Path::FeaturePython", name)
    obj.Proxy = ObjectStylus(obj, setup_sheet.NAME, parentJob)
    views.attach(obj)
    return obj


def is_ours(obj: Any) -> bool:
    """Whether a document object is an operation of ours, computed or not."""
    return isinstance(getattr(obj, "Proxy", None), ObjectStylus)


def is_of_kind(obj: Any, kind: str) -> bool:
    """Whether a document object is an operation of ours of a kind, with all of its properties."""
    return is_ours(obj) and properties.kind_of(obj) == kind and properties.are_complete(obj)
