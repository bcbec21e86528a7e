# SPDX-License-Identifier: LGPL-2.1-or-later
"""Small diagrams by QPainter: axes with readable numbers, curves, and the values under the mouse."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from PySide import QtCore, QtGui

from .tool_curves import Series, between

LEGIBLE = 4.5
"""Least contrast of text (WCAG 2.1, success criterion 1.4.3)."""

DECADES = 30.0
"""From this ratio of values on, an axis is logarithmic."""

LINES = (QtCore.Qt.PenStyle.SolidLine, QtCore.Qt.PenStyle.DashLine, QtCore.Qt.PenStyle.DotLine)
"""Curves of one diagram differ in their line as well as in their label."""


def luminance(color: Any) -> float:
    """Relative luminance of a QColor, 0 to 1 (WCAG 2.1)."""
    parts = [color.redF(), color.greenF(), color.blueF()]
    linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(a: Any, b: Any) -> float:
    """Contrast of two QColors, 1 to 21 (WCAG 2.1)."""
    low, high = sorted((luminance(a), luminance(b)))
    return (high + 0.05) / (low + 0.05)


@dataclass(frozen=True)
class Colors:
    """Colours that can be read on a widget's background, light or dark."""

    background: Any
    text: Any
    faint: Any
    accent: Any
    fill: Any

    @classmethod
    def of(cls, widget: Any) -> Colors:
        """Those of a widget's palette; black on white where the palette itself cannot be read."""
        palette, role = widget.palette(), QtGui.QPalette.ColorRole
        background, text = palette.color(role.Window), palette.color(role.WindowText)
        if contrast(background, text) < LEGIBLE:
            background, text = QtGui.QColor("#ffffff"), QtGui.QColor("#000000")
        is_dark = luminance(background) < 0.18
        accent = QtGui.QColor("#7ab8ff" if is_dark else "#0b5cad")
        faint, fill = QtGui.QColor(text), QtGui.QColor(accent)
        faint.setAlphaF(0.35)
        fill.setAlphaF(0.22)
        return cls(background, text, faint, accent, fill)


@dataclass(frozen=True)
class Axis:
    """Numbers along a side of a diagram."""

    low: float
    high: float
    is_log: bool

    @classmethod
    def over(cls, values: Iterable[float], *, from_zero: bool = False) -> Axis:
        """From the least to the greatest value, or from zero."""
        found = [value for value in values if math.isfinite(value)]
        low, high = (min(found), max(found)) if found else (0.0, 1.0)
        if low > 0.0 and high / low > DECADES and not from_zero:
            return cls(low, high, True)
        low = 0.0 if from_zero else low
        if high - low <= 1e-6 * max(abs(high), 1e-9):
            low, high = low - 0.1 * abs(low) - 1e-6, high + 0.1 * abs(high) + 1e-6
        return cls(low, high, False)

    def share(self, value: float) -> float:
        """Where a value lies: 0 at the low end, 1 at the high one."""
        if self.is_log:
            return math.log(max(value, 1e-300) / self.low) / math.log(self.high / self.low)
        return (value - self.low) / (self.high - self.low)

    def value(self, share: float) -> float:
        """The value at a share."""
        if self.is_log:
            return self.low * (self.high / self.low) ** share
        return self.low + share * (self.high - self.low)

    def ticks(self, most: int) -> list[float]:
        """Round values, no more than `most`."""
        if self.is_log:
            first, last = math.floor(math.log10(self.low)), math.ceil(math.log10(self.high))
            factors = (1.0,) if last - first > most else (1.0, 3.0)
            found = [factor * 10.0**power for power in range(first, last + 1) for factor in factors]
            return [tick for tick in found if self.low * 0.999 <= tick <= self.high * 1.001]
        raw = (self.high - self.low) / max(most, 1)
        power = 10.0 ** math.floor(math.log10(raw))
        step = next(factor * power for factor in (1.0, 2.0, 5.0, 10.0) if factor * power >= raw * 0.999)
        first = math.ceil(self.low / step - 1e-9)
        count = math.floor(self.high / step + 1e-9) - first
        return [(first + number) * step for number in range(count + 1)]


