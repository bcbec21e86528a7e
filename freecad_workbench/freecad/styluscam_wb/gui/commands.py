# SPDX-License-Identifier: LGPL-2.1-or-later
"""All commands of the window in their groups, registered with FreeCAD once, when a workbench first needs them."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from . import (
    axes_view,
    contact_track,
    engagement_view,
    example_commands,
    flank_view,
    heat_map,
    job_commands,
    operation_commands,
    path_colours,
    preferences,
    report_command,
    sheet_picture,
    tool_commands,
    tool_motion,
    verify_command,
)
from .command import PREFIX, Command

CHECKS = (
    verify_command,
    heat_map,
    contact_track,
    engagement_view,
    axes_view,
    flank_view,
    sheet_picture,
    path_colours,
    tool_motion,
)
"""Modules whose commands look at a computed path, in their order in the bar."""

SEPARATOR = "Separator"
"""FreeCAD's name of a gap between commands."""


@lru_cache(maxsize=1)
def groups() -> dict[str, list[str]]:
    """FreeCAD's names of the commands by group, in the order of a job's life; registers them all.

    Groups: `job`, `operations`, `check`, `output`, `help`.
    """
    found: dict[str, list[Command]] = {
        "job": [*job_commands.before(), *tool_commands.commands()],
        "operations": operation_commands.commands(),
        "check": [command for module in CHECKS for command in module.commands()],
        "output": [*report_command.commands(), *job_commands.after()],
        "help": [*example_commands.commands(), preferences.Preferences()],
    }
    return {group: [_register(command) for command in commands] for group, commands in found.items()}


def _register(command: Command) -> str:
    import FreeCADGui

    name = PREFIX + command.name
    FreeCADGui.addCommand(name, command)
    return name


class DropDown:
    """Commands behind one button of a bar."""

    def __init__(self, names: list[str], text: str, tool_tip: str) -> None:
        self._names, self._text, self._tool_tip = names, text, tool_tip

    def GetCommands(self) -> tuple[str, ...]:
        """The commands."""
        return tuple(self._names)

    def GetResources(self) -> dict[str, str]:
        """Words."""
        from .messages import translated

        return {"MenuText": translated(self._text), "ToolTip": translated(self._tool_tip)}

    def IsActive(self) -> bool:
        """Each command knows itself when it can be used."""
        return True


@lru_cache(maxsize=1)
def operations_drop_down() -> str:
    """FreeCAD's name of one button for all operations."""
    import FreeCADGui

    name = f"{PREFIX}Operations"
    drop_down: Any = DropDown(groups()["operations"], "StylusCAM operations", "Paths for tools of any convex shape")
    FreeCADGui.addCommand(name, drop_down)
    return name
