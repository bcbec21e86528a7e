# SPDX-License-Identifier: LGPL-2.1-or-later
"""Between FreeCAD's path commands (mm and mm/s) and the engine's program (mm and mm/min)."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import Path

from . import engine, tools

if TYPE_CHECKING:
    from styluscam import Program

COOLANTS = ("None", "Flood", "Mist")

UPRIGHT = 1e-9
"""A tool whose axis is less off +Z stands upright."""

_MOTION = re.compile(r"^G0?[0-3] ", re.MULTILINE)
"""A line of FreeCAD's that moves the tool."""


class MotionError(ValueError):
    """Commands that cannot become a program; the message names the operation and what to do."""


def comment(text: str) -> str:
    """A text as a comment command: one line, no brackets inside."""
    words = " ".join(text.split()).replace("(", "[").replace(")", "]")
    return f"({words})"


def moves(text: str) -> bool:
    """Whether a path's text moves the tool."""
    return _MOTION.search(text) is not None


def path_of(comments: list[str], program: Program, last: list[Any]) -> Any:
    """Comments, a planned program's moves and last commands as a path.

    What happens between the moves is the tool controller's and the post's. FreeCAD reads text faster than it takes
    commands from Python; the text has the decimals that FreeCAD saves and posts (docs/performance.md).

    Raises:
        styluscam.JobError: a move that has no command.
    """
    ended = [command.toGCode() + _axis(program, -1) for command in last]
    return Path.Path("\n".join([*map(comment, comments), _begun_upwards(program), *ended]))


def _begun_upwards(program: Program) -> str:
    """The commands after a rapid straight up to the height of the first, as FreeCAD's own operations begin.

    Its dressups take the first command that names X and Y for the first move of the path: without this one, the
    boundary's would cut from the origin.
    """
    text = program.path_text()
    name, *words = text.partition("\n")[0].split(" ")
    height = [word for word in words if word.startswith("Z")]
    return f"{name} {height[0]}{_axis(program, 0)}\n{text}" if height else text


def _axis(program: Program, index: int) -> str:
    """The words of a straight command that keep the tool as a move leaves it; none where that stands upright."""
    if not len(program.moves):
        return ""
    x, y, z = (float(part) for part in program.moves["axis"][index])
    return "" if max(abs(x), abs(y)) <= UPRIGHT else f" I{x:.6f} J{y:.6f} K{z:.6f}"


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

    def add_operation(self, obj: Any, controller: Any, kind: str, coolant: str) -> str:
        """An operation's commands, which it returns, and its coolant around them; its tool is loaded first where it is not yet.

        FreeCAD leaves the tool change out of a file that begins with the tool of the file before it.
        """
        if controller is not None and self._tool != int(controller.ToolNumber):
            self.add_tool_change(controller)
        if self._tool is None:
            raise MotionError(f"{obj.Label}: no tool is loaded before it: give it a tool controller")
        if coolant not in COOLANTS:
            raise MotionError(f"{obj.Label}: coolant {coolant} cannot be posted: choose one of {', '.join(COOLANTS)}")
        return self._add(obj, kind, coolant)

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

    def _add(self, obj: Any, kind: str | None, coolant: str) -> str:
        text = str(obj.Path.toGCode())  # once: FreeCAD copies all commands whenever it is asked for the path
        title = f"{comment(obj.Label)}\n"  # the post writes it itself
        self.sections.append((obj.Label, kind, coolant, text.removeprefix(title) if kind else text))
        return text

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
