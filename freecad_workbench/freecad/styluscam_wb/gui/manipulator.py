# SPDX-License-Identifier: LGPL-2.1-or-later
"""Our commands inside CAM's own bars and menu: FreeCAD asks whenever a workbench sets up its bars."""

from __future__ import annotations

NEW_OPERATIONS = "New Operations"
"""CAM's bar of operations."""

LAST_OPERATION = "CAM_Adaptive"
"""CAM's command after which ours stand in its menu."""


class CamManipulator:
    """What FreeCAD asks; a name that a workbench does not have changes nothing there."""

    def modifyToolBars(self) -> list[dict[str, str]]:
        """Appended to CAM's bar."""
        if not _is_cam():
            return []
        from . import commands

        names = [*commands.groups()["job"][1:], commands.operations_drop_down(), *commands.groups()["check"][:1]]
        return [{"append": name, "toolBar": NEW_OPERATIONS} for name in names]

    def modifyMenuBar(self) -> list[dict[str, str]]:
        """After CAM's operations, in the order of the list."""
        if not _is_cam():
            return []
        from . import commands

        names = [name for group in ("job", "operations", "check") for name in commands.groups()[group]]
        return [{"insert": name, "menuItem": LAST_OPERATION, "after": ""} for name in reversed(names)]


def _is_cam() -> bool:
    """Whether FreeCAD sets up CAM's bars."""
    import FreeCADGui

    return type(FreeCADGui.activeWorkbench()).__name__ == "CAMWorkbench"
