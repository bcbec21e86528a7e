# SPDX-License-Identifier: LGPL-2.1-or-later
"""The editor of two rails: edges by their names, taken from the selection by a button."""

from __future__ import annotations

from typing import Any

from PathScripts import PathUtils
from PySide import QtWidgets

from .. import rails
from ..fields import Field
from . import edges
from .editors import Editor
from .messages import translated


class Rails(Editor):
    """A line of text, and a button that fills it."""

    def __init__(self, field: Field, obj: Any, parent: Any) -> None:
        super().__init__(field, obj, QtWidgets.QWidget(parent))
        rows = QtWidgets.QVBoxLayout(self.widget)
        rows.setContentsMargins(0, 0, 0, 0)
        self._text = QtWidgets.QLineEdit()
        self._text.setObjectName(f"{field.name}_text")
        self._text.setPlaceholderText(translated("those of the faces"))
        self._take = QtWidgets.QPushButton(translated("From selection"))
        self._take.setObjectName(f"{field.name}_take")
        self._take.setToolTip(translated("Select two edges of the model in the view, then press this"))
        self._note = QtWidgets.QLabel()
        self._note.setObjectName(f"{field.name}_note")
        self._note.setWordWrap(True)
        self._note.hide()
        for widget in (self._text, self._take, self._note):
            rows.addWidget(widget)
        self._text.editingFinished.connect(self.changed)
        self._take.clicked.connect(self._taken)

    def _taken(self) -> None:
        names = edges.selected(PathUtils.findParentJob(self._obj))
        is_two = len(names) == 2
        words = translated("select two edges of the model and nothing else; selected now: {}")
        self._note.setText("" if is_two else words.format(len(names)))
        self._note.setVisible(not is_two)
        if is_two:
            self._text.setText(", ".join(names))
            self.changed.emit()

    def _show(self) -> None:
        self._text.setText(rails.shown(str(getattr(self._obj, self._field.name))))

    def _store(self) -> None:
        self._set(rails.stored(self._text.text()))
