# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a person reads: translated texts, and errors as sentences in a dialog and in the report view."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path as FilePath
from typing import Any

import FreeCAD

from ..texts import translated

ERROR = "color: #ffffff; background: #a3121f; padding: 4px; border-radius: 3px;"
"""The style of errors in panels, white on dark red: readable on light and dark ones alike."""


TRANSLATIONS = FilePath(__file__).parents[1] / "resources" / "translations"


def load_translations() -> None:
    """Makes FreeCAD read our files of translations; before our first text is translated."""
    import FreeCADGui

    FreeCADGui.addLanguagePath(str(TRANSLATIONS))
    FreeCADGui.updateLocale()


@contextmanager
def shown(title: str) -> Iterator[None]:
    """Shows an error of what is done inside, instead of throwing it at FreeCAD.

    A user's mistake is a sentence; a fault of ours is one as well, and its traceback goes to the log.
    """
    try:
        yield
    except Exception as error:
        show_error(title, error)


def show_error(title: str, error: BaseException) -> None:
    """One sentence in a dialog and in the report view; the traceback of a fault of ours in the log."""
    from .. import mistakes  # imports CAM

    text = mistakes.reason(error)
    FreeCAD.Console.PrintError(f"StylusCAM: {text}\n")
    if mistakes.is_fault(error):
        import traceback

        FreeCAD.Console.PrintLog("".join(traceback.format_exception(error)))
    _dialog(title, text)


def _dialog(title: str, text: str) -> None:
    import FreeCADGui
    from PySide import QtCore, QtWidgets

    box: Any = QtWidgets.QMessageBox(FreeCADGui.getMainWindow())
    box.setObjectName("StylusCAM_Message")
    box.setIcon(QtWidgets.QMessageBox.Warning)
    box.setWindowTitle(translated(title))
    box.setText(text)
    box.setTextInteractionFlags(QtCore.Qt.TextSelectableByMouse)
    box.exec_() if hasattr(box, "exec_") else box.exec()
