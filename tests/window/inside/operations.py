"""An operation in the window: made with the button, changed in its panel, seen, taken back, made again from a new model."""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parent))

import itertools

import driver
import stage
from driver import QtCore, QtWidgets, until

STEP = "Step"


def made_with_the_button() -> Any:
    """Faces clicked in the view, the button, a number in the panel, OK."""
    import FreeCAD
    import FreeCADGui

    job = stage.job_with_stylus()
    yield from stage.workbench("StylusCamWorkbench")
    model = job.Model.Group[0]
    wall = model.Shape.Face3
    u, v = ((a + b) / 2 for a, b in (wall.ParameterRange[:2], wall.ParameterRange[2:]))
    driver.click_in_view(wall.valueAt(u, v))
    yield until(FreeCADGui.Selection.getSelectionEx, "a selected face")
    selected = [(one.ObjectName, list(one.SubElementNames)) for one in FreeCADGui.Selection.getSelectionEx()]
    yield from stage.press("StylusCAM_Operation_ZLevel")
    panel = driver.shot("panel")
    operation = job.Operations.Group[-1]
    yield from stage.typed(operation, STEP, "5 mm", 5.0)
    yield from stage.ok(operation)
    stage.show_all()
    yield driver.settled(10)
    return {
        **stage.seen(operation),
        "selected": selected,
        "shots": [panel, driver.shot("path")],
        "base": [list(names) for _, names in operation.Base],
        "whole": operation.WholeModel,
        "label": operation.Label,
        "values": [operation.Step.Value, operation.Tolerance.Value, operation.ModelTolerance.Value],
        "edit": FreeCADGui.ActiveDocument.getInEdit() is not None,
        "undo": FreeCAD.ActiveDocument.UndoNames,
    }


def every_kind() -> Any:
    """Each kind's button, then OK: nothing is selected, nothing is typed."""
    import FreeCADGui

    from freecad.styluscam_wb.gui import commands

    job = stage.job_with_stylus(diameter=12.0)
    yield from stage.workbench("StylusCamWorkbench")
    result = {}
    # a meridian is formed by spinning, a pocket is cut from stock, a flank is milled, holes are drilled and bored, edges
    # chamfered and followed: not in the job of a sheet, whose part has no concave edges either
    others = ("Chamfer", "Contour", "Drill", "Flank", "HelixBore", "Meridian", "Pencil", "Pocket")
    for name in (name for name in commands.groups()["operations"] if not name.endswith(others)):
        FreeCADGui.Selection.clearSelection()
        yield from stage.press(name)
        operation = job.Operations.Group[-1]
        yield from stage.ok(operation)
        result[name] = {**stage.seen(operation), "label": operation.Label, "strategy": operation.Strategy}
    return result


def cancelled_new() -> Any:
    """A new operation whose panel is cancelled leaves nothing behind."""
    import FreeCAD

    stage.job_with_stylus()
    yield from stage.workbench("StylusCamWorkbench")
    before = sorted(obj.Name for obj in FreeCAD.ActiveDocument.Objects)
    yield from stage.press("StylusCAM_Operation_ZigZag")
    # the keys leave the field when its operation is gone
    yield driver.focused(driver.one(QtWidgets.QWidget, name="Stepover"))
    driver.click(driver.panel_button(QtWidgets.QDialogButtonBox.Cancel))
    yield until(stage.panel_is_closed, "a closed panel")
    yield driver.settled()
    after = sorted(obj.Name for obj in FreeCAD.ActiveDocument.Objects)
    return {"before": before, "after": after, "report": driver.report_view()}


def values_of(operation: Any) -> dict[str, str]:
    """Every property as text, but for those that a recompute writes."""
    skipped = {"Path", "CycleTime", "Proxy", "Visibility"}
    return {name: str(getattr(operation, name)) for name in operation.PropertiesList if name not in skipped}


