# SPDX-License-Identifier: LGPL-2.1-or-later
"""Between FreeCAD's path commands (mm and mm/s) and the engine's program (mm and mm/min)."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import Path

from . import engine, tools

if TYPE_CHECKING:
    from styluscam import Program

RAPIDS, FEEDS = ("G0", "G00"), ("G1", "G01")
TOOL_CHANGES = ("M6", "M06")
SPINDLE = {"M3": "clockwise", "M03": "clockwise", "M4": "counterclockwise", "M04": "counterclockwise"}
SPINDLE_OFF = ("M5", "M05")
FLOOD = {"M8": True, "M08": True, "M9": False, "M09": False}
DWELL = ("G4", "G04")
OFFSETS = ("G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3")
ALREADY_SO = ("G17", "G21", "G40", "G49", "G80", "G90", "G94", "G98")
"""Modes that the posted text is in anyway."""
ARCS = ("G2", "G02", "G3", "G03")
CYCLES = ("G73", "G74", "G81", "G82", "G83", "G84", "G85", "G86", "G87", "G88", "G89")


class MotionError(ValueError):
    """Commands that cannot become a program; the message names the operation and what to do."""


def comment(text: str) -> str:
    """A text as a comment command: one line, no brackets inside."""
    words = " ".join(text.split()).replace("(", "[").replace(")", "]")
    return f"({words})"


def commands_of(program: Program) -> list[Any]:
    """A planned program's moves as path commands; what happens between them is the tool controller's and the post's."""
    commands = []
    for move in program.moves:
        x, y, z = (float(value) for value in move["end"])
        place = {"X": x, "Y": y, "Z": z}
        if move["kind"] == 0:
            commands.append(Path.Command("G0", place))
        else:
            commands.append(Path.Command("G1", {**place, "F": float(move["feed"]) / 60.0}))
    return commands


@dataclass
class Builder:
    """Collects the commands of a section's objects, in order, into the document of a program."""

    controllers: dict[int, Any]
    """Tool controllers by tool number."""
    wcs: str = ""
    tools: list[dict[str, Any]] = field(default_factory=list)
    operations: list[dict[str, Any]] = field(default_factory=list)
    moves: list[dict[str, Any]] = field(default_factory=list)
    events: list[dict[str, Any]] = field(default_factory=list)
    _place: list[float | None] = field(default_factory=lambda: [None, None, None])
    _feed: float | None = None
    _tool: int | None = None
    _spindle: bool = False

    def add_tool_change(self, controller: Any) -> None:
        """The tool controller's commands; where they start no spindle, it stands."""
        self._spindle = False
        for command in controller.Path.Commands:
            self._add(command, controller.Label)
        if not self._spindle:
            self._event({"kind": "spindle-off"})

    def add_operation(self, obj: Any, controller: Any, kind: str, coolant: str) -> None:
        """An operation's commands, and its coolant around them; its tool is loaded first where it is not yet.

        FreeCAD leaves the tool change out of a file that begins with the tool of the file before it.
        """
        if controller is not None and (self._tool is None or self.tools[self._tool]["number"] != controller.ToolNumber):
            self.add_tool_change(controller)
        if self._tool is None:
            raise MotionError(f"{obj.Label}: no tool is loaded before it: give it a tool controller")
        if coolant not in ("None", "Flood"):
            raise MotionError(f"{obj.Label}: coolant {coolant} cannot be posted yet: choose Flood or None")
        self.operations.append({"id": obj.Label, "kind": kind, "tool": self._tool})
        if coolant == "Flood":
            self._event({"kind": "flood", "on": True})
        title = comment(obj.Label)  # the post's own line says it
        for command in obj.Path.Commands:
            if command.Name != title:
                self._add(command, obj.Label)
        if coolant == "Flood":
            self._event({"kind": "flood", "on": False})

    def add_fixture(self, commands: list[Any]) -> None:
        """The work offset of the section."""
        for command in commands:
            if command.Name in OFFSETS:
                if self.wcs and command.Name != self.wcs:
                    raise MotionError(
                        f"{self.wcs} and {command.Name} in one program cannot be posted yet: order the output by "
                        "fixture and split it, or choose one work offset"
                    )
                self.wcs = command.Name

    def program(self, setup: dict[str, Any]) -> Program:
        """The program; `setup` is its record, but for the work offset."""
        if self._spindle:
            self._event({"kind": "spindle-off"})
        document = {
            "schema": 1,
            "setup": {"wcs": self.wcs or "G54", **setup},
            "tools": self.tools,
            "operations": self.operations,
            "moves": self.moves,
            "events": self.events,
        }
        return engine.program_of(json.dumps(document))

    def _event(self, event: dict[str, Any]) -> None:
        self.events.append({"before": len(self.moves), **event})

    def _add(self, command: Any, label: str) -> None:
        name, words = command.Name, command.Parameters
        if name.startswith("("):
            self._event({"kind": "comment", "text": name.strip("()")})
        elif name in RAPIDS or name in FEEDS:
            self._move(name in FEEDS, words, label)
        elif name in TOOL_CHANGES:
            self._load(int(words["T"]), label)
        elif name in SPINDLE:
            self._spindle = True
            self._event({"kind": "spindle-on", "rpm": words.get("S", 0.0), "direction": SPINDLE[name]})
        elif name in SPINDLE_OFF:
            self._spindle = False
            self._event({"kind": "spindle-off"})
        elif name in FLOOD:
            self._event({"kind": "flood", "on": FLOOD[name]})
        elif name in DWELL:
            self._event({"kind": "dwell", "seconds": words.get("P", 0.0)})
        elif name not in ALREADY_SO:
            raise MotionError(f"{label}: {_unknown(name)}")

    def _move(self, cutting: bool, words: dict[str, float], label: str) -> None:
        unknown = sorted(set(words) - {"X", "Y", "Z", "F"})
        if unknown:
            raise MotionError(f"{label}: moves of {', '.join(unknown)} cannot be posted: this is for three axes")
        self._place = [words.get(axis, now) for axis, now in zip("XYZ", self._place, strict=True)]
        if cutting:
            self._feed = words["F"] * 60.0 if words.get("F") else self._feed
        if any(value is None for value in self._place):
            if cutting:
                raise MotionError(f"{label}: it cuts before X, Y and Z are known")
            return  # a rapid with the other axes follows: the first place is reached from above
        if cutting and self._feed is None:
            raise MotionError(f"{label}: a move has no feed: set the tool controller's feeds")
        feed = self._feed if cutting else 0.0
        operation = max(len(self.operations) - 1, 0)
        kind = "feed" if cutting else "rapid"
        self.moves.append({"kind": kind, "end": self._place, "feed": feed, "operation": operation})

    def _load(self, number: int, label: str) -> None:
        known = next((i for i, tool in enumerate(self.tools) if tool["number"] == number), None)
        if known is None:
            known = len(self.tools)
            self.tools.append(self._record(number, label))
        if known != self._tool:
            self._tool = known
            self._place = [None, None, None]
            self._event({"kind": "tool-change", "tool": known})

    def _record(self, number: int, label: str) -> dict[str, Any]:
        controller = self.controllers.get(number)
        if controller is None or controller.Tool is None:
            raise MotionError(f"{label}: the job has no tool with number {number}")
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


def _unknown(name: str) -> str:
    if name in ARCS:
        return f"arcs ({name}) cannot be posted yet: use FreeCAD's own post for this job"
    if name in CYCLES:
        return f"drilling cycles ({name}) cannot be posted yet: use FreeCAD's own post for this job"
    return f"{name} cannot be posted: use FreeCAD's own post for this job"
