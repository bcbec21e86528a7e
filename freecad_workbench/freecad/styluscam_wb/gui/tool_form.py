# SPDX-License-Identifier: LGPL-2.1-or-later
"""A tool's form, made from the engine's schema: the kind of profile, base and holder, and a row for every key of it."""

from __future__ import annotations

from typing import Any

from PySide import QtCore, QtWidgets

from .. import engine, properties
from ..schema import KIND
from ..tool_keys import PROFILE, ToolKey, ToolTable, concerned, tables_of
from .messages import translated
from .tool_fields import Row, error_label

NONE = ""
"""The word of a table that is left out."""

ONE_KIND = "stated"
"""The word of a table without kinds, where it is stated."""


class ToolForm(QtCore.QObject):
    """Shows a tool document and holds what a person makes of it; `changed` is emitted at every change."""

    changed = QtCore.Signal()

    def __init__(self, document: dict[str, Any], layout: Any, after_profile: list[Any]) -> None:
        """`layout` is a QVBoxLayout to which the groups are added, and those widgets after the profile's.

        Raises:
            EngineMissingError: there is no engine.
        """
        super().__init__()
        diameter = _diameter(document)
        self._boxes: list[_Box] = []
        for table in tables_of(properties.schema()):
            box = _Box(table, document.get(table.name) if table.name else document, diameter)
            box.changed.connect(self.changed)
            layout.addWidget(box.widget)
            if table.name == PROFILE:
                for widget in after_profile:
                    layout.addWidget(widget)
            self._boxes.append(box)

    def document(self) -> dict[str, Any]:
        """The tool document as it is typed.

        Raises:
            ValueTextError: a text that holds no value.
        """
        found: dict[str, Any] = {}
        for box in self._boxes:
            value = box.value()
            if box.table.name and value is not None:
                found[box.table.name] = value
            elif not box.table.name:
                found |= value or {}
        return found

    def release(self) -> None:
        """Lets go of all widgets."""
        for box in self._boxes:
            box.release()
        self._boxes = []

    def show_error(self, where: str, message: str) -> bool:
        """Shows an error at the row that it concerns, and none elsewhere; False where there is no such row."""
        labels = {path: label for box in self._boxes for path, label in box.errors().items()}
        concerns = concerned(where, message, list(labels)) if message else ""
        for path, label in labels.items():
            label.setText(message if path == concerns else "")
            label.setVisible(path == concerns)
        return bool(concerns)


def _diameter(document: dict[str, Any]) -> float:
    return float(engine.styluscam().Tool.from_dict(document).diameter)


class _Box(QtCore.QObject):
    """A table's group: its kind, what that is, its rows."""

    changed = QtCore.Signal()

    def __init__(self, table: ToolTable, values: dict[str, Any] | None, diameter: float) -> None:
        super().__init__()
        self.table, self._diameter = table, diameter
        self._word = NONE
        self._pages: dict[str, tuple[Any, list[Row]]] = {}
        self.widget = QtWidgets.QGroupBox(translated(table.label) if table.name else translated("Shank"))
        outer = QtWidgets.QVBoxLayout(self.widget)
        self._combo = self._combo_of(table) if table.kinds or not table.required else None
        self._help = QtWidgets.QLabel()
        self._help.setWordWrap(True)
        self._help.setObjectName(f"{table.name}_help")
        self._kind_error = error_label(f"{table.name}.{KIND}_error")
        if self._combo is not None:
            for widget in (self._combo, self._help, self._kind_error):
                outer.addWidget(widget)
        self._layout = outer
        self._set(self._word_of(values), values or {})
        if self._combo is not None:
            self._combo.setCurrentIndex(self._combo.findData(self._word))
            self._combo.currentIndexChanged.connect(self._chosen)

    def _combo_of(self, table: ToolTable) -> Any:
        combo = QtWidgets.QComboBox()
        combo.setObjectName(f"{table.name}.{KIND}")
        combo.setToolTip(translated(table.text))
        words = [(kind.word, kind.word.replace("-", " ").capitalize(), kind.text) for kind in table.kinds]
        if not table.required:
            words = [(NONE, "None", "Left out"), *(words or [(ONE_KIND, table.label, table.text)])]
        for word, title, text in words:
            combo.addItem(translated(title), word)
            combo.setItemData(combo.count() - 1, translated(text), QtCore.Qt.ItemDataRole.ToolTipRole)
        return combo

    def _word_of(self, values: dict[str, Any] | None) -> str:
        if self.table.kinds:
            return str((values or {}).get(KIND, NONE))
        return ONE_KIND if self.table.required or values is not None else NONE

    def _chosen(self, index: int) -> None:
        word = str(self._combo.itemData(index))
        self._set(word, {} if word in self._pages else self._first(word))
        self.changed.emit()

    def release(self) -> None:
        """Lets go of all widgets."""
        for _, rows in self._pages.values():
            for row in rows:
                row.release()
        self._pages = {self._word: (None, [])}

    def errors(self) -> dict[str, Any]:
        """The labels for errors, by the path of the key that they concern."""
        return {f"{self.table.name}.{KIND}": self._kind_error, **{row.key.path: row.error for row in self.rows}}

    @property
    def rows(self) -> list[Row]:
        """Those of the kind that is chosen."""
        return self._pages[self._word][1]

    def _first(self, word: str) -> dict[str, Any]:
        """What a kind begins with: the engine's example of a profile; of others, numbers of the tool's size."""
        if self.table.name == PROFILE:
            engine.styluscam()
            from styluscam.tools import starters

            return dict(starters.profiles()[word])
        return {key.name: self._diameter / 2.0 for key in self._keys(word) if key.required}

    def _keys(self, word: str) -> tuple[ToolKey, ...]:
        keys = self.table.keys
        found = keys.get("" if word == ONE_KIND else word, ()) if word != NONE else ()
        return tuple(sorted(found, key=lambda key: (not key.required, key.default is not None)))

    def _set(self, word: str, values: dict[str, Any]) -> None:
        """Shows a kind with these values; one that was shown before comes back as it was left.

        Pages stay until the form goes: PySide may take a new widget for a deleted one at the same address.
        """
        for page, _ in self._pages.values():
            page.hide()
        self._word = word
        text = next((kind.text for kind in self.table.kinds if kind.word == word), "")
        self._help.setText(translated(text) if text else "")
        self._help.setVisible(bool(text))
        if word not in self._pages:
            self._pages[word] = self._page(word, values)
            self._layout.addWidget(self._pages[word][0])
        page, rows = self._pages[word]
        page.setVisible(bool(rows))

    def _page(self, word: str, values: dict[str, Any]) -> tuple[Any, list[Row]]:
        page = QtWidgets.QWidget()
        grid = QtWidgets.QGridLayout(page)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setColumnStretch(1, 1)
        rows = []
        for key in self._keys(word):
            row = Row(key, values.get(key.name, key.default), self._diameter)
            row.changed.connect(self.changed)
            line = grid.rowCount()
            grid.addWidget(row.label, line, 0)
            grid.addWidget(row.widget, line, 1)
            grid.addWidget(row.error, line + 1, 0, 1, 2)
            rows.append(row)
        return page, rows

    def value(self) -> dict[str, Any] | None:
        """The table's value; None where it is left out.

        Raises:
            ValueTextError: a text that holds no value.
        """
        if self._word == NONE:
            return None
        found: dict[str, Any] = {KIND: self._word} if self.table.kinds else {}
        for row in self.rows:
            value = row.value()
            if value is not None and value != row.key.default:
                found[row.key.name] = value
        return found
