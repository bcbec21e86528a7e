# SPDX-License-Identifier: LGPL-2.1-or-later
"""The editor of a tool: name, form and drawing, which follows what is typed; panel and dialogs hold one."""

from __future__ import annotations

from typing import Any

from PySide import QtCore, QtGui, QtWidgets

from .. import mistakes
from . import tool_curves
from .command import ICONS
from .messages import translated
from .tool_drawing import ToolDrawing
from .tool_fields import error_label
from .tool_form import ToolForm

PAUSE = 40
"""Milliseconds without a change after which the tool is built again."""


class ToolEditor(QtCore.QObject):
    """`widget` shows it; `valid_changed` reports whether what is typed is a tool."""

    valid_changed = QtCore.Signal(bool)

    def __init__(self, label: str, document: dict[str, Any], number: int | None = None) -> None:
        """`number` is the tool's in its job, None where it has none to choose.

        Raises:
            EngineMissingError, styluscam.ToolError: there is no engine, or it refuses the document.
        """
        super().__init__()
        self.widget = QtWidgets.QWidget()
        self.widget.setObjectName("StylusCAM_Tool")
        self.widget.setWindowTitle(translated("Stylus tool"))
        self.widget.setWindowIcon(QtGui.QIcon(str(ICONS / "tool.svg")))
        layout = QtWidgets.QVBoxLayout(self.widget)
        self._name = QtWidgets.QLineEdit(label)
        self._name.setObjectName("ToolName")
        self._number = QtWidgets.QSpinBox()
        self._number.setObjectName("ToolNumber")
        self._number.setRange(1, 9999)
        self._number.setValue(number or 1)
        names = QtWidgets.QFormLayout()
        names.addRow(translated("Name"), self._name)
        if number is not None:
            names.addRow(translated("Tool number"), self._number)
        layout.addLayout(names)
        self._error = error_label("StylusCAM_ToolError")
        self.drawing = ToolDrawing()
        self._form = ToolForm(document, layout, [self._error, self.drawing])
        layout.addStretch(1)
        self.document = document
        self._begun = self._form.document()
        self.is_valid = True
        self._timer = QtCore.QTimer()
        self._timer.setSingleShot(True)
        self._timer.setInterval(PAUSE)
        self._timer.timeout.connect(self.update)
        self._form.changed.connect(self._timer.start)
        self._name.textEdited.connect(lambda text: self._timer.start())
        self.widget.destroyed.connect(self._release)
        self.update()

    def _release(self) -> None:
        """Lets go of FreeCAD's widgets with the window that held them: PySide takes what is left of one for the next."""
        self._timer.stop()
        self._form.release()

    @property
    def label(self) -> str:
        """The tool's name."""
        return str(self._name.text()).strip()

    @property
    def number(self) -> int:
        """The tool's number."""
        return int(self._number.value())

    def update(self) -> bool:
        """Builds the tool that is typed and draws it, or shows what is wrong; returns whether it is one."""
        self._timer.stop()
        try:
            typed = self._form.document()
            document = self.document if typed == self._begun else typed
            curves = tool_curves.curves_of(document)
            self.drawing.show_curves(curves)
            self.document, message, where = document, "", ""
        except Exception as error:
            if mistakes.is_fault(error):
                raise
            message, where = mistakes.sentence(error), str(getattr(error, "where", ""))
            self.drawing.show_stale()
        if not message and not self.label:
            message = translated("The tool has no name: give it one")
        at_row = self._form.show_error(where, message)
        self._error.setText("" if at_row else message)
        self._error.setVisible(bool(message) and not at_row)
        if self.is_valid != (not message):
            self.is_valid = not message
            self.valid_changed.emit(self.is_valid)
        return self.is_valid
