# SPDX-License-Identifier: LGPL-2.1-or-later
"""The operation: FreeCAD's properties in, one entry of the engine's job document planned, a path out.

A failed operation holds no motion: its path is one comment with the reason, and its state is Invalid.
StartDepth and FinalDepth are heights of the tool's tip; at their automatic values the engine finds both ends.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import FreeCAD
import Path
import Path.Op.Base as PathOp
from PathScripts import PathUtils

from . import compat, documents, engine, motion, tools
from .part import part_of

if TYPE_CHECKING:
    from styluscam import Part as EnginePart

compat.register_posts()

GROUP = "Stylus"
NAME = "Stylus"


class OperationError(ValueError):
    """An operation that cannot be computed; the message says why and what to do."""


@dataclass(frozen=True)
class Field:
    """A property and the key of the job document that it fills."""

    name: str
    kind: str
    section: str
    key: str
    default: Any = None  # only where the document has none


LENGTH, ANGLE, CHOICE = "App::PropertyLength", "App::PropertyAngle", "App::PropertyEnumeration"

FIELDS = (
    Field("Strategy", CHOICE, "OperationSection", "kind"),
    Field("Step", LENGTH, "OperationSection", "step", 0.5),
    Field("Stepover", LENGTH, "OperationSection", "stepover", 0.5),
    Field("Angle", ANGLE, "OperationSection", "angle_deg"),
    Field("Direction", CHOICE, "OperationSection", "direction"),
    Field("Tolerance", LENGTH, "OperationSection", "tolerance"),
    Field("SmallestFeature", LENGTH, "OperationSection", "smallest_feature"),
    Field("Process", CHOICE, "ProcessSection", "kind"),
    Field("SheetThickness", LENGTH, "SheetSection", "thickness", 0.0),
    Field("SheetLaw", CHOICE, "SheetSection", "law"),
    Field("ModelFace", CHOICE, "PartSection", "model_face", ""),
    Field("ModelTolerance", LENGTH, "PartSection", "tolerance"),
    Field("AllowUndercuts", "App::PropertyBool", "PartSection", "allow_undercuts"),
)
"""Descriptions, defaults and choices come from the engine's schema."""


class ObjectStylus(PathOp.ObjectOp):
    """An operation of the engine's, whatever its strategy."""

    _choosing = False
    _chosen: Any = None

    def __init__(self, obj: Any, name: str, parentJob: Any = None) -> None:
        # Without a window nobody can be asked, and FreeCAD's search fails over two suitable tools (its issue 31849):
        # while the operation is made it hears of the first one only.
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
        """What the document's schema says."""
        definitions = engine.styluscam().job_schema()["$defs"]
        for field in FIELDS:
            value = _default(field, definitions)
            if value is not None:
                setattr(obj, field.name, value)
        obj.WholeModel = False

    def isToolSupported(self, obj: Any, tool: Any) -> bool:
        """Whether there is a profile for the tool."""
        supported = hasattr(tool, tools.PROFILE) or compat.tool_kind(tool) in tools.NATIVE
        if not (supported and self._choosing):
            return supported
        self._chosen = self._chosen or tool
        return bool(tool == self._chosen)

    def sanitizeBase(self, obj: Any) -> bool:
        """Keeps a Base whose faces are gone: computing says so, instead of planning something else."""
        return False

    def updateDepths(self, obj: Any, ignoreErrors: bool = False) -> Any:
        """Leaves the depths alone while Base is not whole."""
        return None if stale_faces(obj) else super().updateDepths(obj, ignoreErrors)

    def opUpdateDepths(self, obj: Any) -> None:
        """The automatic depths: where the tool's tip stands on the highest and on the lowest place of the faces."""
        boxes = [face.BoundBox for face in _chosen_faces(obj)]
        if not boxes:
            return
        lift = documents.sheet_raise(obj) if hasattr(obj, "ModelFace") else 0.0
        top, bottom = max(box.ZMax for box in boxes) + lift, min(box.ZMin for box in boxes) + lift
        if abs(obj.OpStartDepth.Value - top) > documents.AUTOMATIC:
            obj.OpStartDepth = top
        if abs(obj.OpFinalDepth.Value - bottom) > documents.AUTOMATIC:
            obj.OpFinalDepth = bottom

    def opOnChanged(self, obj: Any, prop: str) -> None:
        """A change of the sheet moves the automatic depths."""
        if prop in ("Process", "SheetThickness", "ModelFace", "WholeModel") and "Restore" not in obj.State:
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
        obj.Notes = plan.summary()[1][:-1]  # the last line is for a judged text


def engine_part(obj: Any) -> EnginePart:
    """The engine's part of the model that an operation works on."""
    model = documents.model_of(obj)
    return part_of(model.Shape, obj.ModelTolerance.Value, model.Label)