def cancelled_edit() -> Any:
    """A double click on an operation opens its panel; Cancel restores every value."""
    import FreeCADGui

    job, operation = stage.computed()
    before, path = values_of(operation), operation.Path.toGCode()
    FreeCADGui.ActiveDocument.setEdit(operation.ViewObject, 0)
    yield until(stage.panel_is_open, "the panel")
    for name, text, value in (("Step", "3 mm", 3.0), ("Tolerance", "0.02 mm", 0.02), ("SheetThickness", "2 mm", 2.0)):
        yield from stage.typed(operation, name, text, value)
    driver.choose(driver.one(QtWidgets.QComboBox, name="Direction"), "same")
    yield until(lambda: operation.Direction == "same", "the direction")
    changed = sorted(name for name, text in values_of(operation).items() if before[name] != text)
    driver.click(driver.panel_button(QtWidgets.QDialogButtonBox.Cancel))
    yield until(stage.panel_is_closed, "a closed panel")
    yield driver.settled()
    after = values_of(operation)
    return {
        "changed": changed,
        "restored": sorted(name for name, text in after.items() if before[name] != text),
        "same path": operation.Path.toGCode() == path,
        "state": list(operation.State),
        "operations": len(job.Operations.Group),
    }


def command(name: str) -> Any:
    """One of FreeCAD's own commands, run as by its button."""
    import FreeCADGui

    driver.later(lambda: FreeCADGui.runCommand(name))
    yield driver.settled()


def undone() -> Any:
    """Making an operation, taken back and done again."""
    import FreeCAD

    job = stage.job_with_stylus()
    document = FreeCAD.ActiveDocument
    yield from stage.workbench("StylusCamWorkbench")
    before = sorted(obj.Name for obj in document.Objects)
    yield from stage.press("StylusCAM_Operation_ZLevel")
    yield from stage.typed(job.Operations.Group[-1], STEP, "5 mm", 5.0)
    yield from stage.ok(job.Operations.Group[-1])
    made = sorted(obj.Name for obj in document.Objects)
    motions = stage.motions(job.Operations.Group[-1])
    count = document.UndoCount
    for _ in range(count):
        yield from command("Std_Undo")
    undone_names = sorted(obj.Name for obj in document.Objects)
    for _ in range(count):
        yield from command("Std_Redo")
    document.recompute()
    yield driver.settled()
    redone = sorted(obj.Name for obj in document.Objects)
    again = stage.motions(job.Operations.Group[-1]) if job.Operations.Group else 0
    return {
        "steps": count,
        "before": before,
        "made": made,
        "undone": undone_names,
        "redone": redone,
        "motions": [motions, again],
    }


def expression() -> Any:
    """A step that follows an expression is shown, and is kept by the panel."""
    import FreeCADGui

    _, operation = stage.computed()
    operation.setExpression("Step", "SheetThickness * 4")
    operation.recompute()
    FreeCADGui.ActiveDocument.setEdit(operation.ViewObject, 0)
    yield until(stage.panel_is_open, "the panel")
    shown = driver.one(QtWidgets.QWidget, name=STEP).property("rawValue")
    yield from stage.typed(operation, "SheetThickness", "1.5 mm", 1.5)
    yield from stage.ok(operation)
    return {**stage.seen(operation), "shown": shown, "step": operation.Step.Value, "kept": operation.ExpressionEngine}


def copied_and_disabled() -> Any:
    """CAM's own commands: a copy has the same path; a disabled one has none and is not posted."""
    import FreeCAD
    import FreeCADGui

    job, operation = stage.computed()
    yield from stage.workbench("CAMWorkbench")
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(operation)
    driver.later(lambda: FreeCADGui.runCommand("CAM_OperationCopy"))
    yield until(lambda: len(job.Operations.Group) == 2, "a copy")
    copy = job.Operations.Group[-1]
    FreeCAD.ActiveDocument.recompute()
    yield driver.settled()
    same = copy.Path.toGCode().split("\n")[1:] == operation.Path.toGCode().split("\n")[1:]
    view = type(copy.ViewObject.Proxy).__name__
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(operation)
    driver.later(lambda: FreeCADGui.runCommand("CAM_OpActiveToggle"))
    yield until(lambda: not operation.Active, "a disabled operation")
    FreeCAD.ActiveDocument.recompute()
    yield driver.settled()
    text = stage.posted(job)
    return {"same": same, "view": view, "disabled": stage.motions(operation), "post": text, "copy": copy.Label}


