# SPDX-License-Identifier: LGPL-2.1-or-later
"""Every icon of the addon at the sizes that FreeCAD shows, on a light and on a dark panel, as one picture.

    QT_QPA_PLATFORM=offscreen python3 icon_sheet.py SHEET.png

Drawn by Qt, as FreeCAD does it: any Python with PySide6 will do. The last two columns are the 16 pixels enlarged.
"""

from __future__ import annotations

import sys
from pathlib import Path

from PySide6 import QtCore, QtGui, QtSvg

RESOURCES = Path(__file__).resolve().parents[1] / "freecad" / "styluscam_wb" / "resources"

SIZES = (16, 24, 64)
"""Pixels."""

PANELS = {"#f0f0f0": "#202020", "#2b2b2b": "#e6e6e6"}
"""Colours of panels, and of the names on them."""

ENLARGED = 4
"""How many times the smallest size is enlarged."""

ROW, GAP, NAME = 72, 8, 150
"""Height of a row, space between pictures, width of the names; pixels."""

COLUMNS = 2
"""Icons side by side."""


def icon(path: Path, size: int) -> QtGui.QImage:
    """An icon with its background left open."""
    image = QtGui.QImage(size, size, QtGui.QImage.Format_ARGB32_Premultiplied)
    image.fill(QtCore.Qt.transparent)
    painter = QtGui.QPainter(image)
    QtSvg.QSvgRenderer(str(path)).render(painter)
    painter.end()
    return image


def panel_width() -> int:
    """Width of one icon's pictures on one panel."""
    return sum(SIZES) + SIZES[0] * ENLARGED + GAP * (len(SIZES) + 2)


def draw(painter: QtGui.QPainter, path: Path, left: int, top: int) -> None:
    """One icon's pictures on all panels, its name beside them."""
    painter.setPen(QtGui.QColor(next(iter(PANELS.values()))))
    painter.drawText(QtCore.QRect(left, top, NAME, ROW), QtCore.Qt.AlignVCenter, path.stem)
    left += NAME
    for colour in PANELS:
        painter.fillRect(left, top, panel_width(), ROW, QtGui.QColor(colour))
        at = left + GAP
        pictures = [icon(path, size) for size in SIZES]
        side = SIZES[0] * ENLARGED
        pictures.append(pictures[0].scaled(side, side, QtCore.Qt.IgnoreAspectRatio, QtCore.Qt.FastTransformation))
        for picture in pictures:
            painter.drawImage(at, top + (ROW - picture.height()) // 2, picture)
            at += picture.width() + GAP
        left += panel_width()


def sheet(paths: list[Path]) -> QtGui.QImage:
    """All of them."""
    rows = -(-len(paths) // COLUMNS)
    width = NAME + panel_width() * len(PANELS) + GAP
    image = QtGui.QImage(width * COLUMNS + GAP, rows * ROW + 2 * GAP, QtGui.QImage.Format_RGB32)
    image.fill(QtGui.QColor(next(iter(PANELS))))
    painter = QtGui.QPainter(image)
    for number, path in enumerate(paths):
        column, row = divmod(number, rows)
        draw(painter, path, GAP + column * width, GAP + row * ROW)
    painter.end()
    return image


def main(arguments: list[str]) -> int:
    """Writes the picture."""
    if len(arguments) != 1:
        print("usage: icon_sheet.py SHEET.png", file=sys.stderr)
        return 2
    application = QtGui.QGuiApplication([])
    paths = [*RESOURCES.glob("*.svg"), *sorted((RESOURCES / "icons").rglob("*.svg"))]
    written = sheet(paths).save(arguments[0])
    application.quit()
    return 0 if written else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
