"""Drives FreeCAD's window by events, step by step: a scenario is a generator that yields what it waits for.

    def scenario():
        click(button("Apply"))
        yield until(lambda: path_is_drawn(), "a path")

A condition is looked at between events, so dialogs that block FreeCAD's own code are driven like any other window.
"""

from __future__ import annotations

import json
import os
import sys
import time
import traceback
from collections.abc import Callable, Generator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtGui, QtWidgets

Scenario = Callable[[], Generator[Any, None, Any]]

POLLED = 15
"""Milliseconds between two looks at a condition."""

PATIENCE = 20.0
"""Seconds that a condition may take unless it states others."""

FOLDER = Path(os.environ["STYLUSCAM_TEST_FOLDER"])
"""Where results and pictures go."""


@dataclass
class Until:
    """A condition to wait for."""

    condition: Callable[[], Any]
    what: str
    seconds: float = PATIENCE


def until(condition: Callable[[], Any], what: str, seconds: float = PATIENCE) -> Until:
    """Waits until the condition holds; `what` stands in the error where it never does."""
    return Until(condition, what, seconds)


def settled(rounds: int = 3) -> Until:
    """Waits until the window has had so many turns to draw itself and to answer posted events."""
    left = [rounds]

    def counted() -> bool:
        left[0] -= 1
        return left[0] < 0

    return Until(counted, "events")


# --- finding -----------------------------------------------------------------------------------------------------


def main_window() -> Any:
    return FreeCADGui.getMainWindow()


def windows() -> list[Any]:
    """The main window, and the dialog or pop-up in front of it."""
    application = QtWidgets.QApplication
    others = (application.activeModalWidget(), application.activeWindow(), application.activePopupWidget())
    found = [main_window()]
    for other in others:
        if other is not None and other not in found:
            found.append(other)
    return found


def visible(kind: Any, *, name: str = "", text: str = "", inside: Any = None) -> list[Any]:
    """Visible widgets of a class, by object name or text, in the windows in front or inside one widget.

    Asked for as narrowly as possible: a Python object for a widget that Qt deletes on its own is a crash to come, or is taken for
    the next widget at its address. Such widgets are left out.
    """
    found = []
    for root in [inside] if inside is not None else windows():
        children = root.findChildren(kind, name) if name else root.findChildren(kind)
        itself = [root] if isinstance(root, kind) and name in ("", root.objectName()) else []
        for widget in [*itself, *children]:
            if _is_visible(widget) and widget not in found and (not text or _text(widget) == text):
                found.append(widget)
    return found


def _is_visible(widget: Any) -> bool:
    try:
        return bool(widget.isVisible())
    except RuntimeError:
        return False


def one(kind: Any, **criteria: Any) -> Any:
    """The one visible widget; an error that lists those of its class."""
    found = visible(kind, **criteria)
    if len(found) != 1:
        there = [(w.objectName(), _text(w)) for w in visible(kind, inside=criteria.get("inside"))]
        raise LookupError(f"{len(found)} widgets are {kind.__name__} {criteria}; visible: {there[:60]}")
    return found[0]


def _text(widget: Any) -> str:
    """What stands on it, without the marks of its keys."""
    text = getattr(widget, "text", None)
    return str(text() if callable(text) else widget.windowTitle()).replace("&", "")


def panel_button(which: Any) -> Any:
    """A button of the open task panel: `QtWidgets.QDialogButtonBox.Ok`."""
    for box in visible(QtWidgets.QDialogButtonBox):
        button = box.button(which)
        if button is not None and button.isVisible():
            return button
    box = QtWidgets.QDialogButtonBox(which)  # where FreeCAD's own cannot be asked: a button with the same words
    for button in visible(QtWidgets.QPushButton, text=_text(box.button(which))):
        return button
    raise LookupError(f"no task panel with a button {which}")


def tool_button(command: str) -> Any:
    """The visible tool button of a FreeCAD command."""
    names = []
    for bar in visible(QtWidgets.QToolBar):
        for action in bar.actions():
            names.append(action.objectName())
            button = bar.widgetForAction(action) if names[-1] == command else None
            if button is not None and button.isVisible():
                return button
    raise LookupError(f"no visible tool button for {command}; there are {names}")


