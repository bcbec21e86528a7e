"""The steps of docs/freecad-tutorial.md, done by events, with a picture of each."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parent))

import driver
import stage
from driver import QtWidgets, until

PROGRAM = driver.FOLDER / "cup.ngc"


def model() -> Any:
    """Step 1: a block with a round cup, as the Part workbench makes it."""
    import FreeCAD
    import Part

    document = FreeCAD.newDocument("Cup")
    block = document.addObject("Part::Box", "Block")
    block.Length, block.Width, block.Height = 90.0, 90.0, 26.0
    cone = document.addObject("Part::Cone", "Cone")
    cone.Radius1, cone.Radius2, cone.Height = 12.0, 32.0, 20.0
    cone.Placement.Base = FreeCAD.Vector(45.0, 45.0, 6.0)
    cut = document.addObject("Part::Cut", "Cut")
    cut.Base, cut.Tool = block, cone
    document.recompute()
    fillet = document.addObject("Part::Fillet", "Cup")
    fillet.Base = cut
    circles = [n for n, edge in enumerate(cut.Shape.Edges, 1) if isinstance(edge.Curve, Part.Circle)]
    fillet.Edges = [(number, 7.0, 7.0) for number in circles]
    document.recompute()
    for hidden in (block, cone, cut):
        hidden.ViewObject.Visibility = False
    stage.show_all(isometric=True)
    return fillet


def job_of(cup: Any) -> Any:
    """Step 2: the button, CAM's dialog, the job's panel with its post."""
    import FreeCAD
    import FreeCADGui

    FreeCADGui.Selection.addSelection(cup)
    yield from stage.clicked("StylusCAM_Job")
    yield until(lambda: QtWidgets.QApplication.activeModalWidget() is not None, "CAM's dialog")
    yield driver.settled()
    driver.shot("tutorial-2-job-dialog")
    dialog = QtWidgets.QApplication.activeModalWidget()
    driver.click(dialog.findChild(QtWidgets.QDialogButtonBox).button(QtWidgets.QDialogButtonBox.Ok))
    yield until(lambda: FreeCAD.ActiveDocument.getObject("Job"), "a job", 60)
    yield until(FreeCADGui.Control.activeDialog, "the job's panel", 60)
    yield driver.settled(10)
    job = FreeCAD.ActiveDocument.getObject("Job")
    tabs = driver.visible(QtWidgets.QTabWidget)
    for tab in tabs:
        for index in range(tab.count()):
            if tab.widget(index).findChild(QtWidgets.QComboBox, "postProcessor"):
                tab.setCurrentIndex(index)
    yield driver.settled()
    post = driver.one(QtWidgets.QComboBox, name="postProcessor")
    post.setCurrentIndex(post.findText("styluscam_linuxcnc"))
    yield driver.settled()
    driver.shot("tutorial-2-job-panel")
    driver.click(driver.panel_button(QtWidgets.QDialogButtonBox.Ok))
    yield until(stage.panel_is_closed, "a closed panel", 60)
    return job


def _save_button() -> Any:
    """The button of CAM's dialog that asks for a file; None while there is no such dialog."""
    dialog = QtWidgets.QApplication.activeModalWidget()
    box = dialog.findChild(QtWidgets.QDialogButtonBox) if dialog else None
    return box.button(QtWidgets.QDialogButtonBox.Save) if box else None


def _posted(job: Any) -> Any:
    """The job's program, named in the status bar."""
    import FreeCADGui

    job.PostProcessorOutputFile = str(PROGRAM)
    yield from stage.clicked("StylusCAM_Post")
    yield until(lambda: PROGRAM.is_file() or _save_button(), "a program, or a dialog that asks for its file", 60)
    if _save_button():
        driver.shot("tutorial-6-post")
        driver.click(_save_button())
    yield until(PROGRAM.is_file, "a program")
    status = FreeCADGui.getMainWindow().statusBar()
    yield until(lambda: PROGRAM.name in status.currentMessage(), "the program's name in the status bar")
    yield driver.settled(20)


def tutorial() -> Any:
    """All steps, from an empty document to the program."""
    import FreeCAD
    import FreeCADGui

    cup = model()
    yield from stage.workbench("StylusCamWorkbench")
    yield driver.settled(10)
    driver.shot("tutorial-1-model")
    job = yield from job_of(cup)
    yield from stage.clicked("StylusCAM_Tool")
    yield until(lambda: not stage.panel_is_closed(), "the tool's panel")
    yield driver.settled(5)
    kinds = driver.one(QtWidgets.QComboBox, name="profile.kind")
    driver.choose(kinds, kinds.itemText(kinds.findData("clothoid")))
    yield driver.settled(10)
    driver.shot("tutorial-3-tool")
    driver.click(driver.panel_button(QtWidgets.QDialogButtonBox.Ok))
    yield until(stage.panel_is_closed, "a closed panel")
    FreeCADGui.Selection.clearSelection()
    stage.show_all()
    yield driver.settled(10)
    wall = next(face for face in job.Model.Group[0].Shape.Faces if type(face.Surface).__name__ == "Cone")
    u, v = ((a + b) / 2 for a, b in (wall.ParameterRange[:2], wall.ParameterRange[2:]))
    driver.click_in_view(wall.valueAt(u, v))
    yield until(FreeCADGui.Selection.getSelectionEx, "a selected face")
    FreeCADGui.Selection.clearSelection()
    yield from stage.clicked("StylusCAM_Operation_ZLevel")
    yield until(lambda: stage.panel_is_open() or QtWidgets.QApplication.activeModalWidget(), "the panel or a question")
    question = QtWidgets.QApplication.activeModalWidget()
    if question is not None:
        driver.click(question.findChild(QtWidgets.QDialogButtonBox).button(QtWidgets.QDialogButtonBox.Ok))
    yield until(stage.panel_is_open, "the panel")
    operation = job.Operations.Group[-1]
    tools = driver.one(QtWidgets.QComboBox, name="toolController")
    driver.choose(tools, job.Tools.Group[-1].Label)
    yield until(lambda: operation.ToolController == job.Tools.Group[-1], "the stylus")
    yield from stage.typed(operation, "Step", "1 mm", 1.0)
    yield driver.settled(5)
    driver.shot("tutorial-4-operation")
    yield from stage.ok(operation)
    stage.show_all()
    yield driver.settled(10)
    driver.shot("tutorial-5-path")
    yield from _posted(job)
    return {
        **stage.seen(operation),
        "process": operation.Process,
        "text": PROGRAM.read_text(encoding="utf-8"),
        "document": FreeCAD.ActiveDocument.Name,
    }


driver.run({"tutorial": tutorial})
