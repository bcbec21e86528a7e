"""Our page in FreeCAD's preferences, opened with our command."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parent))

import driver
from driver import FOLDER, QtWidgets, until

FOLDER_OF_MACHINES = FOLDER / "machines"

GROUP = "User parameter:BaseApp/Preferences/Mod/StylusCAM"


def opened() -> Any:
    """The dialog at our page, by the menu's command."""
    import FreeCADGui
    from PySide import QtCore

    FreeCADGui.activateWorkbench("StylusCamWorkbench")
    yield driver.settled()
    QtCore.QTimer.singleShot(0, lambda: FreeCADGui.runCommand("StylusCAM_Preferences"))
    yield until(lambda: driver.visible(QtWidgets.QWidget, name="StylusCAM_Preferences"), "our page")
    yield driver.settled()


def finished(button: str) -> Any:
    """The dialog left with a button, and the text of a message that it shows then."""
    dialog = driver.one(QtWidgets.QDialog, name="Gui__Dialog__DlgPreferences")
    driver.click(driver.one(QtWidgets.QPushButton, inside=dialog, text=button))
    text = ""
    seen: list[Any] = []

    def is_over() -> bool:
        seen[:] = driver.visible(QtWidgets.QMessageBox, name="StylusCAM_Message")
        return bool(seen) or not driver.visible(QtWidgets.QDialog, name="Gui__Dialog__DlgPreferences")

    yield until(is_over, "a message or a closed dialog")
    if seen:
        text = seen[0].text()
        driver.click(driver.one(QtWidgets.QPushButton, inside=seen[0], text="OK"))
        yield until(
            lambda: not driver.visible(QtWidgets.QDialog, name="Gui__Dialog__DlgPreferences"), "a closed dialog"
        )
    return text


def stored() -> dict[str, Any]:
    import FreeCAD
    import Path.Preferences

    from freecad.styluscam_wb import machines, settings

    group = FreeCAD.ParamGet(GROUP)
    return {
        "folder": group.GetString("MachineFolder", "unset"),
        "verifies": settings.verifies(),
        "user folder": str(machines.user_folder()),
        "machine": settings.machine(),
        "default of CAM": Path.Preferences.defaultPostProcessor(),
        "posts": [name for name in Path.Preferences.allAvailablePostProcessors() if "styluscam" in name],
    }


def post_of_a_new_job() -> Any:
    """What a job has as its post that our command makes of a box."""
    import FreeCAD
    import FreeCADGui
    import Path.Preferences
    from PySide import QtCore

    Path.Preferences.preferences().SetBool(Path.Preferences.WarningSuppressVelocity, True)  # CAM's dialog about units
    document = FreeCAD.newDocument("New")
    box = document.addObject("Part::Box", "Box")
    document.recompute()
    FreeCADGui.Selection.addSelection(box)
    QtCore.QTimer.singleShot(0, lambda: FreeCADGui.runCommand("StylusCAM_Job"))
    yield until(driver.dialog, "CAM's dialog of a new job")
    yield driver.settled()
    driver.click(driver.one(QtWidgets.QPushButton, inside=driver.dialog(), text="OK"))
    jobs: list[Any] = []

    def is_made() -> bool:
        jobs[:] = [obj for obj in document.Objects if hasattr(obj, "PostProcessor")]
        return bool(jobs)

    yield until(is_made, "a job")
    post = jobs[0].PostProcessor
    yield until(FreeCADGui.Control.activeDialog, "the job's panel")
    yield driver.settled()
    driver.click(driver.one(QtWidgets.QPushButton, text="Cancel"))
    yield until(lambda: not FreeCADGui.Control.activeDialog(), "a closed panel")
    return post


def folder_that_is_none() -> Any:
    """A folder that does not exist is refused in a sentence, while it is typed and when it would be stored."""
    yield from opened()
    shown = driver.one(QtWidgets.QLineEdit, name="MachineFolder").placeholderText()
    before = stored()
    line = driver.one(QtWidgets.QLineEdit, name="MachineFolder")
    line.setText("/no/such/folder")
    yield driver.settled()
    page = driver.one(QtWidgets.QWidget, name="StylusCAM_Preferences")
    problems = [w.text() for w in driver.visible(QtWidgets.QLabel, inside=page) if "/no/such" in w.text()]
    picture = driver.shot("preferences")
    text = yield from finished("OK")
    return {
        "placeholder": shown,
        "problems": problems,
        "text": text,
        "same": before == stored(),
        "shot": picture,
        **before,
    }


def chosen() -> Any:
    """A folder with a machine file, a machine for new jobs, no verification; then a new job has that post."""
    from PySide import QtCore

    FOLDER_OF_MACHINES.mkdir()
    (FOLDER_OF_MACHINES / "shop.toml").write_text('schema = 1\nextends = "fanuc"\nname = "shop"\n', encoding="utf-8")
    yield from opened()
    driver.one(QtWidgets.QLineEdit, name="MachineFolder").setText(str(FOLDER_OF_MACHINES))
    driver.choose(driver.one(QtWidgets.QComboBox, name="DefaultMachine"), "grbl")
    box = driver.one(QtWidgets.QCheckBox, name="VerifyBeforeWriting")
    driver.click(box, QtCore.QPoint(10, box.height() // 2))
    yield driver.settled()
    text = yield from finished("OK")
    post = yield from post_of_a_new_job()
    yield from opened()
    shown = {
        "folder": driver.one(QtWidgets.QLineEdit, name="MachineFolder").text(),
        "machine": driver.one(QtWidgets.QComboBox, name="DefaultMachine").currentText(),
        "machines": [driver.one(QtWidgets.QComboBox, name="DefaultMachine").itemText(i) for i in range(3)],
        "verifies": driver.one(QtWidgets.QCheckBox, name="VerifyBeforeWriting").isChecked(),
    }
    yield from finished("Cancel")
    return {"text": text, "post": post, "shown": shown, "wanted": str(FOLDER_OF_MACHINES), **stored()}


driver.run({"folder that is none": folder_that_is_none, "chosen": chosen})