def dialog(title: str = "") -> Any:
    """The dialog in front with a title, None where there is none."""
    found = [w for w in windows() if isinstance(w, QtWidgets.QDialog) and title in w.windowTitle()]
    return found[0] if found else None


# --- events ------------------------------------------------------------------------------------------------------


def click(widget: Any, at: Any = None, *, double: bool = False) -> None:
    """A click of the left button in the middle of a widget, or at a point of it; posted, so that it may block."""
    point = QtCore.QPointF(at) if at is not None else QtCore.QPointF(widget.rect().center())
    scene = QtCore.QPointF(widget.mapToGlobal(point.toPoint()))
    left, none = QtCore.Qt.LeftButton, QtCore.Qt.NoButton
    kinds = [(QtCore.QEvent.MouseMove, none, none), (QtCore.QEvent.MouseButtonPress, left, left)]
    kinds += [(QtCore.QEvent.MouseButtonRelease, left, none)]
    if double:
        kinds += [(QtCore.QEvent.MouseButtonDblClick, left, left), (QtCore.QEvent.MouseButtonRelease, left, none)]
    for kind, button, buttons in kinds:
        event = QtGui.QMouseEvent(kind, point, scene, button, buttons, QtCore.Qt.NoModifier)
        QtCore.QCoreApplication.postEvent(widget, event)


def key(widget: Any, code: Any, text: str = "", modifiers: Any = QtCore.Qt.NoModifier) -> None:
    """A key pressed and released."""
    for kind in (QtCore.QEvent.KeyPress, QtCore.QEvent.KeyRelease):
        QtCore.QCoreApplication.postEvent(widget, QtGui.QKeyEvent(kind, code, modifiers, text))


def _edit_of(widget: Any) -> Any:
    return widget if isinstance(widget, QtWidgets.QLineEdit) else widget.findChild(QtWidgets.QLineEdit)


def focused(widget: Any) -> Until:
    """Waits until the keys go to a line of text or a spin box."""
    edit = _edit_of(widget)

    def is_focused() -> bool:
        if not edit.hasFocus():
            edit.window().activateWindow()
            edit.setFocus()
        return bool(edit.hasFocus())

    return until(is_focused, f"keys for {widget.objectName()}")


def write(widget: Any, text: str) -> None:
    """Text typed over what stands in a line of text or a spin box that is `focused`, and left with the tab key."""
    edit = _edit_of(widget)
    edit.selectAll()
    for letter in text:
        key(edit, QtCore.Qt.Key(ord(letter.upper())), letter)
    key(edit, QtCore.Qt.Key_Tab, "\t")


def choose(combo: Any, text: str) -> None:
    """An entry of a combo box, reached by its arrow keys."""
    index = combo.findText(text)
    if index < 0:
        raise LookupError(f"{text} is none of {[combo.itemText(i) for i in range(combo.count())]}")
    combo.setFocus()
    steps = index - combo.currentIndex()
    for _ in range(abs(steps)):
        key(combo, QtCore.Qt.Key_Down if steps > 0 else QtCore.Qt.Key_Up)


def later(action: Callable[[], Any]) -> None:
    """Calls something from the event loop, so that it may open dialogs."""
    QtCore.QTimer.singleShot(0, action)


def view() -> Any:
    """The 3-D view in front."""
    return FreeCADGui.ActiveDocument.ActiveView


def viewport() -> Any:
    """The widget that shows the 3-D view in front."""
    area = main_window().findChild(QtWidgets.QMdiArea)
    return area.activeSubWindow().findChild(QtWidgets.QGraphicsView).viewport()


def click_in_view(point: Any) -> None:
    """A click on a point of space (FreeCAD.Vector) as the view shows it."""
    x, y = view().getPointOnViewport(point)
    widget = viewport()
    scale = widget.devicePixelRatioF()
    click(widget, QtCore.QPointF(x / scale, widget.height() - y / scale))


# --- pictures and results ----------------------------------------------------------------------------------------


