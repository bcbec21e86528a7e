# SPDX-License-Identifier: LGPL-2.1-or-later
"""Commands of tools: a new stylus in the job in front, tool files, FreeCAD's tool library."""

from __future__ import annotations

from pathlib import Path as FilePath
from typing import Any

import FreeCAD

from .. import compat, engine, stylus, tools
from . import labels
from .command import Command, job_in_front
from .messages import translated

FILES = "Tool bits (*.fctb)"
LOADED = "Tools (*.fctb *.json)"

NEW = "Stylus"
"""What a new tool is called."""


class NewBit:
    """A bit that OK makes: with a tool controller in a job, or alone in the document."""

    def __init__(self, document: Any, job: Any) -> None:
        self._owner, self._job = document, job
        self.label = labels.unique(NEW, document)
        self.document: dict[str, Any] = {"profile": _first_profile()}
        self.number = next_number(job) if job is not None else None

    def store(self, label: str, document: dict[str, Any], number: int) -> None:
        """Makes it, in one transaction."""
        self._owner.openTransaction(f"Create {label}")
        try:
            bit = compat.make_toolbit(self._owner, label, stylus.properties_of(document))
            put_in_job(self._job, bit, number)
            self._owner.recompute()
        except BaseException:
            self._owner.abortTransaction()
            raise
        self._owner.commitTransaction()


def _first_profile() -> dict[str, Any]:
    engine.styluscam()
    from styluscam.tools import starters

    return dict(next(iter(starters.profiles().values())))


def next_number(job: Any) -> int:
    """The number after the greatest that a tool of the job has."""
    return max((int(controller.ToolNumber) for controller in job.Tools.Group), default=0) + 1


def put_in_job(job: Any, bit: Any, number: int) -> None:
    """A tool controller for a bit, its spindle off; nothing without a job."""
    if job is None:
        return
    controller = compat.make_tool_controller(f"TC: {bit.Label}", bit, number)
    controller.SpindleDir = "None"
    job.Proxy.addToolController(controller)


def selected_bit() -> Any:
    """The bit that is selected, itself or by its tool controller; the only stylus of the document; else None."""
    import FreeCADGui

    if FreeCAD.ActiveDocument is None:
        return None
    for selected in FreeCADGui.Selection.getSelection():
        bit = getattr(selected, "Tool", None) or selected
        if compat.tool_kind(bit):
            return bit
    found = [obj for obj in FreeCAD.ActiveDocument.Objects if hasattr(obj, stylus.PROFILE) and compat.tool_kind(obj)]
    return found[0] if len(found) == 1 else None


class MakeTool(Command):
    """A new stylus."""

    name = "Tool"
    icon = "tool"
    menu_text = "Stylus tool"
    tool_tip = "Adds a tool of any convex shape to the job in front; its spindle stays off"

    def IsActive(self) -> bool:
        """With a document, and while no panel is open."""
        return FreeCAD.ActiveDocument is not None and not _is_busy()

    def run(self) -> None:
        """Opens the panel; OK makes the tool."""
        from . import tool_panel

        tool_panel.open_for(NewBit(FreeCAD.ActiveDocument, job_in_front()))


class _WithBit(Command):
    """A command that works on the selected bit."""

    def IsActive(self) -> bool:
        """With a bit, and while no panel is open."""
        return selected_bit() is not None and not _is_busy()


class SaveToolFile(_WithBit):
    """The selected tool as a file."""

    name = "SaveTool"
    icon = "tool-save"
    menu_text = "Save tool file..."
    tool_tip = "Writes the selected tool as FreeCAD's .fctb, with exact numbers"

    def run(self) -> None:
        """Asks for the file and writes it."""
        bit = selected_bit()
        first = FilePath(FreeCAD.getUserAppDataDir()) / f"{bit.Label}.fctb"
        path = _chosen_file(True, translated(self.menu_text), str(first), FILES)
        if path:
            tools.write_toolbit(bit, path if path.lower().endswith(".fctb") else f"{path}.fctb")


class LoadToolFile(Command):
    """A tool from a file."""

    name = "LoadTool"
    icon = "tool-load"
    menu_text = "Load tool file..."
    tool_tip = "Adds the tool of a file (.fctb of FreeCAD, .json of StylusCAM) to the job in front"

    def IsActive(self) -> bool:
        """With a document, and while no panel is open."""
        return FreeCAD.ActiveDocument is not None and not _is_busy()

    def run(self) -> None:
        """Asks for the file, and adds its tool in one transaction."""
        path = _chosen_file(False, translated(self.menu_text), FreeCAD.getUserAppDataDir(), LOADED)
        if not path:
            return
        document, job = FreeCAD.ActiveDocument, job_in_front()
        document.openTransaction(f"Load {FilePath(path).name}")
        try:
            bit = tools.read_tool_file(document, path)
            put_in_job(job, bit, next_number(job) if job is not None else 0)
            document.recompute()
        except BaseException:
            document.abortTransaction()
            raise
        document.commitTransaction()


class SaveToLibrary(_WithBit):
    """The selected tool in FreeCAD's tool library."""

    name = "ToolToLibrary"
    icon = "tool-library"
    menu_text = "Save tool to library"
    tool_tip = "Adds the selected tool to FreeCAD's tool library, with exact numbers"

    def run(self) -> None:
        """Adds it and reports where."""
        where = compat.add_to_library(selected_bit(), tools.write_toolbit)
        FreeCAD.Console.PrintMessage(f"StylusCAM: {where}\n")


def _is_busy() -> bool:
    import FreeCADGui

    return bool(FreeCADGui.Control.activeDialog())


def _chosen_file(is_new: bool, title: str, first: str, kinds: str) -> str:
    """What a person chooses in FreeCAD's dialog of files; empty where it is cancelled."""
    import FreeCADGui
    from PySide import QtWidgets

    ask = QtWidgets.QFileDialog.getSaveFileName if is_new else QtWidgets.QFileDialog.getOpenFileName
    return str(ask(FreeCADGui.getMainWindow(), title, first, kinds)[0])


def commands() -> list[Command]:
    """All of them; none without an engine, which the operations' command then reports."""
    if not engine.is_there():
        return []
    from . import tool_dialogs

    tool_dialogs.install()
    return [MakeTool(), SaveToolFile(), LoadToolFile(), SaveToLibrary()]
