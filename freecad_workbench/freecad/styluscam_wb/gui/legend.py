# SPDX-License-Identifier: LGPL-2.1-or-later
"""Legends over the 3-D view: cards in its upper left corner, in the colours of the window, passing the mouse through."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from PySide import QtCore, QtGui, QtWidgets

Colour = tuple[int, int, int]

MARGIN = 12
"""From the view's corner, pixels."""

BAR = (220, 14)
"""Size of a colour bar, pixels."""

LINES = 320
"""Width at which lines of text are wrapped, pixels."""


class Card(QtWidgets.QFrame):
    """A titled legend; entries are added from above."""

    def __init__(self, key: str, title: str) -> None:
        super().__init__()
        self.setObjectName(f"StylusCAM_Legend_{key}")
        self.setFrameShape(QtWidgets.QFrame.StyledPanel)
        self.setAutoFillBackground(True)
        self._rows = QtWidgets.QVBoxLayout(self)
        self._rows.setContentsMargins(8, 6, 8, 6)
        self._rows.setSpacing(3)
        heading = QtWidgets.QLabel(title)
        font = heading.font()
        font.setBold(True)
        heading.setFont(font)
        self._rows.addWidget(heading)

    def add_swatch(self, colour: Colour, text: str) -> None:
        """A colour and what it means."""
        row = QtWidgets.QWidget()
        cells = QtWidgets.QHBoxLayout(row)
        cells.setContentsMargins(0, 0, 0, 0)
        patch = QtWidgets.QLabel()
        picture = QtGui.QPixmap(18, 12)
        picture.fill(QtGui.QColor(*colour))
        patch.setPixmap(picture)
        cells.addWidget(patch)
        cells.addWidget(QtWidgets.QLabel(text), 1)
        self._rows.addWidget(row)

    def add_bar(self, colours: Sequence[Colour], marks: Sequence[str]) -> None:
        """Colours from left to right over evenly spaced marks."""
        picture = QtGui.QPixmap(*BAR)
        gradient = QtGui.QLinearGradient(0.0, 0.0, float(BAR[0]), 0.0)
        for index, colour in enumerate(colours):
            gradient.setColorAt(index / (len(colours) - 1), QtGui.QColor(*colour))
        painter = QtGui.QPainter(picture)
        painter.fillRect(picture.rect(), gradient)
        painter.end()
        bar = QtWidgets.QLabel()
        bar.setPixmap(picture)
        self._rows.addWidget(bar)
        ends = QtWidgets.QWidget()
        ends.setFixedWidth(BAR[0])
        cells = QtWidgets.QHBoxLayout(ends)
        cells.setContentsMargins(0, 0, 0, 0)
        for index, mark in enumerate(marks):
            if index:
                cells.addStretch(1)
            cells.addWidget(QtWidgets.QLabel(mark))
        self._rows.addWidget(ends)

    def add_line(self, text: str) -> None:
        """A line of text."""
        label = QtWidgets.QLabel(text)
        label.setWordWrap(label.sizeHint().width() > LINES)
        label.setMaximumWidth(LINES)
        self._rows.addWidget(label)

    @property
    def texts(self) -> list[str]:
        """What can be read on it, from above."""
        return [label.text() for label in self.findChildren(QtWidgets.QLabel) if label.text()]


class _Stack(QtWidgets.QWidget):
    """The cards of one view."""

    def __init__(self, view: Any) -> None:
        super().__init__(view)
        self.setObjectName("StylusCAM_Legends")
        self.setAttribute(QtCore.Qt.WA_TransparentForMouseEvents)
        self._cards: dict[str, Card] = {}
        layout = QtWidgets.QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSizeConstraint(QtWidgets.QLayout.SetFixedSize)
        self.move(MARGIN, MARGIN)

    def put(self, card: Card) -> None:
        self.take(card.objectName())
        self._cards[card.objectName()] = card
        self.layout().addWidget(card, 0, QtCore.Qt.AlignLeft)
        self.show()
        self.raise_()

    def take(self, name: str) -> None:
        card = self._cards.pop(name, None)
        if card is not None:
            card.setParent(None)  # at once: one of the same name may follow
            card.deleteLater()
        self.setVisible(bool(self._cards))


def show(view: Any, card: Card) -> None:
    """Puts a card over a 3-D view; it replaces one of the same key."""
    widget = view.graphicsView()
    stack = widget.findChild(QtWidgets.QWidget, "StylusCAM_Legends") or _Stack(widget)
    stack.put(card)


def remove(view: Any, key: str) -> None:
    """Takes a card away, if it is there."""
    stack = view.graphicsView().findChild(QtWidgets.QWidget, "StylusCAM_Legends")
    if stack is not None:
        stack.take(f"StylusCAM_Legend_{key}")
