"""The window in a language in which every text of ours reads [[text]]: what does not, is not translated."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parent))

import driver
from driver import QtWidgets, until

OURS = "StylusCAM"
"""The addon's own name, and what stands in no language."""

WORD = re.compile(r"[^\W\d_]{2,}")

UNITS = re.compile(r"\b(mm|deg|min|s|rev|X|Y|Z)\b")


def is_plain(text: str) -> bool:
    """Whether a text has words that are in no brackets."""
    rest = re.sub(r"<[^>]*>|StylusCAM_\w+", " ", text.replace("&", ""))  # FreeCAD's mark-up, names of commands
    rest = re.sub(r"\[\[.*?\]\]", "", rest, flags=re.DOTALL)
    rest = UNITS.sub("", rest.replace(OURS, ""))
    return bool(WORD.search(rest))


def texts_of(widget: Any) -> Iterator[tuple[str, str]]:
    """All that a widget shows but what a person has typed, and what it is."""
    for name in ("text", "title", "windowTitle", "toolTip", "placeholderText"):
        if name == "text" and isinstance(
            widget, QtWidgets.QLineEdit | QtWidgets.QAbstractSpinBox | QtWidgets.QTextEdit
        ):
            continue
        getter = getattr(widget, name, None)
        if callable(getter) and isinstance(text := getter(), str):
            yield name, text
    if isinstance(widget, QtWidgets.QComboBox):
        for index in range(widget.count()):
            yield f"item {index}", widget.itemText(index)


def untranslated(root: Any, *left: str) -> list[str]:
    """What is not in brackets inside a widget, but for widgets with these object names."""
    found = []
    for widget in [root, *root.findChildren(QtWidgets.QWidget)]:
        around = list(ancestors(widget))
        if any(one.objectName() in left for one in (widget, *around)):
            continue
        if any(isinstance(one, QtWidgets.QAbstractSpinBox) for one in around):
            continue  # FreeCAD's own button for expressions
        for what, text in texts_of(widget):
            if is_plain(text):
                found.append(f"{type(widget).__name__} {widget.objectName()} {what}: {text}")
    return found


def ancestors(widget: Any) -> Iterator[Any]:
    while (widget := widget.parentWidget()) is not None:
        yield widget


def bars_and_menus() -> Any:
    """Titles of our bars, texts and tool tips of our commands."""
    import FreeCADGui

    FreeCADGui.activateWorkbench("StylusCamWorkbench")
    yield driver.settled(10)
    bars = [bar.windowTitle() for bar in driver.visible(QtWidgets.QToolBar) if OURS in bar.windowTitle()]
    actions = list(driver.main_window().findChildren(driver.QtGui.QAction))
    ours = {a.objectName(): [a.text(), a.toolTip()] for a in actions if a.objectName().startswith("StylusCAM_")}
    information = FreeCADGui.listWorkbenches()["StylusCamWorkbench"].ToolTip
    plain = [text for texts in ours.values() for text in texts if is_plain(text)]
    return {
        "bars": bars,
        "commands": sorted(ours),
        "plain": plain + [title for title in bars if "[[" not in title],
        "workbench": information,
        "shot": driver.shot("bars"),
    }


def operation() -> Any:
    """The panel of an operation."""
    import FreeCAD
    import FreeCADGui

    from freecad.styluscam_wb import examples

    FreeCADGui.activateWorkbench("StylusCamWorkbench")
    result = {}
    for example in examples.EXAMPLES:
        job = example.make()
        FreeCAD.ActiveDocument.recompute()
        path = job.Operations.Group[0]
        path.ViewObject.Document.setEdit(path.ViewObject, 0)
        yield until(lambda: driver.visible(QtWidgets.QWidget, name="StylusCAM_Operation"), "the panel")
        yield driver.settled()
        panel = driver.one(QtWidgets.QWidget, name="StylusCAM_Operation")
        for button in driver.visible(QtWidgets.QToolButton, name="Advanced", inside=panel):
            button.click()
        yield driver.settled()
        shown = driver.shot(f"operation-{example.name}")
        # the notes are the engine's own figures; tools and coolants are CAM's
        plain = untranslated(panel, "StylusCAM_Notes", "toolController", "coolantController")
        result[example.name] = {"plain": plain, "shot": shown}
        driver.close_all()
        yield driver.settled()
    return result


def tool() -> Any:
    """The panel of a tool, with every kind of profile."""
    import FreeCADGui

    from freecad.styluscam_wb import examples

    FreeCADGui.activateWorkbench("StylusCamWorkbench")
    examples.EXAMPLES[0].make()
    driver.QtCore.QTimer.singleShot(0, lambda: FreeCADGui.runCommand("StylusCAM_Tool"))
    yield until(lambda: driver.visible(QtWidgets.QWidget, name="StylusCAM_Tool"), "the panel")
    yield driver.settled()
    panel = driver.one(QtWidgets.QWidget, name="StylusCAM_Tool")
    kinds = driver.one(QtWidgets.QComboBox, name="profile.kind", inside=panel)
    found = {}
    for index in range(kinds.count()):
        kinds.setCurrentIndex(index)
        yield driver.settled()
        found[kinds.itemText(index)] = untranslated(panel)
    return {
        "kinds": list(found),
        "plain": [line for lines in found.values() for line in lines],
        "shot": driver.shot("tool"),
    }


def preferences() -> Any:
    """Our page in FreeCAD's preferences."""
    import FreeCADGui

    driver.QtCore.QTimer.singleShot(0, lambda: FreeCADGui.runCommand("StylusCAM_Preferences"))
    yield until(lambda: driver.visible(QtWidgets.QWidget, name="StylusCAM_Preferences"), "our page")
    yield driver.settled()
    page = driver.one(QtWidgets.QWidget, name="StylusCAM_Preferences")
    machines = driver.one(QtWidgets.QComboBox, name="DefaultMachine")
    plain = [line for line in untranslated(page) if not re.match(r"QComboBox DefaultMachine item [1-9]", line)]
    plain = [line for line in plain if "placeholderText: /" not in line]
    return {"plain": plain, "first": machines.itemText(0)}


driver.run({"bars and menus": bars_and_menus, "operation": operation, "tool": tool, "preferences": preferences})
