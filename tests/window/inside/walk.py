"""Looks at every visible widget of a panel: whether texts fit, widgets lie beside each other, and texts stand out.

    findings = walk.findings(panel)

With PySide2 (FreeCAD 1.0) one panel a session, and nothing of it may be deleted before the last look: what Python holds of
deleted widgets is taken for the next ones at the same addresses.

Text is measured where it is drawn, scrolled out or not: the colour that lies farthest from the background counts as its.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from itertools import combinations
from typing import Any

from PySide import QtCore, QtGui, QtWidgets

LEAST_CONTRAST = 4.5
"""WCAG 2.1 (1.4.3) for text of ordinary size."""

EDGE = 3
"""Pixels at the left edge of a panel that no widget covers."""

SLACK = 1
"""Pixels that a text may be short of, and widgets may overlap by: rounding of scaled fonts."""

WHOLE = (
    QtWidgets.QAbstractScrollArea,
    QtWidgets.QAbstractSpinBox,
    QtWidgets.QComboBox,
    QtWidgets.QLineEdit,
    QtWidgets.QTabBar,
    QtWidgets.QMenu,
)
"""Widgets whose parts Qt arranges."""

LEAVES = (*WHOLE, QtWidgets.QLabel, QtWidgets.QAbstractButton)
"""Those into which nobody looks."""

VIEWPORT = "qt_scrollarea_viewport"
"""Qt's name of what holds a scroll area's content, and cuts it off."""

TEXTS = (
    QtWidgets.QLabel,
    QtWidgets.QAbstractButton,
    QtWidgets.QComboBox,
    QtWidgets.QGroupBox,
    QtWidgets.QAbstractSpinBox,
    QtWidgets.QLineEdit,
)
"""Widgets with a text that must be legible."""


def findings(panel: Any) -> list[str]:
    """What is wrong with a panel's widgets, a line each; nothing where all is well."""
    widgets = list(_visible(panel))
    picture = _picture(panel)
    found = [line for widget, parent in widgets for line in (*_short(widget), *_outside(widget, parent))]
    found += [line for widget, _ in widgets for line in _overlaps(widget)]
    found += [line for widget, _ in widgets for line in _faint(widget, picture, panel)]
    return found


def count(panel: Any) -> int:
    """How many widgets with text are looked at."""
    return sum(isinstance(widget, TEXTS) for widget, _ in _visible(panel))


def _visible(widget: Any, parent: Any = None) -> Iterator[tuple[Any, Any]]:
    """The visible widgets of a panel, each with the one that holds it; what Qt arranges itself is not opened."""
    if not widget.isVisible():
        return
    yield widget, parent
    if isinstance(widget, LEAVES) and not isinstance(widget, QtWidgets.QScrollArea):
        return
    for child in _children(widget):
        yield from _visible(child, widget)


def _children(widget: Any) -> list[Any]:
    """A widget's own children that are shown."""
    found = [child for child in widget.children() if isinstance(child, QtWidgets.QWidget)]
    return [child for child in found if child.isVisible() and not child.isWindow()]


def _named(widget: Any) -> str:
    text = _text(widget)
    shown = f" {text[:40]!r}" if text else ""
    return f"{type(widget).__name__} {widget.objectName()}{shown}"


def _text(widget: Any) -> str:
    for name in ("currentText", "title", "text"):
        getter = getattr(widget, name, None)
        if callable(getter):
            return str(getter())
    return ""


# --- sizes -----------------------------------------------------------------------------------------------------------


def _short(widget: Any) -> Iterator[str]:
    """Where a text has less room than it needs."""
    needed = _needed(widget)
    if needed is None:
        return
    for what, need, has in (("width", needed[0], widget.width()), ("height", needed[1], widget.height())):
        if need > has + SLACK:
            yield f"{_named(widget)}: its text needs {need} pixels of {what} and has {has}"


def _needed(widget: Any) -> tuple[int, int] | None:
    """Width and height that a widget needs for its text; None where it has none."""
    if not _text(widget):
        return None
    hint = widget.sizeHint()
    if isinstance(widget, QtWidgets.QLabel):
        if widget.wordWrap():
            return 0, widget.heightForWidth(widget.width())
        return hint.width(), hint.height()
    if isinstance(widget, QtWidgets.QAbstractButton):
        return widget.minimumSizeHint().width(), widget.minimumSizeHint().height()
    metrics = widget.fontMetrics()
    width = metrics.boundingRect(_text(widget).replace("&", "")).width()
    if isinstance(widget, QtWidgets.QGroupBox):
        return width, 0
    if isinstance(widget, QtWidgets.QComboBox):
        return width + widget.width() - _area(widget).width(), metrics.height()
    if isinstance(widget, QtWidgets.QAbstractSpinBox):
        return width + widget.width() - _area(widget).width(), metrics.height()
    return None


