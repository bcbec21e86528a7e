# SPDX-License-Identifier: LGPL-2.1-or-later
"""The workbench "StylusCAM": the steps of a job in the order in which they are done."""

from __future__ import annotations

from pathlib import Path as FilePath

import FreeCADGui

from .messages import translated

ICON = FilePath(__file__).parents[1] / "resources" / "styluscam.svg"

BARS = {
    "StylusCAM job": ("job",),
    "StylusCAM operations": ("operations",),
    "StylusCAM check and post": ("check", "output"),
}
"""Groups of commands by tool bar; names of their own, so that ours and CAM's stay apart."""

PATH_BAR = "StylusCAM path"
"""Title of the bar with CAM's own commands."""

CAM_BARS = ("CAM_OperationCopy", "CAM_OpActiveToggle")
"""CAM's own commands that every job needs."""


class StylusCamWorkbench(FreeCADGui.Workbench):
    """FreeCAD makes one, and asks for its bars when it is first chosen."""

    MenuText = "StylusCAM"
    ToolTip = "Toolpaths for tools of any convex shape"
    Icon = str(ICON)

    def __init__(self) -> None:
        type(self).ToolTip = translated(self.ToolTip)

    def Initialize(self) -> None:
        """Bars and menu."""
        from .. import compat
        from . import commands

        compat.load_cam_commands()
        groups = commands.groups()
        for title, names in BARS.items():
            self.appendToolbar(title, [command for name in names for command in groups[name]])
        self.appendToolbar(PATH_BAR, list(CAM_BARS))
        menu = []
        for names in (*BARS.values(), ("help",)):
            menu += [command for name in names for command in groups[name]] + [commands.SEPARATOR]
        self.appendMenu("StylusCAM", menu[:-1])

    def GetClassName(self) -> str:
        """FreeCAD's class behind workbenches in Python."""
        return "Gui::PythonWorkbench"
