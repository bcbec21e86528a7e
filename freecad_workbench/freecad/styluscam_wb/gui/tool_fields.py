# SPDX-License-Identifier: LGPL-2.1-or-later
"""One row of a tool's form: label, widget, and the error that concerns it."""

from __future__ import annotations

from typing import Any

import FreeCAD
from PySide import QtCore, QtWidgets

from ..tool_keys import NUMBER, POINTS, ToolKey, text_of, value_of
from .editors import connected, quantity_box
from .messages import ERROR, translated

DIGITS = 9
"""Digits that a number is shown with: a tenth of a micrometre of every tool; the value itself stays exact."""

KNOWN_UNITS = ("mm", "mm^2", "deg")
"""Units of the schema that FreeCAD's spin boxes know; others stand in the label."""

NARROWEST = 80
"""Width (pixels) below which no editor is squeezed."""

POINTS_HEIGHT = 110
"""Height (pixels) of a list of points."""


def error_label(name: str) -> Any:
    """A hidden label for an error."""
    label = QtWidgets.QLabel()
    label.setObjectName(name)
    label.setStyleSheet(ERROR)
    label.setWordWrap(True)
    label.setTextInteractionFlags(QtCore.Qt.TextInteractionFlag.TextSelectableByMouse)
    label.hide()
    return label


class Row(QtCore.QObject):
    """A key's label, editor and error; `changed` is emitted when a person changed it."""

    changed = QtCore.Signal()

    def __init__(self, key: ToolKey, value: Any, suggested: Any) -> None:
        """`value` is the document's, None where it is left out; `suggested` is what it begins with once it is stated."""
        super().__init__()
        self.key = key
        self._stated: Any = None
        self._editor = _editor(key)
        self._editor.show_value(suggested if value is None and key.type == NUMBER else value)
        self._editor.widget.setObjectName(key.path)
        self._editor.changed.connect(self.changed)
        self.label = QtWidgets.QLabel(self._editor.titled(translated(key.label)))
        self.label.setObjectName(f"{key.path}_label")
        self.error = error_label(f"{key.path}_error")
        self.widget = (
            self._with_box(value is not None) if key.is_optional and key.type == NUMBER else self._editor.widget
        )
        for widget in (self.label, self._editor.widget):
            widget.setToolTip(translated(key.text))

    def _with_box(self, stated: bool) -> Any:
        """The editor behind a box: a number that may be left out."""
        outer = QtWidgets.QWidget()
        layout = QtWidgets.QHBoxLayout(outer)
        layout.setContentsMargins(0, 0, 0, 0)
        self._stated = QtWidgets.QCheckBox()
        self._stated.setObjectName(f"{self.key.path}_stated")
        self._stated.setToolTip(translated("Whether this is stated"))
        self._stated.setChecked(stated)
        nothing = QtWidgets.QLabel(translated("not stated"))
        layout.addWidget(self._stated)
        layout.addWidget(self._editor.widget, 1)
        layout.addWidget(nothing, 1)

        def toggled(on: bool) -> None:
            self._editor.widget.setVisible(on)
            nothing.setVisible(not on)

        toggled(stated)
        self._stated.toggled.connect(toggled)
        self._stated.toggled.connect(lambda on: self.changed.emit())
        return outer

    def value(self) -> Any:
        """The document's value; None where it is left out.

        Raises:
            ValueTextError: a text that holds none.
        """
        if self._stated is not None and not self._stated.isChecked():
            return None
        return self._editor.value()

    def release(self) -> None:
        """Lets go of its widgets."""
        self._editor.widget = self._editor = self.widget = self.label = self.error = None


class _Number(QtCore.QObject):
    """FreeCAD's spin box, with units and expressions; keeps all digits of a number that nobody changed."""

    changed = QtCore.Signal()

    def __init__(self, key: ToolKey) -> None:
        super().__init__()
        self._unit = key.unit if key.unit in KNOWN_UNITS else ""
        self._apart = "" if self._unit or key.unit in ("", "1") else key.unit
        self._exact = self._shown = 0.0
        self.widget = quantity_box()
        self.widget.setProperty("unit", self._unit)
        self.widget.setProperty("singleStep", 0.1)
        self.widget.setMinimumWidth(NARROWEST)
        connected(self.widget, "valueChanged(double)", self._typed)

    def titled(self, label: str) -> str:
        """The label, with a unit that the box does not show."""
        return f"{label} [{self._apart}]" if self._apart else label

    def show_value(self, value: Any) -> None:
        self._exact = float(value or 0.0)
        unit = FreeCAD.Units.Quantity(1.0, self._unit).Unit if self._unit else FreeCAD.Units.Unit()
        quantity = FreeCAD.Units.Quantity(self._exact, unit)
        quantity.Format = {"Precision": DIGITS, "NumberFormat": "g", "Denominator": 16}
        blocker = QtCore.QSignalBlocker(self.widget)
        self.widget.setProperty("value", quantity)
        self._shown = float(self.widget.property("rawValue"))
        del blocker

    def _typed(self, value: float) -> None:
        if abs(value - self._shown) <= 1e-12 * abs(self._shown):
            return  # written again as it was shown
        self._exact = self._shown = value
        self.changed.emit()

    def value(self) -> float:
        return self._exact


class _Line(QtCore.QObject):
    """A line of text."""

    changed = QtCore.Signal()

    def __init__(self, key: ToolKey) -> None:
        super().__init__()
        self._key = key
        self.widget = QtWidgets.QLineEdit()
        self.widget.setPlaceholderText(translated("not stated"))
        self.widget.textEdited.connect(lambda text: self.changed.emit())

    def titled(self, label: str) -> str:
        """The label as it is."""
        return label

    def show_value(self, value: Any) -> None:
        self.widget.setText(text_of(self._key, value))
        self.widget.setCursorPosition(0)

    def value(self) -> Any:
        return value_of(self._key, self.widget.text())


class _Lines(QtCore.QObject):
    """Points, one a line."""

    changed = QtCore.Signal()

    def __init__(self, key: ToolKey) -> None:
        super().__init__()
        self._key = key
        self.widget = QtWidgets.QPlainTextEdit()
        self.widget.setFixedHeight(POINTS_HEIGHT)
        self.widget.setTabChangesFocus(True)
        self.widget.setPlaceholderText(translated("radius, height"))
        self.widget.textChanged.connect(self.changed)

    def titled(self, label: str) -> str:
        """The label, with what a line holds."""
        return f"{label}\n[{translated('r, z in mm')}]"

    def show_value(self, value: Any) -> None:
        blocker = QtCore.QSignalBlocker(self.widget)
        self.widget.setPlainText(text_of(self._key, value))
        del blocker

    def value(self) -> Any:
        return value_of(self._key, self.widget.toPlainText())


def _editor(key: ToolKey) -> Any:
    kinds: dict[str, Any] = {NUMBER: _Number, POINTS: _Lines}
    return kinds.get(key.type, _Line)(key)
