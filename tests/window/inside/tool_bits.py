"""Stylus tools in the window: made with the button, edited in their panel, saved, loaded, kept in FreeCAD's library."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parent))

import driver
from driver import QtCore, QtWidgets, until

ODD = 7.12345678912
"""A diameter with more digits than any box shows."""

BOXES = 200
"""Spin boxes made at a time: some of them come to addresses of others that are gone."""


def bench(name: str = "Tools", *, with_job: bool = True) -> Any:
    """A document with a box in a CAM job, StylusCAM's workbench in front; the job, or the document without one."""
    import FreeCAD
    import FreeCADGui

    document = FreeCAD.newDocument(name)
    FreeCADGui.activateWorkbench("StylusCamWorkbench")
    if not with_job:
        return document
    import Path.Main.Gui.Job as PathJobGui
    import Path.Main.Job as PathJob

    model = document.addObject("Part::Box", "Model")
    document.recompute()
    job = PathJob.Create("Job", [model])
    job.ViewObject.Proxy = PathJobGui.ViewProvider(job.ViewObject)
    document.recompute()
    return job


def panel() -> Any:
    """The panel, when it is open."""
    found = driver.visible(QtWidgets.QWidget, name="StylusCAM_Tool")
    return found[0] if found else None


def named(name: str) -> Any:
    return driver.one(QtWidgets.QWidget, name=name, inside=panel())


def drawing() -> Any:
    return driver.one(QtWidgets.QWidget, name="StylusCAM_ToolDrawing", inside=panel())


def button(text: str) -> Any:
    return driver.one(QtWidgets.QPushButton, text=text)


def pressed(command: str) -> Any:
    """Steps: a button of the workbench is pressed."""
    yield until(lambda: driver.tool_button(command).isEnabled(), "a button that can be pressed")
    driver.click(driver.tool_button(command))


def opened() -> Any:
    """Steps: the button of a new tool, until its panel is there."""
    yield from pressed("StylusCAM_Tool")
    yield until(panel, "the panel")


def closed(text: str) -> Any:
    """Steps: OK or Cancel."""
    import FreeCADGui

    driver.click(button(text))
    yield until(lambda: not FreeCADGui.Control.activeDialog(), "a closed panel")


def chosen(word: str) -> Any:
    """Steps: a kind of profile, by the combo's keys, until it is drawn."""
    combo = named("profile.kind")
    before = drawing().curves
    driver.choose(combo, combo.itemText(combo.findData(word)))
    yield until(lambda: combo.currentData() == word, word)
    yield until(lambda: drawing().curves is not before and not drawing().is_stale, f"a drawing of {word}")


def errors() -> list[str]:
    labels = driver.visible(QtWidgets.QLabel, inside=panel())
    return [label.text() for label in labels if label.objectName().lower().endswith("error")]


def styluses(document: Any) -> list[Any]:
    from freecad.styluscam_wb import compat

    return [obj for obj in document.Objects if compat.tool_kind(obj) == compat.STYLUS]


def described(bit: Any) -> dict[str, Any]:
    return {
        "label": bit.Label,
        "profile": json.loads(bit.Profile).get("profile", json.loads(bit.Profile)),
        "lengths": [getattr(bit, name).Value for name in ("Diameter", "CuttingEdgeHeight", "Length", "ShankDiameter")],
        "volume": bit.Shape.Volume,
        "view": type(bit.ViewObject.Proxy).__name__,
    }


def made_with_the_button() -> Any:
    """Button, panel, a number, OK: a bit with a controller; undo, redo."""
    job = bench()
    document = job.Document
    yield from opened()
    yield driver.settled()
    shots = [driver.shot("tool-new")]
    number = named("ToolNumber").value()
    driver.write(named("profile.diameter"), "7.25")
    yield until(lambda: abs(drawing().curves.diameter - 7.25) < 1e-9, "the number in the drawing")
    before = len(job.Tools.Group)
    yield from closed("OK")
    controller = job.Tools.Group[-1]
    made = described(controller.Tool)
    found = {
        "number": [number, controller.ToolNumber, before, len(job.Tools.Group)],
        "commands": [command.Name for command in controller.Path.Commands],
        "made": made,
        "visible": controller.Tool.ViewObject.Visibility,
        "undo names": list(document.UndoNames),
    }
    document.undo()
    yield driver.settled()
    found["undone"] = [len(job.Tools.Group), len(styluses(document))]
    document.redo()
    yield driver.settled()
    found["redone"] = described(job.Tools.Group[-1].Tool)
    return {**found, "shots": shots}


