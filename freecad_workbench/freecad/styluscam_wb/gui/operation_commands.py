# SPDX-License-Identifier: LGPL-2.1-or-later
"""One command for each kind of operation that the engine has."""

from __future__ import annotations

from typing import Any

import FreeCAD

from .. import engine, properties
from ..fields import OPERATION, PATHS
from ..schema import Choice
from .command import ICONS, Command, job_in_front


class MakeOperation(Command):
    """Makes an operation of a kind in the job in front, with what is selected, and opens its panel."""

    def __init__(self, kind: Choice) -> None:
        self._kind = kind.word
        words = kind.word.replace("-", " ")
        self.name = "Operation_" + words.title().replace(" ", "")
        own = f"operation-{kind.word}"
        self.icon = own if (ICONS / f"{own}.svg").is_file() else "operation"
        self.menu_text = words.capitalize()
        self.tool_tip = kind.text

    def IsActive(self) -> bool:
        """With a job, and while no panel is open."""
        import FreeCADGui

        return job_in_front() is not None and not FreeCADGui.Control.activeDialog()

    def run(self) -> None:
        """Makes it."""
        from . import operation_view

        operation_view.create(self._kind, self.menu_text, job_in_front())


class InstallEngine(Command):
    """Stands for the operations while there is no engine."""

    name = "InstallEngine"
    icon = "operation"
    menu_text = "Engine missing"
    tool_tip = "States how the StylusCAM engine is installed"

    def IsActive(self) -> bool:
        """Always."""
        return True

    def run(self) -> None:
        """Raises the sentence.

        Raises:
            EngineMissingError: there is no engine.
        """
        engine.styluscam()
        FreeCAD.Console.PrintMessage("StylusCAM: the engine is there now; start FreeCAD again\n")


def commands() -> list[Command]:
    """All of them; one that states how to install the engine where there is none."""
    if not engine.is_there():
        return [InstallEngine()]
    kinds: tuple[Any, ...] = properties.schema().table(*PATHS[OPERATION]).kinds
    return [MakeOperation(kind) for kind in kinds]
