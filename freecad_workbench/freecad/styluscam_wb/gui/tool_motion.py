# SPDX-License-Identifier: LGPL-2.1-or-later
"""The commands "Move tool", whose panel moves the tool along an operation's path, and "Simulate", FreeCAD's own simulator."""

from __future__ import annotations

from typing import Any

import FreeCADGui
import numpy as np
from pivy import coin
from PySide import QtCore, QtWidgets

from .. import motion_track
from ..motion_track import MotionTrack
from . import chosen, pictures, scene
from .command import Command
from .messages import translated

KEY = "tool"

COLOUR: scene.Colour = (0xFC, 0xAF, 0x3E)

TRANSPARENCY = 0.35

FINE = 0.02
"""Deviation of the drawn tool, mm."""

STEPS = 10_000
"""Of the slider."""

DECIMALS = 3
"""Of a time (s) or a length (mm)."""

FRAME = 30
"""Milliseconds between two positions of a moving tool."""

FASTEST = 1000
"""Times the machine's own speed."""

MIDDLE_SPEED = 10

BY_TIME, BY_LENGTH = 0, 1


class MovingTool:
    """The solid of a tool bit as a picture that can be moved."""

    def __init__(self, job: Any, operation: Any) -> None:
        self._place = coin.SoTranslation()
        bit = operation.ToolController.Tool
        shape = bit.Shape.copy()
        shape.Placement = type(shape.Placement)()
        points, triangles = shape.tessellate(FINE)
        corners = np.array([(point.x, point.y, point.z) for point in points])
        solid = scene.solid(corners, np.array(triangles), COLOUR, TRANSPARENCY)
        node = scene.separator("StylusCAM_Tool", self._place, *solid)
        pictures.show(pictures.Picture(job.Document.Name, KEY, node, hidden=[bit]))

    def move(self, tip: tuple[float, float, float]) -> None:
        """Its tip to a position."""
        self._place.translation.setValue(*tip)