@dataclass
class Plot:
    """A diagram: titles with units, curves, and where it lies on the widget once it is painted."""

    title: str
    x_title: str
    y_title: str
    from_zero: bool = False
    """Whether x begins at 0."""
    series: list[Series] = field(default_factory=list)
    _inside: Any = field(default_factory=QtCore.QRectF)
    _x: Axis = field(default_factory=lambda: Axis(0.0, 1.0, False))
    _y: Axis = field(default_factory=lambda: Axis(0.0, 1.0, False))

    def paint(self, painter: Any, rect: Any, colors: Colors, mouse: Any) -> None:
        """Paints it into a rectangle; `mouse` is where values are read, or None."""
        metrics = painter.fontMetrics()
        line = metrics.height()
        self._x = Axis.over((x for one in self.series for x in one.x), from_zero=self.from_zero)
        self._y = Axis.over(y for one in self.series for y in one.y)
        left = max((metrics.horizontalAdvance(_number(tick)) for tick in self._y.ticks(4)), default=20) + 8
        self._inside = QtCore.QRectF(rect).adjusted(left, line + 6, -line, -2.4 * line)
        painter.setPen(colors.text)
        head = QtCore.QRectF(rect.left(), rect.top(), rect.width(), line + 4)
        painter.drawText(head, int(QtCore.Qt.AlignmentFlag.AlignLeft), f"{self.title} ({self.y_title})")
        if not any(self.series):
            return
        self._paint_axes(painter, rect, colors)
        painter.save()
        painter.setClipRect(self._inside.adjusted(-1, -1, 1, 1))
        for number, one in enumerate(self.series):
            pen = QtGui.QPen(colors.accent, 1.8)
            pen.setStyle(LINES[number % len(LINES)])
            painter.setPen(pen)
            points = [self._at(x, y) for x, y in zip(one.x, one.y, strict=True)]
            painter.drawPolyline(QtGui.QPolygonF(points))
        painter.restore()
        self._paint_labels(painter, colors, line)
        if mouse is not None and self._inside.contains(mouse):
            self._paint_reading(painter, colors, mouse, line)

    def _at(self, x: float, y: float) -> Any:
        inside = self._inside
        return QtCore.QPointF(
            inside.left() + self._x.share(x) * inside.width(), inside.bottom() - self._y.share(y) * inside.height()
        )

    def _paint_axes(self, painter: Any, rect: Any, colors: Colors) -> None:
        inside, line = self._inside, painter.fontMetrics().height()
        flags = QtCore.Qt.AlignmentFlag
        for tick in self._y.ticks(4):
            y = self._at(self._x.low, tick).y()
            painter.setPen(colors.faint)
            painter.drawLine(QtCore.QLineF(inside.left(), y, inside.right(), y))
            painter.setPen(colors.text)
            where = QtCore.QRectF(rect.left(), y - line / 2, inside.left() - rect.left() - 4, line)
            painter.drawText(where, int(flags.AlignRight | flags.AlignVCenter), _number(tick))
        for tick in self._x.ticks(5):
            x = self._at(tick, self._y.low).x()
            painter.setPen(colors.faint)
            painter.drawLine(QtCore.QLineF(x, inside.top(), x, inside.bottom()))
            painter.setPen(colors.text)
            where = QtCore.QRectF(x - 40, inside.bottom() + 2, 80, line)
            painter.drawText(where, int(flags.AlignHCenter), _number(tick))
        where = QtCore.QRectF(inside.left(), inside.bottom() + line + 2, inside.width(), line + 2)
        painter.drawText(where, int(flags.AlignHCenter), self.x_title)

    def _paint_labels(self, painter: Any, colors: Colors, line: int) -> None:
        """Each curve's label with a piece of its line, in the corner where curves that rise leave space."""
        labelled = [(number, one) for number, one in enumerate(self.series) if one.label]
        widest = max((painter.fontMetrics().horizontalAdvance(one.label) for _, one in labelled), default=0)
        if labelled:
            box = QtCore.QRectF(self._inside.left() + 1, self._inside.top() + 1, widest + 44, len(labelled) * line + 3)
            painter.fillRect(box, colors.background)
        for row, (number, one) in enumerate(labelled):
            y = self._inside.top() + 2 + (row + 0.5) * line
            pen = QtGui.QPen(colors.accent, 1.8)
            pen.setStyle(LINES[number % len(LINES)])
            painter.setPen(pen)
            painter.drawLine(QtCore.QLineF(self._inside.left() + 6, y, self._inside.left() + 34, y))
            painter.setPen(colors.text)
            painter.drawText(QtCore.QPointF(self._inside.left() + 40, y + line * 0.3), one.label)

    def _paint_reading(self, painter: Any, colors: Colors, mouse: Any, line: int) -> None:
        """The values at the mouse's x."""
        inside = self._inside
        x = self._x.value((mouse.x() - inside.left()) / inside.width())
        read = [(one, between(one, x)) for one in self.series]
        texts = [f"{one.label + ': ' if one.label else ''}{y:.4g}" for one, y in read if y is not None]
        text = f"{x:.4g} → " + ", ".join(texts) if texts else f"{x:.4g}"
        painter.setPen(colors.faint)
        painter.drawLine(QtCore.QLineF(mouse.x(), inside.top(), mouse.x(), inside.bottom()))
        width = painter.fontMetrics().horizontalAdvance(text) + 10
        left = min(max(mouse.x() - width / 2, inside.left()), inside.right() - width)
        box = QtCore.QRectF(left, inside.bottom() - line - 6, width, line + 4)
        painter.fillRect(box, colors.background)
        painter.setPen(colors.text)
        painter.drawRect(box)
        painter.drawText(box, int(QtCore.Qt.AlignmentFlag.AlignCenter), text)


def _number(value: float) -> str:
    return f"{value:.4g}" if abs(value) > 1e-12 else "0"
