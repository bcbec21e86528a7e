# SPDX-License-Identifier: LGPL-2.1-or-later
"""Our editor where FreeCAD's tool library opens its own for a tool of ours."""

from __future__ import annotations

from typing import Any

from PySide import QtWidgets

from .. import compat, stylus, tools
from .messages import translated
from .tool_editor import ToolEditor


class _Editing:
    """A bit, in a document or in a library, and the editor that shows it."""

    def __init__(self, bit: Any, number: int | None = None) -> None:
        self._bit = bit
        self.editor = ToolEditor(str(bit.Label), tools.tool_document(bit), number)
        self._first = self.editor.document

    def store(self) -> None:
        """Makes the bit what was typed."""
        if self._bit.Label != self.editor.label:
            self._bit.Label = self.editor.label
        if self.editor.document != self._first:
            self._bit.Proxy.change(self._bit, stylus.properties_of(self.editor.document))


class LibraryDialog:
    """In place of FreeCAD 1.1's editor of a tool of a library."""

    def __init__(self, toolbit: Any, tool_no: int | None = None, parent: Any = None, icon: bool = False) -> None:
        """The arguments of FreeCAD's."""
        self.toolbit, self.tool_no = toolbit, tool_no
        self._editing = _Editing(toolbit.obj, tool_no)
        editor = self._editing.editor
        self.form = QtWidgets.QDialog(parent)
        self.form.setObjectName("StylusCAM_LibraryTool")
        self.form.setWindowTitle(translated("Stylus tool"))
        layout = QtWidgets.QVBoxLayout(self.form)
        scrolled = QtWidgets.QScrollArea()
        scrolled.setWidget(editor.widget)
        scrolled.setWidgetResizable(True)
        scrolled.setMinimumSize(480, 720)
        layout.addWidget(scrolled)
        kinds = QtWidgets.QDialogButtonBox.StandardButton
        buttons = QtWidgets.QDialogButtonBox(kinds.Ok | kinds.Cancel)
        buttons.accepted.connect(self._accept)
        buttons.rejected.connect(self.form.reject)
        layout.addWidget(buttons)
        ok = buttons.button(kinds.Ok)
        editor.valid_changed.connect(ok.setEnabled)

    def _accept(self) -> None:
        if self._editing.editor.update():
            self._editing.store()
            if self.tool_no is not None:
                self.tool_no = self._editing.editor.number
            self.form.accept()

    def get_tool_no(self) -> int | None:
        """The tool's number in its library."""
        return self.tool_no

    def show(self) -> int:
        """Shows it; the dialog's code when it is closed."""
        return int(self.form.exec_() if hasattr(self.form, "exec_") else self.form.exec())


class LibraryPage:
    """In place of FreeCAD 1.0's editor inside its library's dialog: the dialog has the buttons."""

    def __init__(self, tool: Any, parentWidget: Any = None, loadBitBody: bool = True) -> None:
        """The arguments of FreeCAD's."""
        self.tool = tool
        self._editing = _Editing(tool)
        self.form = QtWidgets.QScrollArea()
        self.form.setWidgetResizable(True)
        inside = QtWidgets.QWidget()
        layout = QtWidgets.QVBoxLayout(inside)
        layout.addWidget(self._editing.editor.widget)
        self.form.setWidget(inside)
        self.form.layout = lambda: layout  # the dialog adds its buttons there
        if parentWidget is not None:
            self.form.setParent(parentWidget)
            parentWidget.layout().addWidget(self.form)

    def accept(self) -> None:
        """Stores what was typed, if it is a tool."""
        self.updateTool()

    def reject(self) -> None:
        """Nothing was changed."""

    def updateUI(self) -> None:
        """It follows itself."""

    def updateTool(self) -> None:
        """Stores what was typed, if it is a tool."""
        if self._editing.editor.update():
            self._editing.store()

    def setupUI(self) -> None:
        """It is ready."""


def install() -> None:
    """FreeCAD's library opens our editor for tools of ours, and its own for others."""
    compat.replace_tool_editors(LibraryDialog, LibraryPage)
