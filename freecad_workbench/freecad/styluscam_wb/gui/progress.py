# SPDX-License-Identifier: LGPL-2.1-or-later
"""Long work in a thread while the window stays alive: a dialog with phase, fraction and a button that cancels."""

from __future__ import annotations

import gc
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, TypeVar

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtWidgets

from .messages import translated

Result = TypeVar("Result")

Report = Callable[[str, float], bool]
"""What the engine calls with a phase and a fraction; False cancels."""

POLLED = 20
"""Milliseconds between two looks at the thread."""

PATIENCE = 400
"""Milliseconds before the dialog appears: most paths are there by then."""

STEPS = 1000
"""Of the bar."""


class LongWork:
    """Runs functions one after the other, each in a thread; the window answers meanwhile, its document is not touched.

    The dialog is modal for the application: nobody edits or closes a document while it is computed.
    """

    def __init__(self, title: str) -> None:
        self._dialog = QtWidgets.QProgressDialog(FreeCADGui.getMainWindow())
        self._dialog.setObjectName("StylusCAM_Progress")
        self._dialog.setWindowModality(QtCore.Qt.ApplicationModal)
        self._dialog.setWindowTitle("StylusCAM")
        self._dialog.setLabelText(title)
        self._dialog.setCancelButtonText(translated("Cancel"))
        self._dialog.setRange(0, STEPS)
        self._dialog.setMinimumWidth(360)
        self._dialog.setAutoClose(False)
        self._dialog.setAutoReset(False)
        self._dialog.setMinimumDuration(PATIENCE)
        self._dialog.setValue(0)
        self._title = title
        self._state = _State()

    def __enter__(self) -> LongWork:
        return self

    def __exit__(self, *_: object) -> None:
        self._dialog.close()
        self._dialog.setParent(None)  # Python's alone now: a later deletion by Qt would meet a wrapper that is gone

    def __call__(self, work: Callable[[Report], Result]) -> Result:
        """What `work` returns; its errors pass through.

        Raises:
            styluscam.Cancelled: the button was pressed; by the engine, at its next report.
        """
        found: list[Result] = []
        thread = threading.Thread(target=self._state.guarded, args=(lambda: found.append(work(self._state.report)),))
        self._state.error = None
        loop, timer = QtCore.QEventLoop(), QtCore.QTimer()

        def look() -> None:
            self._show()
            if not thread.is_alive():
                loop.quit()

        timer.setInterval(POLLED)
        timer.timeout.connect(look)
        with _no_collection(), _no_closing():
            thread.start()
            timer.start()
            loop.exec_() if hasattr(loop, "exec_") else loop.exec()
            timer.stop()
            thread.join()
        if self._state.error is not None:
            raise self._state.error
        return found[0]

    def _show(self) -> None:
        phase, fraction = self._state.seen
        if self._dialog.wasCanceled():
            self._state.cancelled = True
            self._dialog.setLabelText(translated("Cancelling..."))
            return
        self._dialog.setLabelText(f"{self._title}: {translated(phase)}" if phase else self._title)
        self._dialog.setValue(min(STEPS - 1, int(STEPS * fraction)))


class ComputingError(RuntimeError):
    """A document was to be closed while it is computed."""


@contextmanager
def _no_closing() -> Iterator[None]:
    """Refuses to close documents: FreeCAD crashes over one that is closed while it is recomputed.

    The dialog keeps a person from it; this keeps scripts, which `FreeCAD.closeDocument` lets do it.
    """
    close = FreeCAD.closeDocument

    def refuse(name: str) -> None:
        raise ComputingError(f"the document {name} cannot be closed while a path is computed: cancel that first")

    FreeCAD.closeDocument = refuse
    try:
        yield
    finally:
        FreeCAD.closeDocument = close


@contextmanager
def _no_collection() -> Iterator[None]:
    """Keeps Python from collecting cycles: it would in the thread as well, and delete the window's widgets there."""
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            gc.enable()


class _State:
    """What the thread and the window exchange."""

    def __init__(self) -> None:
        self.seen = ("", 0.0)
        self.cancelled = False
        self.error: BaseException | None = None

    def report(self, phase: str, fraction: float) -> bool:
        """Called in the thread."""
        self.seen = (phase, fraction)
        return not self.cancelled

    def guarded(self, work: Callable[[], Any]) -> None:
        """Keeps an error for the thread that waits."""
        try:
            work()
        except BaseException as error:
            self.error = error