# --- properties --------------------------------------------------------------------------------------------------


def update_properties(obj: Any) -> None:
    """Adds what is missing and brings choices up to date with the engine; values stay."""
    definitions = engine.styluscam().job_schema()["$defs"]
    for field in FIELDS:
        if not hasattr(obj, field.name):
            obj.addProperty(field.kind, field.name, GROUP, _entry(field, definitions).get("description", ""))
        if field.kind == CHOICE:
            _set_choices(obj, field, definitions)
    if not hasattr(obj, "WholeModel"):
        obj.addProperty("App::PropertyBool", "WholeModel", GROUP, "All faces that look up, when no face is chosen")
    if not hasattr(obj, "AcceptedRisks"):
        risks = "Risks that are taken, by name: what the judge would refuse for them becomes a warning"
        obj.addProperty("App::PropertyStringList", "AcceptedRisks", GROUP, risks)
    if not hasattr(obj, "Notes"):
        obj.addProperty("App::PropertyStringList", "Notes", GROUP, "What planning has to say")
        obj.setEditorMode("Notes", 1)


def _entry(field: Field, definitions: dict[str, Any]) -> dict[str, Any]:
    entry: dict[str, Any] = definitions[field.section]["properties"][field.key]
    return entry


def _default(field: Field, definitions: dict[str, Any]) -> Any:
    return _entry(field, definitions).get("default", field.default)


def _set_choices(obj: Any, field: Field, definitions: dict[str, Any]) -> None:
    choices = _choices(_entry(field, definitions), definitions)
    if field.default is not None:
        choices.insert(0, field.default)
    if obj.getEnumerationsOfProperty(field.name) != choices:
        value = getattr(obj, field.name) if obj.getEnumerationsOfProperty(field.name) else None
        setattr(obj, field.name, choices)
        if value in choices:
            setattr(obj, field.name, value)


def _choices(entry: dict[str, Any], definitions: dict[str, Any]) -> list[str]:
    """The words that a key of the document allows."""
    references = [entry, *entry.get("anyOf", ())]
    name = next(r["$ref"] for r in references if "$ref" in r).rpartition("/")[2]
    return [str(choice["const"]) for choice in definitions[name]["oneOf"]]


# --- checks ------------------------------------------------------------------------------------------------------


def check(obj: Any) -> None:
    """Refuses what FreeCAD would pass over in silence.

    Raises:
        OperationError: no job, no model, no tool, no face, or a face that the model has no more.
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
        raise OperationError("no face is chosen: choose faces of the model, or set WholeModel")
    for base, _ in obj.Base:
        if base != models[0]:
            raise OperationError(f"the chosen faces are of {base.Label}, not of the job's model {models[0].Label}")
    missing = stale_faces(obj)
    if missing:
        raise OperationError(
            f"the model has no {', '.join(missing)} any more (it has Face1 to Face{len(models[0].Shape.Faces)}): "
            "choose the faces again"
        )


def _check_tool(obj: Any) -> None:
    controller = obj.ToolController
    if controller is None or controller.ToolNumber == 0:
        raise OperationError("the operation has no tool: choose a tool controller with a number")
    tool = controller.Tool
    if tool is None or not float(tool.Diameter) > 0.0:
        raise OperationError(f"tool controller {controller.Label} has no tool bit with a diameter: choose one")


def stale_faces(obj: Any) -> list[str]:
    """Chosen names that the model's shape does not have."""
    missing = []
    for base, names in getattr(obj, "Base", None) or ():
        count = len(base.Shape.Faces)
        for name in (name.lstrip("?") for name in names if name):  # FreeCAD marks those that it misses
            number = name.removeprefix("Face")
            if not (name.startswith("Face") and number.isdecimal() and 1 <= int(number) <= count):
                missing.append(name)
    return missing


def _chosen_faces(obj: Any) -> list[Any]:
    """The faces behind Base, or the whole model's shape."""
    chosen = [base.Shape.getElement(name) for base, names in obj.Base or () for name in names if name]
    if not chosen and getattr(obj, "WholeModel", False):
        return [documents.model_of(obj).Shape]
    return chosen


def reason(error: BaseException) -> str:
    """What an error says, and what its hint says to do."""
    hint = getattr(error, "hint", "")
    said = str(error) or type(error).__name__
    return f"{said}: {hint}" if hint and hint not in said else said


def _only_comment(text: str) -> Any:
    return Path.Path([Path.Command(motion.comment(text))])


# --- creation ----------------------------------------------------------------------------------------------------


def SetupProperties() -> list[str]:
    """Properties that a job's setup sheet may set for new operations."""
    return [field.name for field in FIELDS]


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
