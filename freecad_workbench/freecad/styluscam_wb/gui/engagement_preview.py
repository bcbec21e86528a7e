# SPDX-License-Identifier: LGPL-2.1-or-later
"""The switch of a pocket's panel that shows its engagement map, and shows it again whenever the path was computed anew."""

from __future__ import annotations

from typing import Any

from PySide import QtCore, QtWidgets

from .. import engaged
from . import engagement_view, messages, pictures
from .messages import translated


class EngagementPreview:
    """A check box; it is there for pockets, and can be used once there is a path."""

    def __init__(self, obj: Any, job: Any) -> None:
        self._obj, self._job = obj, job
        self.widget = QtWidgets.QCheckBox(translated(engagement_view.ShowEngagement.menu_text))
        self.widget.setObjectName("EngagementMap")
        self.widget.setToolTip(
            translated("Colours the path by its engagement angle, from 0 to the bound; Apply computes the path")
        )
        self.widget.setChecked(self._is_shown())
        self.widget.toggled.connect(self._show)
        # the path is written several times while it is computed: what is drawn is the last one, afterwards
        self._later = QtCore.QTimer()
        self._later.setSingleShot(True)
        self._later.setInterval(0)
        self._later.timeout.connect(self._draw)

    def follow(self) -> None:
        """The operation has changed."""
        self.widget.setVisible(engaged.is_pocket(self._obj))
        if self.widget.isChecked() and engaged.is_pocket(self._obj) and not self._is_shown():
            self._later.start()

    def release(self) -> None:
        """The panel closes: what is shown stays."""
        self._later.stop()
        self.widget.blockSignals(True)

    def _is_shown(self) -> bool:
        picture = pictures.shown(self._obj.Document.Name, engagement_view.KEY)
        return picture is not None and picture.hidden == [self._obj]

    def _show(self, is_on: bool) -> None:
        """The box was clicked; without a path it stays on until there is one."""
        if not is_on:
            pictures.remove(self._obj.Document.Name, engagement_view.KEY)
        elif engaged.is_computed(self._obj):
            self._draw()
            self.widget.setChecked(self._is_shown())

    def _draw(self) -> None:
        """Draws the map of a path that is computed."""
        if self.widget.isChecked() and not self._is_shown() and engaged.is_computed(self._obj):
            with messages.shown("StylusCAM"):
                engagement_view.draw(self._job, self._obj)
