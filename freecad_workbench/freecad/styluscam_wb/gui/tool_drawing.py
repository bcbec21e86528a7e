# SPDX-License-Identifier: LGPL-2.1-or-later
"""The drawing of a tool: its meridian with axis, base and shank to scale, and two diagrams of what it does to a surface."""

from __future__ import annotations

from typing import Any

from PySide import QtCore, QtGui, QtWidgets

from .messages import translated
from .plots import Colors, Plot
from .tool_curves import Curves

MERIDIAN_HEIGHT, PLOT_HEIGHT = 200, 140
"""Heights (pixels) of the parts where they stand one above the other."""

SIDE_BY_SIDE = 360
"""Width (pixels) from which the diagrams stand beside the meridian."""

MERIDIAN_SHARE = 0.45
"""The meridian's part of the width there."""

STALE = 0.35
"""Opacity of the last shape while what is typed makes none."""

GAP = 8

BESIDE, BELOW, ABOVE = 66, 34, 12
"""Pixels beside the section for its height, below it for its diameter, above it for the axis."""


class ToolDrawing(QtWidgets.QWidget):
    """Follows the curves that it is given; values are read under the mouse."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("StylusCAM_ToolDrawing")
        self.setMinimumSize(160, 2 * PLOT_HEIGHT + GAP)
        self.setMouseTracking(True)
        self.curves: Curves | None = None
        self.is_stale = False
        self._mouse: Any = None
        self._curvature = Plot(translated("Radius of curvature"), translated("slope of the surface, °"), "mm", True)
        self._scallop = Plot(
            translated("Scallop height by wall angle"), translated("stepover along the wall, mm"), "mm"
        )

    def show_curves(self, curves: Curves) -> None:
        """Draws a tool."""
        self.curves, self.is_stale = curves, False
        self._curvature.series = [curves.curvature] if len(curves.curvature.x) > 1 else []
        self._scallop.series = curves.scallops
        self.update()

    def show_stale(self) -> None:
        """Fades the last tool: what is typed makes none."""
        self.is_stale = True
        self.update()

    def resizeEvent(self, event: Any) -> None:
        """A narrow one is high."""
        beside = 0 if self.width() >= SIDE_BY_SIDE else MERIDIAN_HEIGHT + GAP
        self.setMinimumHeight(2 * PLOT_HEIGHT + GAP + beside)

    def mouseMoveEvent(self, event: Any) -> None:
        """Values are read where the mouse is."""
        self._mouse = QtCore.QPointF(event.pos())
        self.update()

    def leaveEvent(self, event: Any) -> None:
        """No values are read."""
        self._mouse = None
        self.update()

    def paintEvent(self, event: Any) -> None:
        """Paints all of it."""
        painter = QtGui.QPainter(self)
        painter.setRenderHint(QtGui.QPainter.RenderHint.Antialiasing)
        colors = Colors.of(self)
        painter.fillRect(self.rect(), colors.background)
        if self.curves is not None:
            painter.setOpacity(STALE if self.is_stale else 1.0)
            meridian, curvature, scallop = self._parts()
            _Meridian(self.curves, meridian, colors).paint(painter)
            self._curvature.paint(painter, curvature, colors, self._mouse)
            self._scallop.paint(painter, scallop, colors, self._mouse)
        painter.end()

    def _parts(self) -> list[Any]:
        """Rectangles of meridian and diagrams."""
        width, height = self.width(), self.height()
        if width >= SIDE_BY_SIDE:
            left, half = MERIDIAN_SHARE * width, (height - GAP) / 2.0
            meridian = QtCore.QRectF(0, 0, left, height)
            plots = [QtCore.QRectF(left + GAP, top, width - left - GAP, half) for top in (0, half + GAP)]
        else:
            meridian = QtCore.QRectF(0, 0, width, height - 2 * (PLOT_HEIGHT + GAP))
            tops = [height - 2 * PLOT_HEIGHT - GAP, height - PLOT_HEIGHT]
            plots = [QtCore.QRectF(0, top, width, PLOT_HEIGHT) for top in tops]
        return [meridian, *plots]


class _Meridian:
    """The tool's section to scale, with diameter and height."""

    def __init__(self, curves: Curves, rect: Any, colors: Colors) -> None:
        self._curves, self._rect, self._colors = curves, rect, colors
        widest = max(curves.diameter, curves.shank)
        self._top = curves.above[-1][1]
        self._scale = min((rect.width() - BESIDE) / widest, (rect.height() - BELOW - ABOVE) / self._top)
        self._center = (
            rect.left() + 4 + self._scale * widest / 2.0 + max(0.0, rect.width() - BESIDE - widest * self._scale) / 2.0
        )
        unused = rect.height() - BELOW - ABOVE - self._scale * self._top
        self._bottom = rect.bottom() - BELOW - unused / 2.0

    def paint(self, painter: Any) -> None:
        """Section, axis, dimensions."""
        curves, colors = self._curves, self._colors
        right = [*curves.profile, *curves.above[1:]]
        outline = [*((-r, z) for r, z in reversed(right)), *right]
        painter.setPen(QtCore.Qt.PenStyle.NoPen)
        painter.setBrush(colors.fill)
        painter.drawPolygon(self._polygon(outline))
        painter.setBrush(QtCore.Qt.BrushStyle.NoBrush)
        for side in (-1.0, 1.0):
            painter.setPen(QtGui.QPen(colors.text, 1.2))
            painter.drawPolyline(self._polygon([(side * r, z) for r, z in curves.above]))
            painter.setPen(QtGui.QPen(colors.accent, 2.4))
            painter.drawPolyline(self._polygon([(side * r, z) for r, z in curves.profile]))
        axis = QtGui.QPen(colors.text, 1.0)
        axis.setStyle(QtCore.Qt.PenStyle.DashDotLine)
        painter.setPen(axis)
        painter.drawLine(QtCore.QLineF(self._at(0.0, -8.0 / self._scale), self._at(0.0, self._top + 6.0 / self._scale)))
        self._paint_dimensions(painter)

    def _paint_dimensions(self, painter: Any) -> None:
        curves, line = self._curves, painter.fontMetrics().height()
        flags = QtCore.Qt.AlignmentFlag
        half = curves.diameter / 2.0
        painter.setPen(QtGui.QPen(self._colors.text, 1.0))
        low = self._bottom + 10
        left, right = self._at(-half, 0.0).x(), self._at(half, 0.0).x()
        painter.drawLine(QtCore.QLineF(left, low, right, low))
        for x in (left, right):
            painter.drawLine(QtCore.QLineF(x, low - 4, x, low + 4))
        where = QtCore.QRectF(self._rect.left(), low + 2, 2 * (self._center - self._rect.left()), line + 2)
        painter.drawText(where, int(flags.AlignHCenter), f"⌀ {curves.diameter:.5g} mm")
        side = self._at(max(half, curves.shank / 2.0), 0.0).x() + 10
        bottom, top = self._at(0.0, 0.0).y(), self._at(0.0, curves.height).y()
        painter.drawLine(QtCore.QLineF(side, bottom, side, top))
        for y in (bottom, top):
            painter.drawLine(QtCore.QLineF(side - 4, y, side + 4, y))
        middle = 0.5 * (bottom + top) - line / 2
        painter.drawText(QtCore.QRectF(side + 6, middle, 120, line + 2), int(flags.AlignLeft), f"{curves.height:.5g}")

    def _at(self, radius: float, height: float) -> Any:
        return QtCore.QPointF(self._center + radius * self._scale, self._bottom - height * self._scale)

    def _polygon(self, points: list[tuple[float, float]]) -> Any:
        return QtGui.QPolygonF([self._at(r, z) for r, z in points])
