"""What goes wrong in a window: the document stays whole, and a sentence states what happened."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parent))

import driver
import stage
from driver import QtWidgets, until

MESSAGE = "StylusCAM_Message"


def message() -> Any:
    """The dialog with our sentence, closed by its button; returns the sentence."""
    yield until(lambda: driver.visible(QtWidgets.QMessageBox, name=MESSAGE), "a message")
    box = driver.one(QtWidgets.QMessageBox, name=MESSAGE)
    text = box.text()
    driver.click(box.button(QtWidgets.QMessageBox.Ok))
    yield until(lambda: not driver.visible(QtWidgets.QMessageBox, name=MESSAGE), "a closed message")
    return text


def closed_during_computation() -> Any:
    """Something closes the document while its path is computed."""
    import FreeCAD

    _, operation = stage.computed()
    name = FreeCAD.ActiveDocument.Name
    operation.Step = 0.002
    driver.later(FreeCAD.ActiveDocument.recompute)
    yield until(lambda: driver.visible(QtWidgets.QProgressDialog), "the dialog", 60)
    try:
        FreeCAD.closeDocument(name)
        refused = ""
    except Exception as error:
        refused = str(error)
    dialog = driver.one(QtWidgets.QProgressDialog)
    driver.click(driver.one(QtWidgets.QPushButton, inside=dialog))
    yield until(lambda: "Invalid" in operation.State, "an end", 60)
    yield driver.settled(20)
    return {"refused": refused, "open": name in FreeCAD.listDocuments()}


def two_controllers() -> Any:
    """A job with two tools: CAM asks which one."""
    import FreeCAD
    import Path.Tool.Controller as PathToolController

    from freecad.styluscam_wb import tools

    job = stage.job_with_stylus()
    bit = tools.create_stylus(FreeCAD.ActiveDocument, "Second", {"kind": "ball", "diameter": 6.0})
    other = PathToolController.Create("TC: Second", bit, 2)
    job.Proxy.addToolController(other)
    FreeCAD.ActiveDocument.recompute()
    yield from stage.workbench("StylusCamWorkbench")
    driver.click(driver.tool_button("StylusCAM_Operation_ZLevel"))
    yield until(lambda: stage.panel_is_open() or isinstance(asked(), QtWidgets.QDialog), "a question or the panel")
    question = asked()
    if question is not None:
        box = question.findChild(QtWidgets.QDialogButtonBox)
        driver.click(box.button(QtWidgets.QDialogButtonBox.Ok))
    yield until(stage.panel_is_open, "the panel")
    operation = job.Operations.Group[-1]
    driver.choose(driver.one(QtWidgets.QComboBox, name="toolController"), "TC: Second")
    yield until(lambda: operation.ToolController == other, "the second tool")
    yield from stage.typed(operation, "Step", "2.5 mm", 2.5)
    yield from stage.ok(operation)
    return {**stage.seen(operation), "asked": question is not None, "post": stage.posted(job)}


def asked() -> Any:
    """A dialog in front that is not ours."""
    found = QtWidgets.QApplication.activeModalWidget()
    return found if isinstance(found, QtWidgets.QDialog) else None


def without_profile() -> Any:
    """A stylus whose profile was emptied."""
    import FreeCAD

    job, operation = stage.computed()
    operation.ToolController.Tool.Profile = ""
    FreeCAD.ActiveDocument.recompute()
    operation.touch()
    FreeCAD.ActiveDocument.recompute()
    yield driver.settled()
    return {**stage.seen(operation), "post": stage.posted(job)}


def deleted_model() -> Any:
    """The model's clone is deleted from the job."""
    import FreeCAD

    job, operation = stage.computed()
    operation.WholeModel = True
    FreeCAD.ActiveDocument.removeObject(job.Model.Group[0].Name)
    operation.touch()
    FreeCAD.ActiveDocument.recompute()
    yield driver.settled()
    return {**stage.seen(operation), "post": stage.posted(job)}


def run_command(name: str) -> None:
    import FreeCADGui

    FreeCADGui.runCommand(name)


def post_refused() -> Any:
    """The post's button is pressed for a job that cannot be posted: an operation has failed, its post or folder is unknown."""
    job, operation = stage.computed()
    target = driver.FOLDER / "refused.ngc"
    job.PostProcessorOutputFile = str(target)
    operation.Step = 0.0
    operation.Document.recompute()
    driver.later(lambda: run_command("StylusCAM_Post"))
    failed = yield from message()
    operation.Step = 5.0
    operation.Document.recompute()
    job.PostProcessorOutputFile = str(driver.FOLDER / "nowhere" / "refused.ngc")
    driver.later(lambda: run_command("StylusCAM_Post"))
    folder = yield from message()
    return {"failed": failed, "folder": folder, "written": target.exists()}


def job_deleted_under_panel() -> Any:
    """The job is deleted while the panel of its heat maps is open."""
    job, operation = stage.computed()
    document, name = operation.Document, job.Name
    driver.later(lambda: run_command("StylusCAM_HeatMap"))
    yield until(lambda: driver.visible(QtWidgets.QComboBox, name="HeatMap"), "the panel", 60)
    maps = driver.one(QtWidgets.QComboBox, name="HeatMap")
    document.removeObject(name)
    yield driver.settled()
    driver.choose(maps, maps.itemText(1))
    yield driver.settled()
    driver.click(driver.one(QtWidgets.QDialogButtonBox).button(QtWidgets.QDialogButtonBox.Cancel))
    yield until(lambda: not driver.visible(QtWidgets.QComboBox, name="HeatMap"), "a closed panel")
    return {"closed": True}


driver.run(
    {
        "post refused": post_refused,
        "job deleted under panel": job_deleted_under_panel,
        "closed during computation": closed_during_computation,
        "two controllers": two_controllers,
        "without profile": without_profile,
        "deleted model": deleted_model,
    }
)
