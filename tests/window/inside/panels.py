"""Every panel of ours, opened, looked at widget by widget, and pictured."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parent))

import driver
import stage
import walk
from driver import QtCore, QtWidgets, until


def seen(name: str, picture: str) -> dict[str, Any]:
    """A panel's findings, how many texts it shows, and its picture."""
    panel = driver.one(QtWidgets.QWidget, name=name)
    return {"findings": walk.findings(panel), "texts": walk.count(panel), "shot": driver.shot(picture)}


def example(number: int = 0) -> Any:
    """Steps: an example in our workbench, computed and shown; returns the job."""
    import FreeCAD
    import FreeCADGui

    from freecad.styluscam_wb import examples

    FreeCADGui.activateWorkbench("StylusCamWorkbench")
    job = examples.EXAMPLES[number].make()
    FreeCAD.ActiveDocument.recompute()
    stage.show_all(isometric=True)
    yield driver.settled(10)
    return job


def workbench() -> Any:
    """The window with an example; its bars have our icons."""
    yield from example()
    bars = [bar for bar in driver.visible(QtWidgets.QToolBar) if "StylusCAM" in bar.windowTitle()]
    without = [
        action.objectName()
        for bar in bars
        for action in bar.actions()
        if not action.isSeparator() and action.icon().isNull()
    ]
    picture = driver.shot("workbench")
    return {"without icon": without, "bars": len(bars), "shot": picture}


def operation(number: int) -> Any:
    """The panel of an operation, its advanced fields open, then with an error in it."""

    def scenario() -> Any:
        job = yield from example(number)
        path = job.Operations.Group[0]
        path.ViewObject.Document.setEdit(path.ViewObject, 0)
        yield until(lambda: driver.visible(QtWidgets.QWidget, name="StylusCAM_Operation"), "the panel")
        yield driver.settled(10)
        found = {"closed": seen("StylusCAM_Operation", f"operation-{number}")}
        for button in driver.visible(QtWidgets.QToolButton, name="Advanced"):
            button.click()
        yield driver.settled(10)
        return {**found, "open": seen("StylusCAM_Operation", f"operation-{number}-advanced")}

    return scenario


def tool() -> Any:
    """The panel of a tool, with every fourth kind of profile and the last; with PySide2 as it opens (see walk)."""
    import FreeCADGui

    yield from example()
    QtCore.QTimer.singleShot(0, lambda: FreeCADGui.runCommand("StylusCAM_Tool"))
    yield until(lambda: driver.visible(QtWidgets.QWidget, name="StylusCAM_Tool"), "the panel")
    yield driver.settled(10)
    kinds = driver.one(QtWidgets.QComboBox, name="profile.kind")
    found = {}
    last = kinds.count() - 1
    for index in {*range(0, last, 4), last} if QtCore.qVersion() >= "6" else {kinds.currentIndex()}:
        kinds.setCurrentIndex(index)
        yield driver.settled(10)
        found[kinds.itemText(index)] = seen("StylusCAM_Tool", f"tool-{kinds.itemData(index)}")
    return found


def preferences() -> Any:
    """Our page in FreeCAD's preferences, with an error in it."""
    import FreeCADGui

    FreeCADGui.activateWorkbench("StylusCamWorkbench")
    yield driver.settled()
    QtCore.QTimer.singleShot(0, lambda: FreeCADGui.runCommand("StylusCAM_Preferences"))
    yield until(lambda: driver.visible(QtWidgets.QWidget, name="StylusCAM_Preferences"), "our page")
    yield driver.settled(10)
    found = {"as it opens": seen("StylusCAM_Preferences", "preferences")}
    driver.one(QtWidgets.QLineEdit, name="MachineFolder").setText("/no/such/folder")
    yield driver.settled(10)
    return {**found, "error": seen("StylusCAM_Preferences", "preferences-error")}


def faults() -> Any:
    """A panel with one fault of each sort, so that it is known that they are found."""
    yield driver.settled()
    panel = QtWidgets.QDialog(driver.main_window())
    panel.setObjectName("Faulty")
    panel.resize(400, 300)
    texts = {
        "short": ("A label that is too long for its width", (10, 10, 60, 20), ""),
        "over": ("One label over", (10, 50, 200, 20), ""),
        "under": ("another one", (10, 60, 200, 20), ""),
        "faint": ("Hardly to be read", (10, 120, 200, 20), "color: #999999; background: #bbbbbb;"),
        "outside": ("Cut off", (350, 200, 200, 20), ""),
        "fine": ("Readable", (10, 200, 200, 20), "color: #000000; background: #ffffff;"),
    }
    for name, (text, geometry, style) in texts.items():
        label = QtWidgets.QLabel(text, panel)
        label.setObjectName(name)
        label.setGeometry(*geometry)
        label.setStyleSheet(style)
    panel.show()
    yield driver.settled(10)
    found = walk.findings(panel)
    panel.close()
    return found


driver.run(
    {
        "faults": faults,
        "workbench": workbench,
        "operation 0": operation(0),
        "operation 1": operation(1),
        "tool": tool,
        "preferences": preferences,
    }
)
