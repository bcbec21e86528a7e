# SPDX-License-Identifier: LGPL-2.1-or-later
"""What became of an operation, in its panel: the summary of its path, or why there is none."""

from __future__ import annotations

from typing import Any

from PySide import QtCore, QtWidgets

from .. import ops
from .messages import ERROR


class Notes:
    """A label that holds the operation's notes, or its error."""

    def __init__(self) -> None:
        self.widget = QtWidgets.QLabel()
        self.widget.setObjectName("StylusCAM_Notes")
        self.widget.setWordWrap(True)
        self.widget.setTextInteractionFlags(QtCore.Qt.TextSelectableByMouse)

    def show(self, obj: Any) -> None:
        """Shows those of an operation."""
        failure = ops.failure(obj)
        text = failure or "\n".join(obj.Notes)
        self.widget.setStyleSheet(ERROR if failure else "")
        self.widget.setText(text)
        self.widget.setVisible(bool(text))
