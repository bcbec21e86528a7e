# SPDX-License-Identifier: LGPL-2.1-or-later
"""A command of the window: its words, its icon, when it can be used; an error becomes a sentence on the screen."""

from __future__ import annotations

from abc import ABC, abstractmethod
from pathlib import Path as FilePath
from typing import Any

import FreeCAD

from . import messages

ICONS = FilePath(__file__).parents[1] / "resources" / "icons"

PREFIX = "StylusCAM_"
"""FreeCAD's names of our commands begin with it."""


class Command(ABC):
    """What FreeCAD asks of a command; `menu_text` and `tool_tip` are translated when they are asked for."""

    name: str
    """After the prefix: `Verify`."""
    icon: str
    """A file of `resources/icons`, without its ending."""
    menu_text: str
    tool_tip: str

    def GetResources(self) -> dict[str, str]:
        """Icon and words."""
        return {
            "Pixmap": str(ICONS / f"{self.icon}.svg"),
            "MenuText": messages.translated(self.menu_text),
            "ToolTip": messages.translated(self.tool_tip),
        }

    def IsActive(self) -> bool:
        """Whether it can be used now."""
        return FreeCAD.ActiveDocument is not None

    def Activated(self, index: int = 0) -> None:
        """Runs it; an error is shown, never thrown at FreeCAD."""
        with messages.shown(self.menu_text):
            self.run()

    @abstractmethod
    def run(self) -> None:
        """Does it."""


def job_in_front() -> Any:
    """The CAM job that a command works on: the selected one, that of a selected operation, or the only one; else None."""
    import FreeCADGui
    from PathScripts import PathUtils

    if FreeCAD.ActiveDocument is None:
        return None
    jobs = PathUtils.GetJobs()
    for selected in FreeCADGui.Selection.getSelection():
        job = selected if selected in jobs else PathUtils.findParentJob(selected)
        if job is not None:
            return job
    return jobs[0] if len(jobs) == 1 else None