def _outside(widget: Any, parent: Any) -> Iterator[str]:
    """Where a widget ends outside the one that holds it, and is cut off."""
    if parent is None or isinstance(parent, QtWidgets.QAbstractScrollArea) or parent.objectName() == VIEWPORT:
        return
    if not parent.rect().adjusted(-SLACK, -SLACK, SLACK, SLACK).contains(widget.geometry()):
        yield f"{_named(widget)}: reaches out of {_named(parent)}, at {widget.geometry().getRect()} of {parent.size().toTuple()}"


def _overlaps(parent: Any) -> Iterator[str]:
    """Children that lie over each other."""
    if isinstance(parent, (*LEAVES, QtWidgets.QStackedWidget)):
        return
    shown = [child for child in _children(parent) if child.width() and child.height()]
    for one, other in combinations(shown, 2):
        common = one.geometry().intersected(other.geometry())
        if common.width() > SLACK and common.height() > SLACK:
            yield f"{_named(one)} and {_named(other)} overlap by {common.width()} x {common.height()} pixels"


# --- colours ---------------------------------------------------------------------------------------------------------


def _picture(panel: Any) -> Any:
    """All of a panel, drawn, scrolled out or not, over the colour that the screen shows at its left edge.

    No widget around the panel is asked for: FreeCAD deletes them, and Python would take what is left of them for others.
    """
    shown = QtWidgets.QApplication.primaryScreen().grabWindow(0).toImage()
    scale = shown.devicePixelRatio()
    visible = panel.visibleRegion().boundingRect()
    picture = QtGui.QImage(panel.size() * scale, QtGui.QImage.Format_RGB32)
    picture.setDevicePixelRatio(scale)
    edge = QtCore.QSize(EDGE, visible.height())
    area = QtCore.QRect(panel.mapToGlobal(visible.topLeft()) * scale, edge * scale)
    picture.fill(QtGui.QColor.fromRgb(_colours(shown, area).most_common(1)[0][0]))
    panel.render(picture, QtCore.QPoint(), QtGui.QRegion(), QtWidgets.QWidget.DrawChildren)
    return picture


def _area_in(area: Any, widget: Any, outer: Any, scale: float) -> Any:
    """A part of a widget as pixels of a picture of one around it."""
    return QtCore.QRect(widget.mapTo(outer, area.topLeft()) * scale, area.size() * scale)


def _colours(picture: Any, area: Any) -> Counter[int]:
    """How often each colour 0xrrggbb stands in a part of a picture."""
    area = area.intersected(picture.rect())
    columns, rows = range(area.left(), area.right() + 1), range(area.top(), area.bottom() + 1)
    return Counter(picture.pixel(x, y) & 0xFFFFFF for x in columns for y in rows)


def _faint(widget: Any, picture: Any, panel: Any) -> Iterator[str]:
    """Where a text stands out too little; what is switched off may."""
    if not isinstance(widget, TEXTS) or not widget.isEnabled() or not _text(widget).strip():
        return
    colours = _colours(picture, _area_in(_area(widget), widget, panel, picture.devicePixelRatio()))
    if not colours:
        return
    ((background, _),) = colours.most_common(1)
    contrast = max(_contrast(background, colour) for colour in colours)
    if contrast < LEAST_CONTRAST:
        yield f"{_named(widget)}: contrast {contrast:.1f} of its text on #{background:06x}, below {LEAST_CONTRAST}"


def _area(widget: Any) -> Any:
    """Where the text of a widget is drawn."""
    style = widget.style()
    elements = QtWidgets.QStyle
    if isinstance(widget, QtWidgets.QCheckBox):
        option = QtWidgets.QStyleOptionButton()
        widget.initStyleOption(option)
        return style.subElementRect(elements.SE_CheckBoxContents, option, widget)
    if isinstance(widget, QtWidgets.QComboBox):
        option = QtWidgets.QStyleOptionComboBox()
        widget.initStyleOption(option)
        return style.subControlRect(elements.CC_ComboBox, option, elements.SC_ComboBoxEditField, widget)
    if isinstance(widget, QtWidgets.QGroupBox):
        option = QtWidgets.QStyleOptionGroupBox()
        widget.initStyleOption(option)
        return style.subControlRect(elements.CC_GroupBox, option, elements.SC_GroupBoxLabel, widget)
    if isinstance(widget, QtWidgets.QAbstractSpinBox):
        option = QtWidgets.QStyleOptionSpinBox()
        widget.initStyleOption(option)
        return style.subControlRect(elements.CC_SpinBox, option, elements.SC_SpinBoxEditField, widget)
    return widget.rect().adjusted(3, 3, -3, -3) if isinstance(widget, QtWidgets.QAbstractButton) else widget.rect()


def _contrast(one: int, other: int) -> float:
    """WCAG's ratio of contrast of two colours 0xrrggbb, 1 to 21."""
    low, high = sorted((_luminance(one), _luminance(other)))
    return (high + 0.05) / (low + 0.05)


def _luminance(colour: int) -> float:
    parts = [(colour >> shift & 0xFF) / 255 for shift in (16, 8, 0)]
    linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
    return sum(weight * part for weight, part in zip((0.2126, 0.7152, 0.0722), linear, strict=True))
