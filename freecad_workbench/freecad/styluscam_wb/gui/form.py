# SPDX-License-Identifier: LGPL-2.1-or-later
"""A form made from the engine's fields: one row each, in groups, with units, ranges and tool tips."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from PySide import QtCore, QtWidgets

from .. import ops, properties, rails
from ..fields import JOB, OPERATION, PART, PROCESS, SETUP, SHEET, Field
from .editors import Editor, editor_of
from .messages import ERROR, translated
from .rails_editor import Rails

GROUPS = {OPERATION: "Path", PROCESS: "Process", SHEET: "Sheet", PART: "Model", SETUP: "Set-up", JOB: "Job"}
"""Titles of the groups, by section."""

ADVANCED = "Advanced"


class Form:
    """Rows for the fields of an operation, those that apply shown."""

    def __init__(self, obj: Any, layout: Any) -> None:
        """`layout` is a QVBoxLayout to which the groups are added."""
        self._obj = obj
        self._groups: dict[str, _Group] = {}
        self._advanced = _Collapsible()
        self._rows: list[tuple[Field, Editor, _Group]] = []
        for field in properties.fields():
            group = self._advanced.group if field.is_advanced else self._group(field.section, layout)
            editor = _editor(field, obj, group.widget)
            group.add(field, editor)
            self._rows.append((field, editor, group))
        layout.addWidget(self._advanced.widget)
        self.show_owned()

    def _group(self, section: str, layout: Any) -> _Group:
        if section not in self._groups:
            self._groups[section] = _Group(translated(GROUPS[section]))
            layout.addWidget(self._groups[section].widget)
        return self._groups[section]

    @property
    def signals(self) -> list[Any]:
        """Emitted when a value was changed by hand."""
        return [editor.changed for _, editor, _ in self._rows]

    def release(self) -> None:
        """Stores nothing any more, whatever the keys leave."""
        for _, editor, _ in self._rows:
            editor.blockSignals(True)

    def read(self, names: Iterable[str] | None = None) -> None:
        """Shows the properties' values; those of `names` only, where they are given."""
        wanted = None if names is None else set(names)
        for field, editor, _ in self._rows:
            if wanted is None or field.name in wanted:
                editor.show()
        self.show_owned()

    def write(self) -> None:
        """Sets the properties that differ from what is shown."""
        for field, editor, _ in self._rows:
            if properties.is_shown(self._obj, field):
                editor.store()
        self.show_owned()

    def show_owned(self) -> None:
        """Shows the rows that apply, and the groups that have any."""
        for field, editor, group in self._rows:
            shown = properties.is_shown(self._obj, field)
            group.set_shown(field, shown)
            editor.show_owned()
            group.show_error(field, (editor.error() or self._failure(field)) if shown else "")
        for group in [*self._groups.values(), self._advanced.group]:
            group.widget.setVisible(group.has_rows and (group is not self._advanced.group or self._advanced.is_open))
        self._advanced.widget.setVisible(self._advanced.group.has_rows)

    def _failure(self, field: Field) -> str:
        """Why the last computation failed, at the field that it concerns."""
        where = getattr(self._obj.Proxy, "failed_key", "")
        return ops.failure(self._obj) if where and field.is_at(where) else ""


def _editor(field: Field, obj: Any, parent: Any) -> Editor:
    return Rails(field, obj, parent) if field.key == rails.KEY else editor_of(field, obj, parent)


class _Group:
    """A titled box with one row a field."""

    def __init__(self, title: str) -> None:
        self.widget = QtWidgets.QGroupBox(title)
        self._layout = QtWidgets.QGridLayout(self.widget)
        self._layout.setColumnStretch(1, 1)
        self._rows: dict[str, tuple[Any, Any]] = {}
        self._errors: dict[str, Any] = {}
        self._shown: set[str] = set()

    def add(self, field: Field, editor: Editor) -> None:
        """A row: label and editor."""
        label = QtWidgets.QLabel(translated(field.title))
        label.setObjectName(f"{field.name}_label")
        for widget in (label, editor.widget):
            widget.setToolTip(translated(field.text))
        editor.widget.setObjectName(field.name)
        row = 2 * len(self._rows)
        self._layout.addWidget(label, row, 0)
        self._layout.addWidget(editor.widget, row, 1)
        self._rows[field.name] = (label, editor.widget)
        error = QtWidgets.QLabel()
        error.setObjectName(f"{field.name}_error")
        error.setStyleSheet(ERROR)
        error.setWordWrap(True)
        error.hide()
        self._layout.addWidget(error, row + 1, 1)
        self._errors[field.name] = error

    def show_error(self, field: Field, text: str) -> None:
        """Shows what is wrong with a value below it."""
        self._errors[field.name].setText(text)
        self._errors[field.name].setVisible(bool(text))

    def set_shown(self, field: Field, shown: bool) -> None:
        """Shows or hides a row."""
        for widget in self._rows[field.name]:
            widget.setVisible(shown)
        (self._shown.add if shown else self._shown.discard)(field.name)

    @property
    def has_rows(self) -> bool:
        """Whether any row is shown."""
        return bool(self._shown)


class _Collapsible:
    """Rows that are rarely changed, behind a button that opens them."""

    def __init__(self) -> None:
        self.widget = QtWidgets.QWidget()
        layout = QtWidgets.QVBoxLayout(self.widget)
        layout.setContentsMargins(0, 0, 0, 0)
        self._button = QtWidgets.QToolButton()
        self._button.setObjectName(ADVANCED)
        self._button.setText(translated(ADVANCED))
        self._button.setToolTip(translated("Values that are rarely changed"))
        self._button.setCheckable(True)
        self._button.setAutoRaise(True)
        self._button.setToolButtonStyle(QtCore.Qt.ToolButtonTextBesideIcon)
        self.group = _Group("")
        layout.addWidget(self._button)
        layout.addWidget(self.group.widget)
        self._button.toggled.connect(self._toggled)
        self._toggled(False)

    @property
    def is_open(self) -> bool:
        """Whether its rows are shown."""
        return bool(self._button.isChecked())

    def _toggled(self, is_open: bool) -> None:
        self._button.setArrowType(QtCore.Qt.DownArrow if is_open else QtCore.Qt.RightArrow)
        self.group.widget.setVisible(is_open)
