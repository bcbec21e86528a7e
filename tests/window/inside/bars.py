"""Which of our commands stand in which bar and menu, whatever workbench comes first."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parent))

import driver
import stage
from driver import QtWidgets


def ours(actions: Any) -> list[str]:
    """Names of our commands among actions, menus below them included."""
    found = []
    for action in actions:
        found += [action.objectName()] if action.objectName().startswith("StylusCAM_") else []
        found += ours(action.menu().actions()) if action.menu() else []
    return found


def seen() -> dict[str, Any]:
    """Our commands in the bars and in the menus that are visible."""
    window = driver.main_window()
    bars = {bar.windowTitle(): ours(bar.actions()) for bar in driver.visible(QtWidgets.QToolBar)}
    menus = {action.text().replace("&", ""): ours([action]) for action in window.menuBar().actions()}
    return {
        "bars": {name: names for name, names in bars.items() if names},
        "menus": {name: names for name, names in menus.items() if names},
    }


def switched() -> Any:
    """One workbench after the other, twice."""
    result = []
    for name in ("StylusCamWorkbench", "CAMWorkbench", "PartWorkbench", "StylusCamWorkbench", "CAMWorkbench"):
        yield from stage.workbench(name)
        result.append([name, seen()])
    return result


def without_a_document() -> Any:
    """Every command of ours can be asked whether it is active, and those that need a job are not."""
    import FreeCADGui

    from freecad.styluscam_wb.gui import commands

    yield from stage.workbench("StylusCamWorkbench")
    names = [name for group in commands.groups().values() for name in group]
    return {name: FreeCADGui.Command.get(name).isActive() for name in names}


driver.run({"switched": switched, "without a document": without_a_document})
