# SPDX-License-Identifier: LGPL-2.1-or-later
"""Switches of a panel that show pictures of its operation, and show them again whenever the path was computed anew."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any

from PySide import QtCore, QtWidgets

from .. import engaged
from . import messages, pictures
from .messages import translated


class Shown(ABC):
    """A picture that a panel offers."""

    key: str
    """Of the picture."""
    name: str
    """Of the switch."""
    menu_text: str
    tool_tip: str

    @abstractmethod
    def applies(self, obj: Any) -> bool:
        """Whether it is there for an operation."""

    @abstractmethod
    def draw(self, job: Any, obj: Any) -> None:
        """Draws it of a path that is computed; may raise what is shown as a sentence."""


class PictureSwitch:
    """A check box; it can be used once there is a path."""

    def __init__(self, obj: Any, job: Any, shown: Shown) -> None:
        self._obj, self._job, self._shown = obj, job, shown
        self.widget = QtWidgets.QCheckBox(translated(shown.menu_text))
        self.widget.setObjectName(shown.name)
        self.widget.setToolTip(translated(shown.tool_tip))
        self.widget.setChecked(self._is_shown())
        self.widget.toggled.connect(self._show)
        # the path is written several times while it is computed: what is drawn is the last one, afterwards
        self._later = QtCore.QTimer()
        self._later.setSingleShot(True)
        self._later.setInterval(0)
        self._later.timeout.connect(self._draw)

    def follow(self) -> None:
        """The operation has changed."""
        applies = self._shown.applies(self._obj)
        self.widget.setVisible(applies)
        if self.widget.isChecked() and applies and not self._is_shown():
            self._later.start()

    def release(self) -> None:
        """The panel closes: what is shown stays."""
        self._later.stop()
        self.widget.blockSignals(True)

    def _is_shown(self) -> bool:
        picture = pictures.shown(self._obj.Document.Name, self._shown.key)
        return picture is not None and picture.operation == self._obj

    def _show(self, is_on: bool) -> None:
        """The box was clicked; without a path it stays on until there is one."""
        if not is_on:
            pictures.remove(self._obj.Document.Name, self._shown.key)
        elif engaged.is_computed(self._obj):
            self._draw()
            self.widget.setChecked(self._is_shown())

    def _draw(self) -> None:
        """Draws the picture of a path that is computed."""
        if self.widget.isChecked() and not self._is_shown() and engaged.is_computed(self._obj):
            with messages.shown("StylusCAM"):
                self._shown.draw(self._job, self._obj)
