# SPDX-License-Identifier: LGPL-2.1-or-later
"""The task panel of a tool: nothing is changed before OK, and OK is one step that can be undone."""

from __future__ import annotations

from typing import Any, Protocol

import FreeCADGui
from PySide import QtWidgets

from .. import stylus, tools
from . import messages
from .tool_editor import ToolEditor


class Target(Protocol):
    """What a panel edits."""

    label: str
    document: dict[str, Any]
    number: int | None

    def store(self, label: str, document: dict[str, Any], number: int) -> None:
        """Makes it what was typed, in one transaction."""


class ExistingBit:
    """A bit of a document."""

    number: int | None = None

    def __init__(self, bit: Any) -> None:
        """Reads the bit.

        Raises:
            ToolError: its lengths are not those of its profile.
        """
        self._bit = bit
        self.label = str(bit.Label)
        self.document = tools.tool_document(bit)

    def store(self, label: str, document: dict[str, Any], number: int) -> None:
        """Changes it, and what is computed from it."""
        bit, owner = self._bit, self._bit.Document
        owner.openTransaction(f"Edit {self.label}")
        try:
            if bit.Label != label:
                bit.Label = label
            if document != self.document:
                bit.Proxy.change(bit, stylus.properties_of(document))
                bit.touch()
            owner.recompute()
        except BaseException:
            owner.abortTransaction()
            raise
        owner.commitTransaction()


class TaskPanel:
    """What FreeCAD asks of a task panel."""

    def __init__(self, target: Target) -> None:
        self._target = target
        self._ok: Any = None
        self.editor = ToolEditor(target.label, target.document, target.number)
        self.form = self.editor.widget
        self.editor.valid_changed.connect(self._enable)

    def getStandardButtons(self) -> Any:
        """OK and Cancel."""
        buttons = QtWidgets.QDialogButtonBox.StandardButton
        both = buttons.Ok | buttons.Cancel
        return int(both) if isinstance(both, int) or hasattr(both, "__int__") else both

    def modifyStandardButtons(self, box: Any) -> None:
        """OK is there only for what is a tool."""
        self._ok = box.button(QtWidgets.QDialogButtonBox.StandardButton.Ok)
        self._enable(self.editor.is_valid)

    def _enable(self, is_valid: bool) -> None:
        if self._ok is not None:
            self._ok.setEnabled(is_valid)

    def accept(self) -> bool:
        """Stores it and closes."""
        if not self.editor.update():
            return False
        with messages.shown("Stylus tool"):
            self._target.store(self.editor.label, self.editor.document, self.editor.number)
            return self._close()
        return False

    def reject(self) -> bool:
        """Closes; nothing was changed."""
        return self._close()

    def _close(self) -> bool:
        document = FreeCADGui.ActiveDocument
        if document is not None and document.getInEdit() is not None:
            document.resetEdit()
        FreeCADGui.Control.closeDialog()
        return True


def open_for(target: Target) -> TaskPanel:
    """Shows a panel."""
    panel = TaskPanel(target)
    FreeCADGui.Control.closeDialog()
    FreeCADGui.Control.showDialog(panel)
    return panel
