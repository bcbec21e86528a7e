# SPDX-License-Identifier: LGPL-2.1-or-later
"""One widget for each type of property: shows its value, stores what was changed by hand."""

from __future__ import annotations

from abc import abstractmethod
from typing import Any

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtWidgets

from .. import properties
from ..fields import ANGLE, BOOL, CHOICE, DISTANCE, FLOAT, INTEGER, LENGTH, SECONDS, SPEED, TEXTS, Field
from .messages import translated

DECIMALS = 4
"""Places shown of numbers without a unit."""

DIGITS = 6
"""Digits shown of lengths and angles: tolerances are tenths of a micrometre, whatever places the user's preferences show."""

HUGE = 2**31 - 1
"""Beyond any range of the engine's: a value out of range is stated, not changed."""

ATTEMPTS = 1000
"""Spin boxes that are made for one that Python can use: new ones come to the addresses of those that are gone first."""

NARROWEST = 90
"""Width (pixels) below which no editor is squeezed."""


def connected(widget: Any, signal: str, called: Any) -> None:
    """Has a widget of FreeCAD's call something.

    By the signal's text: PySide never frees a widget of FreeCAD's once an attribute of it was taken as a signal, and what is
    left of it is then taken for the next widget at the same address: using that one raises "already deleted".
    """
    QtCore.QObject.connect(widget, QtCore.SIGNAL(signal), called)


def quantity_box() -> Any:
    """A spin box of FreeCAD's for numbers with units, without a parent.

    What is left in Python of a widget that is gone is taken for the new one if that has the same address (see `connected`).
    Then another one is made: the first keeps the address, and is never seen.
    """
    loader = FreeCADGui.UiLoader()
    boxes = (loader.createWidget("Gui::QuantitySpinBox") for _ in range(ATTEMPTS))
    box = next(filter(is_there, boxes), None)
    if box is None:
        raise RuntimeError("FreeCAD makes no spin box that Python can use; close the panel and open it again")
    return box


def is_there(widget: Any) -> bool:
    """Whether a widget of Qt's stands behind Python's."""
    try:
        widget.objectName()
    except RuntimeError:  # "Internal C++ object already deleted"
        return False
    return True


class Editor(QtCore.QObject):
    """A widget bound to a property."""

    changed = QtCore.Signal()
    """Emitted when a person changed the value, once it is whole."""

    def __init__(self, field: Field, obj: Any, widget: Any) -> None:
        """`widget` has a parent, which owns it."""
        super().__init__(widget)
        self._field, self._obj, self.widget = field, obj, widget
        widget.setMinimumWidth(NARROWEST)

    def show(self) -> None:
        """Shows the property's value."""
        self._show()

    def store(self) -> None:
        """Sets the property where it differs from what is shown."""
        self._store()

    def show_owned(self) -> None:
        """Shows those of its parts that apply to the operation as it stands."""

    def error(self) -> str:
        """What is wrong with the value that is shown; empty where nothing is."""
        allowed = self._field.range
        value = self._number()
        if allowed is None or value is None or (self._field.optional and value == 0.0) or allowed.holds(value):
            return ""
        return translated("must be {}").format(allowed.in_words(self._field.unit))

    def _number(self) -> float | None:
        """The shown number in the schema's unit; None where it is none."""
        return None

    @abstractmethod
    def _show(self) -> None: ...

    @abstractmethod
    def _store(self) -> None: ...

    def _set(self, value: Any) -> None:
        if getattr(self._obj, self._field.name) != value:
            setattr(self._obj, self._field.name, value)


class Quantity(Editor):
    """A number with a unit, which takes expressions.

    The spin box has no limits: FreeCAD's would refuse the `m` of `0.02 mm`, since 0.02 m is too much. It shows as many
    places as the user's preferences or ours ask for, and may round to them: only what was typed is stored.
    """

    def __init__(self, field: Field, obj: Any, parent: Any) -> None:
        widget = quantity_box()
        widget.setParent(parent)
        super().__init__(field, obj, widget)
        widget.setProperty("unit", getattr(obj, field.name).getUserPreferred()[2])
        widget.setProperty("binding", f"{obj.Name}.{field.name}")
        self._shown, self._exact = "", 0.0
        connected(widget, "editingFinished()", self._edited)

    def _edited(self) -> None:
        self.changed.emit()

    def _show(self) -> None:
        expression = self._expression()
        value = self._obj.evalExpression(expression) if expression else getattr(self._obj, self._field.name)
        self._exact = float(getattr(value, "Value", value))
        quantity = FreeCAD.Units.Quantity(self._exact, getattr(self._obj, self._field.name).Unit)
        quantity.Format = {"Precision": DIGITS, "NumberFormat": "g", "Denominator": 16}
        self.widget.setProperty("value", quantity)
        self.widget.setReadOnly(bool(expression))
        self._shown = self.widget.text()

    def _store(self) -> None:
        if self._is_typed() and not self._expression():
            setattr(self._obj, self._field.name, float(self.widget.property("rawValue")))
            self._show()

    def _number(self) -> float:
        value = float(self.widget.property("rawValue")) if self._is_typed() else self._exact
        return value * SECONDS if self._field.type == SPEED else value

    def _is_typed(self) -> bool:
        return bool(self.widget.text() != self._shown)

    def _expression(self) -> str:
        return str(dict(self._obj.ExpressionEngine).get(self._field.name, ""))


