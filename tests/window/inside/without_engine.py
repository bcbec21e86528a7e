"""The window where the addon is installed and its engine is not."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parent))

import driver
from driver import QtWidgets, until


def explained() -> Any:
    """Both workbenches open; the command that stands for the operations states how the engine is installed."""
    import FreeCADGui

    from freecad.styluscam_wb import engine

    yield until(lambda: FreeCADGui.activeWorkbench().name() == "CAMWorkbench", "CAM in front")
    FreeCADGui.activateWorkbench("StylusCamWorkbench")
    yield driver.settled()
    driver.click(driver.tool_button("StylusCAM_InstallEngine"))
    yield until(lambda: driver.visible(QtWidgets.QMessageBox, name="StylusCAM_Message"), "the sentence")
    box = driver.one(QtWidgets.QMessageBox, name="StylusCAM_Message")
    text = box.text()
    picture = driver.shot("engine-missing")
    driver.click(driver.one(QtWidgets.QPushButton, inside=box, text="OK"))
    yield until(lambda: not driver.visible(QtWidgets.QMessageBox), "a closed dialog")
    return {"text": text, "packages": engine.package_dir(), "shot": picture}


def unharmed() -> Any:
    """FreeCAD's own work, and CAM's own operations, go on."""
    import FreeCAD
    import FreeCADGui

    FreeCADGui.activateWorkbench("PartWorkbench")
    document = FreeCAD.newDocument("Box")
    FreeCADGui.runCommand("Part_Box")
    yield until(lambda: document.Objects, "a box")
    FreeCADGui.activateWorkbench("CAMWorkbench")
    yield driver.settled()
    return {"volume": document.Objects[0].Shape.Volume, "bars": len(driver.visible(QtWidgets.QToolBar))}


driver.run({"explained": explained, "unharmed": unharmed})
