# SPDX-License-Identifier: LGPL-2.1-or-later
"""Between FreeCAD's path commands (mm and mm/s) and the engine's program (mm and mm/min)."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import Path

from . import engine, tools
from .path_words import words_of

if TYPE_CHECKING:
    from styluscam import Program

MOTIONS = ("G0", "G00", "G1", "G01", "G2", "G02", "G3", "G03")
"""Commands that move the tool."""

COOLANTS = ("None", "Flood", "Mist")


class MotionError(ValueError):
    """Commands that cannot become a program; the message names the operation and what to do."""


def comment(text: str) -> str:
    """A text as a comment command: one line, no brackets inside."""
    words = " ".join(text.split()).replace("(", "[").replace(")", "]")
    return f"({words})"


def commands_of(program: Program) -> list[Any]:
    """A planned program's moves as path commands; what happens between them is the tool controller's and the post's."""
    return [Path.Command(name, words) for name, words in words_of(program)]


@dataclass
class Builder:
    """Collects the paths of a section's objects, in order; the engine reads them."""

    controllers: dict[int, Any]
    """Tool controllers by tool number."""
    sections: list[tuple[str, str | None, str, str]] = field(default_factory=list)
    """Label, an operation's kind, its coolant, its commands as text."""
    _tool: int | None = None
    """The number of the tool in the spindle."""

    def add_tool_change(self, controller: Any) -> None:
        """The tool controller's commands."""
        self._tool = int(controller.ToolNumber)
        self._add(controller, None, "None")

    def add_operation(self, obj: Any, controller: Any, kind: str, coolant: str) -> None:
        """An operation's commands, and its coolant around them; its tool is loaded first where it is not yet.

        FreeCAD leaves the tool change out of a file that begins with the tool of the file before it.
        """
        if controller is not None and self._tool != int(controller.ToolNumber):
            self.add_tool_change(controller)
        if self._tool is None:
            raise MotionError(f"{obj.Label}: no tool is loaded before it: give it a tool controller")
        if coolant not in COOLANTS:
            raise MotionError(f"{obj.Label}: coolant {coolant} cannot be posted: choose one of {', '.join(COOLANTS)}")
        self._add(obj, kind, coolant)

    def add_fixture(self, obj: Any) -> None:
        """The commands that change to a work offset."""
        self._add(obj, None, "None")

    def program(self, setup: dict[str, Any]) -> Program:
        """The program; `setup` is its record.

        Raises:
            styluscam.JobError: commands that the engine does not read; it names their object.
            MotionError: a tool controller without a tool.
        """
        records = [self._record(number, controller) for number, controller in sorted(self.controllers.items())]
        document = {"wcs": "G54", **setup}
        return engine.program_of_path(self.sections, json.dumps(records), json.dumps(document))

    def _add(self, obj: Any, kind: str | None, coolant: str) -> None:
        text = obj.Path.toGCode()
        title = f"{comment(obj.Label)}\n"  # the post writes it itself
        self.sections.append((obj.Label, kind, coolant, text.removeprefix(title) if kind else text))

    def _record(self, number: int, controller: Any) -> dict[str, Any]:
        if controller.Tool is None:
            raise MotionError(f"{controller.Label}: it has no tool")
        return {
            "name": f"T{number}",
            "number": number,
            "length_offset": number,
            "description": _description(controller),
            "reference": "tip",
            "reference_height": 0.0,
            "diameter": float(controller.Tool.Diameter),
        }


def _description(controller: Any) -> str:
    """The engine's words for a tool that it knows, else its label."""
    try:
        document = tools.tool_document(controller.Tool)
    except tools.ToolError:
        return str(controller.Tool.Label)
    return str(engine.styluscam().Tool.from_dict(document).description)