def every_kind() -> Any:
    """Each kind of profile has valid first numbers and a drawing."""
    bench(with_job=False)
    yield from opened()
    combo = named("profile.kind")
    words = [combo.itemData(index) for index in range(combo.count())]
    seen = {}
    for word in words:
        if word != combo.currentData():
            yield from chosen(word)
        curves = drawing().curves
        rows = [
            label.objectName()
            for label in driver.visible(QtWidgets.QLabel, inside=panel())
            if label.objectName().endswith("_label")
        ]
        seen[word] = {
            "diameter": curves.diameter,
            "height": curves.height,
            "errors": errors(),
            "rows": [row.removeprefix("profile.").removesuffix("_label") for row in rows if row.startswith("profile.")],
            "help": named("profile_help").text(),
            "ok": button("OK").isEnabled(),
            "tip": named("profile.tip_flat").toolTip(),
        }
    import FreeCAD

    objects = len(FreeCAD.ActiveDocument.Objects)
    yield from closed("Cancel")
    return {"seen": seen, "objects": [objects, len(FreeCAD.ActiveDocument.Objects)]}


def errors_in_place() -> Any:
    """What is wrong stands at its row; OK waits until it is right."""
    bench(with_job=False)
    yield from opened()
    found: dict[str, Any] = {}
    driver.write(named("profile.diameter"), "-3")
    yield until(
        lambda: driver.visible(QtWidgets.QLabel, name="profile.diameter_error", inside=panel()), "an error at its row"
    )
    yield driver.settled()
    found["negative"] = [errors(), button("OK").isEnabled(), driver.shot("tool-error")]
    label = driver.one(QtWidgets.QLabel, name="profile.diameter_error")
    found["fits"] = label.height() >= label.heightForWidth(label.width())
    driver.write(named("profile.diameter"), "10")
    yield until(lambda: button("OK").isEnabled(), "OK again")
    found["mended"] = errors()
    yield from chosen("points")
    named("profile.points").setPlainText("0, 0\n1, 1\n2, 1.1")
    yield until(
        lambda: driver.visible(QtWidgets.QLabel, name="profile.points_error", inside=panel()), "an error of the points"
    )
    found["hollow"] = [errors(), button("OK").isEnabled(), driver.shot("tool-hollow")]
    named("profile.points").setPlainText("0, 0\n1, nothing")
    yield until(lambda: errors() and "line 2" in errors()[0], "a line that is none")
    found["line"] = errors()
    yield from chosen("clothoid")
    driver.click(named("profile.diameter_stated"), QtCore.QPoint(8, named("profile.diameter_stated").height() // 2))
    yield until(errors, "an error of keys")
    found["missing"] = [
        errors(),
        driver.visible(QtWidgets.QLabel, name="StylusCAM_ToolError", inside=panel())[0].text(),
    ]
    named("ToolName").clear()
    driver.click(named("profile.diameter_stated"), QtCore.QPoint(8, named("profile.diameter_stated").height() // 2))
    yield until(lambda: errors() and "name" in errors()[0], "an error of the name")
    found["name"] = errors()
    yield from closed("Cancel")
    return found


def edited_by_double_click() -> Any:
    """A double click in the tree opens the panel; Cancel leaves all as it was, OK is one step to undo."""
    import FreeCAD

    from freecad.styluscam_wb import tools

    document = bench(with_job=False)
    bit = tools.create_stylus(document, "Mine", {"kind": "ball", "diameter": ODD})
    document.recompute()
    first = described(bit)
    yield from _double_clicked(bit)
    driver.write(named("profile.diameter"), "5")
    yield until(lambda: abs(drawing().curves.diameter - 5.0) < 1e-9, "the number in the drawing")
    yield from closed("Cancel")
    cancelled = described(bit)
    document.openTransaction("probe")
    document.abortTransaction()
    yield from _double_clicked(bit)
    driver.key(named("profile.diameter").findChild(QtWidgets.QLineEdit), QtCore.Qt.Key_Tab, "\t")
    driver.choose(named("base.kind"), "Tangent")
    yield until(
        lambda: driver.visible(QtWidgets.QLabel, name="base.kind_error", inside=panel()), "an error of the base"
    )
    driver.write(named("base.height"), "4.5")
    yield driver.settled()
    driver.write(named("ToolName"), "Yours")
    yield driver.settled()
    driver.write(named("shank_diameter"), "10")
    yield until(lambda: len(drawing().curves.above) > 10, "a smooth base")
    yield driver.settled()
    shot = driver.shot("tool-base")
    yield from closed("OK")
    stored, label = described(bit), bit.Label
    whole = tools.tool_document(bit)
    document.undo()
    yield driver.settled()
    undone = described(bit)
    document.redo()
    path = str(driver.FOLDER / "edited.FCStd")
    document.saveAs(path)
    FreeCAD.closeDocument(document.Name)
    again = FreeCAD.openDocument(path)
    bit = styluses(again)[0]
    reopened = described(bit)
    yield from _double_clicked(bit)
    yield from closed("OK")
    return {
        "first": first,
        "cancelled": cancelled,
        "stored": stored,
        "label": label,
        "document": whole,
        "undone": undone,
        "reopened": reopened,
        "same": described(bit) == reopened,
        "shot": shot,
    }


def _double_clicked(bit: Any) -> Any:
    """Steps: a double click on a bit in the tree."""
    import FreeCADGui

    tree = next(one for one in driver.main_window().findChildren(QtWidgets.QTreeWidget) if one.topLevelItemCount())
    dock = tree.parent()
    while dock is not None and not isinstance(dock, QtWidgets.QDockWidget):
        dock = dock.parent()
    if dock is not None:
        dock.show()
        dock.raise_()
    tabs = tree.parent()
    while tabs is not None and not isinstance(tabs, QtWidgets.QTabWidget):
        tabs = tabs.parent()
    if tabs is not None:
        tabs.setCurrentIndex(0)
    FreeCADGui.Selection.clearSelection()
    yield driver.settled(6)

    how = QtCore.Qt.MatchExactly | QtCore.Qt.MatchRecursive
    model = tree.model()
    index = QtCore.QPersistentModelIndex(
        model.match(model.index(0, 0), QtCore.Qt.DisplayRole, bit.Label, 1, QtCore.Qt.MatchFlags(how))[0]
    )
    tree.scrollTo(QtCore.QModelIndex(index))
    yield driver.settled()
    driver.click(tree.viewport(), tree.visualRect(QtCore.QModelIndex(index)).center(), double=True)
    yield until(panel, "the panel")
    yield driver.settled()


def boxes_at_old_addresses() -> Any:
    """Spin boxes made after others are gone that Python still knows: how many of FreeCAD's and of ours cannot be used."""
    import FreeCADGui

    from freecad.styluscam_wb.gui import editors

    loader = FreeCADGui.UiLoader()
    makers = {"FreeCAD's": lambda: loader.createWidget("Gui::QuantitySpinBox"), "ours": editors.quantity_box}
    unusable, kept = {}, []
    for name, make in makers.items():
        old = [editors.quantity_box() for _ in range(BOXES)]
        kept += [box.valueChanged for box in old]  # as a signal, which keeps what is left of a box for ever
        for box in old:
            box.deleteLater()
        yield driver.settled()
        unusable[name] = sum(not editors.is_there(make()) for _ in range(BOXES))
    return unusable


driver.run(
    {
        "boxes at old addresses": boxes_at_old_addresses,
        "made with the button": made_with_the_button,
        "every kind": every_kind,
        "errors in place": errors_in_place,
        "edited by double click": edited_by_double_click,
    }
)