class MotionPanel:
    """Slider, number, play and stop; the task view shows its `form`."""

    def __init__(self, job: Any, operation: Any, track: MotionTrack) -> None:
        self._document, self._track = str(job.Document.Name), track
        self._tool = MovingTool(job, operation)
        self._timer = QtCore.QTimer()
        self._timer.setInterval(FRAME)
        self._timer.timeout.connect(self._advance)
        self._clock = QtCore.QElapsedTimer()
        self.form = QtWidgets.QWidget()
        self.form.setObjectName("StylusCAM_ToolMotion")
        self.form.setWindowTitle(f"{translated('Tool along')} {operation.Label}")
        self._build()
        self._choose_measure(BY_TIME)

    def _build(self) -> None:
        self._measure = QtWidgets.QComboBox()
        self._measure.addItems([translated("by time, s"), translated("by length, mm")])
        self._slider = QtWidgets.QSlider(QtCore.Qt.Horizontal)
        self._slider.setRange(0, STEPS)
        self._value = QtWidgets.QDoubleSpinBox()
        self._value.setKeyboardTracking(False)
        self._play = QtWidgets.QPushButton(translated("Play"))
        self._play.setCheckable(True)
        self._speed = QtWidgets.QSpinBox()
        self._speed.setRange(1, FASTEST)
        self._speed.setValue(MIDDLE_SPEED)
        self._speed.setPrefix("x ")
        self._speed.setToolTip(translated("Times the machine's speed; by length, times 10 mm/s"))
        self._readout = QtWidgets.QLabel()
        self._readout.setTextInteractionFlags(QtCore.Qt.TextSelectableByMouse)
        rows = QtWidgets.QGridLayout(self.form)
        rows.addWidget(self._measure, 0, 0)
        rows.addWidget(self._value, 0, 1)
        rows.addWidget(self._slider, 1, 0, 1, 2)
        rows.addWidget(self._play, 2, 0)
        rows.addWidget(self._speed, 2, 1)
        rows.addWidget(self._readout, 3, 0, 1, 2)
        rows.setRowStretch(4, 1)
        names = {"Measure": self._measure, "Along": self._slider, "Value": self._value, "Play": self._play}
        for name, widget in {**names, "Speed": self._speed, "Readout": self._readout}.items():
            widget.setObjectName(name)
        self._measure.currentIndexChanged.connect(self._choose_measure)
        self._slider.valueChanged.connect(lambda step: self._value.setValue(self._end * step / STEPS))
        self._value.valueChanged.connect(self._show)
        self._play.toggled.connect(self._run)

    @property
    def _along(self) -> Any:
        return self._track.times if self._measure.currentIndex() == BY_TIME else self._track.lengths

    @property
    def _end(self) -> float:
        return float(self._along[-1])

    def _choose_measure(self, _: int) -> None:
        share = self._slider.value() / STEPS
        self._value.setDecimals(DECIMALS)
        self._value.setRange(0.0, self._end)
        self._value.setSingleStep(max(self._end / 200.0, 0.01))
        self._value.setValue(share * self._end)
        self._show(self._value.value())

    def _show(self, value: float) -> None:
        """The tool at a time or a length, and what is known there."""
        self._slider.blockSignals(True)
        self._slider.setValue(round(STEPS * value / self._end) if self._end > 0.0 else 0)
        self._slider.blockSignals(False)
        is_end = value >= self._value.maximum()
        moment = self._track.at(self._along, self._end if is_end else value)
        self._tool.move(moment.tip)
        x, y, z = moment.tip
        feed = translated("rapid") if moment.feed is None else f"F {moment.feed:g} mm/min"
        line = f"{translated('line')} {moment.line}"
        self._readout.setText(f"X {x:.3f}  Y {y:.3f}  Z {z:.3f}\n{feed}, {line}")

    def _run(self, is_on: bool) -> None:
        self._play.setText(translated("Stop") if is_on else translated("Play"))
        if not is_on:
            self._timer.stop()
            return
        if self._value.value() >= self._value.maximum():
            self._value.setValue(0.0)
        self._clock.start()
        self._timer.start()

    def _advance(self) -> None:
        """The next position of a moving tool, by the time that has passed."""
        seconds = self._clock.restart() / 1000.0
        rate = 1.0 if self._measure.currentIndex() == BY_TIME else 10.0
        value = self._value.value() + seconds * rate * self._speed.value()
        self._value.setValue(value)
        if value >= self._value.maximum():
            self._play.setChecked(False)

    def getStandardButtons(self) -> Any:
        """Only one."""
        return QtWidgets.QDialogButtonBox.Close

    def reject(self) -> bool:
        """Closes the panel; the tool goes with it."""
        self._timer.stop()
        pictures.remove(self._document, KEY)
        FreeCADGui.Control.closeDialog()
        return True


class MoveTool(Command):
    """Opens the panel for the operation in front."""

    name = "ToolMotion"
    icon = "tool-motion"
    menu_text = "Move tool"
    tool_tip = "Moves the tool along an operation's path, with its position, feed and line"

    def IsActive(self) -> bool:
        """With a job, and while no panel is open."""
        return chosen.is_job_free()

    def run(self) -> None:
        """Opens it."""
        operation = chosen.operation()
        job = chosen.job()
        FreeCADGui.Control.showDialog(MotionPanel(job, operation, motion_track.track_of(job, operation)))


class Simulate(Command):
    """FreeCAD's own simulator of material, for the job in front."""

    name = "Simulate"
    icon = "simulate"
    menu_text = "Simulate"
    tool_tip = "Opens FreeCAD's own simulator, which cuts the job's stock"

    def IsActive(self) -> bool:
        """With a job, and while no panel is open."""
        return chosen.is_job_free()

    def run(self) -> None:
        """Selects the job and opens it."""
        job = chosen.job()
        FreeCADGui.Selection.clearSelection()
        FreeCADGui.Selection.addSelection(job)
        FreeCADGui.runCommand("CAM_SimulatorGL")


def commands() -> list[Command]:
    """Both."""
    return [MoveTool(), Simulate()]