class Number(Editor):
    """A number without a unit."""

    def __init__(self, field: Field, obj: Any, parent: Any) -> None:
        widget = (QtWidgets.QSpinBox if field.type == INTEGER else QtWidgets.QDoubleSpinBox)(parent)
        super().__init__(field, obj, widget)
        if field.type == FLOAT:
            widget.setDecimals(DECIMALS)
            widget.setSingleStep(0.05)
        widget.setRange(-HUGE, HUGE)
        widget.editingFinished.connect(self.changed)

    def _show(self) -> None:
        self.widget.setValue(getattr(self._obj, self._field.name))

    def _store(self) -> None:
        shown = type(self.widget.value())(round(getattr(self._obj, self._field.name), DECIMALS))
        if self.widget.value() != shown:
            self._set(self.widget.value())

    def _number(self) -> float:
        return float(self.widget.value())


class Flag(Editor):
    """Yes or no."""

    def __init__(self, field: Field, obj: Any, parent: Any) -> None:
        super().__init__(field, obj, QtWidgets.QCheckBox(parent))
        self.widget.clicked.connect(self.changed)

    def _show(self) -> None:
        self.widget.setChecked(bool(getattr(self._obj, self._field.name)))

    def _store(self) -> None:
        self._set(self.widget.isChecked())


class Words(Editor):
    """One of some words; each has its own tool tip."""

    def __init__(self, field: Field, obj: Any, parent: Any) -> None:
        super().__init__(field, obj, QtWidgets.QComboBox(parent))
        texts = {choice.word: choice.text for choice in field.words}
        for word in field.choices:
            self.widget.addItem(translated(word) if word else translated("not stated"), word)
            self.widget.setItemData(self.widget.count() - 1, translated(texts.get(word, "")), QtCore.Qt.ToolTipRole)
        self.widget.currentIndexChanged.connect(self.changed)

    def _show(self) -> None:
        blocker = QtCore.QSignalBlocker(self.widget)
        self.widget.setCurrentIndex(self.widget.findData(getattr(self._obj, self._field.name)))
        del blocker

    def _store(self) -> None:
        self._set(self.widget.currentData())


class WordList(Editor):
    """Any of some words, a box each."""

    def __init__(self, field: Field, obj: Any, parent: Any) -> None:
        super().__init__(field, obj, QtWidgets.QWidget(parent))
        layout = QtWidgets.QVBoxLayout(self.widget)
        layout.setContentsMargins(0, 0, 0, 0)
        self._boxes = {}
        self._words = {choice.word: choice for choice in field.words}
        for choice in field.words:
            box = QtWidgets.QCheckBox(translated(choice.word))
            box.setToolTip(translated(choice.text))
            box.setObjectName(f"{field.name}_{choice.word}")
            box.clicked.connect(self.changed)
            layout.addWidget(box)
            self._boxes[choice.word] = box

    def _show(self) -> None:
        for word, box in self._boxes.items():
            box.setChecked(word in getattr(self._obj, self._field.name))

    def show_owned(self) -> None:
        """Words that are for sheets alone only where there is one; what is ticked can always be unticked."""
        for word, box in self._boxes.items():
            box.setVisible(box.isChecked() or properties.is_word_shown(self._obj, self._words[word]))

    def _store(self) -> None:
        self._set([word for word, box in self._boxes.items() if box.isChecked()])


class Text(Editor):
    """A line of text; of several, separated by commas."""

    def __init__(self, field: Field, obj: Any, parent: Any) -> None:
        super().__init__(field, obj, QtWidgets.QLineEdit(parent))
        if field.optional:
            self.widget.setPlaceholderText(translated("not stated"))
        self.widget.editingFinished.connect(self.changed)

    def _show(self) -> None:
        value = getattr(self._obj, self._field.name)
        self.widget.setText(", ".join(value) if self._field.type == TEXTS else str(value))

    def _store(self) -> None:
        text = self.widget.text()
        parts = [part.strip() for part in text.split(",") if part.strip()]
        self._set(parts if self._field.type == TEXTS else text)


def editor_of(field: Field, obj: Any, parent: Any) -> Editor:
    """The editor for a field's type, its widget inside a parent."""
    kinds: dict[str, type[Any]] = {
        **dict.fromkeys((LENGTH, DISTANCE, ANGLE, SPEED), Quantity),
        **dict.fromkeys((FLOAT, INTEGER), Number),
        BOOL: Flag,
        CHOICE: Words,
        TEXTS: WordList if field.words else Text,
    }
    editor: Editor = kinds.get(field.type, Text)(field, obj, parent)
    return editor