def dressed_up() -> Any:
    """One of CAM's dressups on top of our path, posted."""
    import FreeCAD
    from Path.Dressup import Boundary

    job, operation = stage.computed()
    dressup = Boundary.Create(operation)
    job.Proxy.addOperation(dressup, operation) if dressup not in job.Operations.Group else None
    FreeCAD.ActiveDocument.recompute()
    yield driver.settled()
    first = next(command.toGCode() for command in dressup.Path.Commands if command.Name == "G1")
    return {**stage.seen(operation), "motions": stage.motions(dressup), "first feed": first, "post": stage.posted(job)}


def changed_model() -> Any:
    """The model is edited: the path follows on recompute."""
    import FreeCAD

    document, job, operation, box = stage.dented_block(depth=6.0)
    deep = stage.lowest(operation)
    box.Height = 3.0
    document.recompute()
    yield driver.settled()
    shallow = stage.lowest(operation)
    again = FreeCAD.ActiveDocument.Name == document.Name
    return {
        "deep": deep,
        "shallow": shallow,
        "state": list(operation.State),
        "document": again,
        "post": stage.posted(job),
    }


def progress() -> Any:
    """A long computation: the window answers, a dialog shows the phase, Cancel ends it; the next one is whole."""
    import FreeCAD

    _, operation = stage.computed()
    ticks: list[float] = []
    clock = QtCore.QTimer()
    clock.setInterval(50)
    clock.timeout.connect(lambda: ticks.append(time.monotonic()))
    clock.start()
    operation.Step = 0.002
    driver.later(FreeCAD.ActiveDocument.recompute)
    yield until(lambda: driver.visible(QtWidgets.QProgressDialog), "the dialog", 60)
    dialog = driver.one(QtWidgets.QProgressDialog)
    yield until(lambda: dialog.value() > 0, "progress", 60)
    picture, text = driver.shot("progress", dialog), dialog.labelText()
    ticks.clear()
    yield until(lambda: len(ticks) > 20, "a window that answers")
    gaps = [b - a for a, b in itertools.pairwise(ticks)]
    pressed = time.monotonic()
    driver.click(driver.one(QtWidgets.QPushButton, inside=dialog))
    yield until(lambda: not driver.visible(QtWidgets.QProgressDialog), "an end", 30)
    ended = time.monotonic() - pressed
    clock.stop()
    yield until(lambda: "Invalid" in operation.State, "a cancelled operation")
    yield driver.settled()
    cancelled = {**stage.seen(operation), "first": operation.Path.Commands[0].Name}
    operation.Step = 5.0
    FreeCAD.ActiveDocument.recompute()
    yield driver.settled()
    return {
        "text": text,
        "shot": picture,
        "longest gap": max(gaps),
        "ended after": ended,
        "cancelled": cancelled,
        "again": stage.seen(operation),
    }


def failed() -> Any:
    """An operation that cannot be planned: its panel and the report view state why."""
    import FreeCADGui

    _, operation = stage.computed()
    FreeCADGui.ActiveDocument.setEdit(operation.ViewObject, 0)
    yield until(stage.panel_is_open, "the panel")
    yield from stage.typed(operation, STEP, "0 mm", 0.0)
    driver.click(driver.panel_button(QtWidgets.QDialogButtonBox.Apply))
    yield until(lambda: "Invalid" in operation.State, "a failure")
    yield driver.settled()
    notes = driver.one(QtWidgets.QLabel, name="StylusCAM_Notes").text()
    row = driver.one(QtWidgets.QLabel, name="Step_error").text()
    picture = driver.shot("failed")
    driver.click(driver.panel_button(QtWidgets.QDialogButtonBox.Ok))
    yield until(stage.panel_is_closed, "a closed panel")
    return {**stage.seen(operation), "notes": notes, "row": row, "shot": picture, "report": driver.report_view()}


driver.run(
    {
        "made with the button": made_with_the_button,
        "every kind": every_kind,
        "cancelled new": cancelled_new,
        "cancelled edit": cancelled_edit,
        "undone": undone,
        "expression": expression,
        "copied and disabled": copied_and_disabled,
        "dressed up": dressed_up,
        "changed model": changed_model,
        "progress": progress,
        "failed": failed,
    }
)