def shot(name: str, widget: Any = None) -> str:
    """A picture of the screen, or of the part of it that a widget covers, as FOLDER/name.png."""
    picture = QtWidgets.QApplication.primaryScreen().grabWindow(0)
    if widget is not None:
        corner = widget.mapToGlobal(QtCore.QPoint(0, 0))
        picture = picture.copy(QtCore.QRect(corner, widget.size()))
    path = FOLDER / f"{name}.png"
    picture.save(str(path))
    return str(path)


def report_view() -> str:
    """What stands in FreeCAD's report view."""
    found = main_window().findChildren(QtWidgets.QTextEdit, "Report view")
    return "\n".join(widget.toPlainText() for widget in found)


class Runner:
    """Runs scenarios one after the other, each as far as it gets."""

    def __init__(self, scenarios: dict[str, Scenario]) -> None:
        self._left = list(scenarios.items())
        self._name = ""
        self._steps: Generator[Any, None, Any] | None = None
        self._waiting: Until | None = None
        self._since = 0.0
        self._timer = QtCore.QTimer()
        self._timer.setInterval(POLLED)
        self._timer.timeout.connect(self._turn)
        self._timer.start()

    def _turn(self) -> None:
        try:
            self._advance()
        except BaseException:
            self._finish({"broke": traceback.format_exc(), "shot": shot(f"broke-{_file_name(self._name)}")})

    def _advance(self) -> None:
        if self._steps is None:
            if not self._left:
                self._end()
            self._name, scenario = self._left.pop(0)
            self._steps = scenario()
        elif self._waiting is not None and not self._waiting.condition():
            if time.monotonic() - self._since > self._waiting.seconds:
                waiting, self._waiting = self._waiting, None
                self._steps.throw(TimeoutError(f"after {waiting.seconds:g} s not yet: {waiting.what}"))
            return
        try:
            wanted = next(self._steps)
        except StopIteration as end:
            self._finish(end.value)
            return
        self._waiting = wanted if isinstance(wanted, Until) else None
        self._since = time.monotonic()

    def _finish(self, result: Any) -> None:
        self._steps, self._waiting = None, None
        with (FOLDER / "results.jsonl").open("a", encoding="utf-8") as file:
            file.write(json.dumps([self._name, result]) + "\n")
        close_all()

    def _end(self) -> None:
        self._timer.stop()
        (FOLDER / "report_view.txt").write_text(report_view(), encoding="utf-8")
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(0)


def close_all() -> None:
    """Closes dialogs, panels and documents, so that the next scenario starts as the first one did."""
    while QtWidgets.QApplication.activeModalWidget():
        QtWidgets.QApplication.activeModalWidget().close()
    if FreeCADGui.ActiveDocument and FreeCADGui.ActiveDocument.getInEdit():
        FreeCADGui.ActiveDocument.resetEdit()
    if FreeCADGui.Control.activeDialog():
        FreeCADGui.Control.closeDialog()
    FreeCADGui.Selection.clearSelection()
    for name in list(FreeCAD.listDocuments()):
        FreeCAD.closeDocument(name)


def _file_name(name: str) -> str:
    return "".join(letter if letter.isalnum() else "-" for letter in name)


class _Both:
    """A stream that is also kept in a file: FreeCAD shows errors in a view, the tests read them."""

    def __init__(self, stream: Any, path: Path) -> None:
        self._stream, self._file = stream, path.open("w", encoding="utf-8")

    def write(self, text: str) -> None:
        self._file.write(text)
        self._file.flush()
        self._stream.write(text)

    def flush(self) -> None:
        self._stream.flush()


def run(scenarios: dict[str, Scenario]) -> None:
    """Runs those that the arguments name, or all."""
    chosen = [name for name in os.environ["STYLUSCAM_TEST_ARGUMENTS"].splitlines() if name]
    sys.stderr = _Both(sys.stderr, FOLDER / "stderr.txt")
    wanted = {name: scenario for name, scenario in scenarios.items() if not chosen or name in chosen}
    sys.modules[__name__].runner = Runner(wanted)  # kept: a timer dies with its owner
