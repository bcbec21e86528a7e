"""Machines with two rotary axes beside the linear ones: programs with a leaning tool as text, and text as poses."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

from styluscam import _engine
from styluscam.programs.machine import Machine, MachineLike
from styluscam.programs.program import Program
from styluscam.types import FloatArray

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class RotaryAxis:
    """An axis that turns the part or the tool. A positive angle turns what it carries by the right-hand rule."""

    letter: Literal["A", "B", "C"]
    carries: Literal["table", "head"]
    direction: Vector
    """At angles 0, of any length."""
    pivot: Vector = (0.0, 0.0, 0.0)
    """A point that the axis does not move, mm: of a table in work coordinates, of a head from the tool's tip, at angles 0."""
    limits_deg: tuple[float, float] = (-360.0, 360.0)

    @property
    def columns(self) -> tuple[str, bool, Vector, Vector, tuple[float, float]]:
        """As the engine takes it."""
        return self.letter, self.carries == "head", self.direction, self.pivot, self.limits_deg


@dataclass(frozen=True)
class FiveAxes:
    """Two rotary axes; where they carry the same, the first carries the second."""

    first: RotaryAxis
    second: RotaryAxis
    tip_control: tuple[str, str] | None = None
    """The lines that switch the control's tracking of the tip on and off, as ``("G43.4 H1", "G49")``; coordinates are the tip's
    then. Without them they are where the linear axes stand, and feeds are inverse times (G93)."""
    angle_decimals: int = 5
    tip_tolerance: float = 0.001
    """How far the tip may leave the straight line between two positions, mm, where the control does not track it: others are put
    between."""

    def post(self, program: Program, machine: MachineLike) -> str:
        """G-code of a program of lines, in numbers as the machine file writes them.

        Of all angles that point the tool right, those are taken that turn least on the way and stay within the limits.

        Raises:
            MachineError: directions out of reach, limits, an axis that would turn by more than 30 deg in a move, other moves than
                lines, a controller whose text is no G-code.
        """
        return self._engine.post(program.engine, Machine.of(machine).engine)

    def read(self, text: str, machine: MachineLike) -> tuple[FloatArray, FloatArray]:
        """Tips (N, 3), mm, and directions (N, 3) in work coordinates to which such a text goes, by the kinematics forward.

        Raises:
            MachineError: words that :meth:`post` does not write.
        """
        return self._engine.read(text, Machine.of(machine).engine)

    @cached_property
    def _engine(self) -> _engine.Rotary:
        axes = tuple(axis.columns for axis in (self.first, self.second))
        control = None if self.tip_control is None else list(self.tip_control)
        return _engine.Rotary((axes[0], axes[1]), control, self.angle_decimals, self.tip_tolerance)
