"""What operations that mill with the side of a leaning tool leave of their surfaces, measured from a text by the verifier."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypeAlias

from styluscam.records import Record
from styluscam.types import FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class FlankSurface(Record):
    """What the moving tool leaves of a ruled surface along its normals. Lengths mm.

    Attributes:
        name: of the face, or of the edges between which it is ruled.
        over: how deep the tool enters it at the worst; 0 when it does not.
        under: how much it leaves at the worst, beyond the stock that is to stay.
        missed: share of the surface over which the tool does not come at all, 0 to 1.
        left: what is left, (U, V), at evenly spaced shares of the rails and of the straight lines between them: below 0 what is
            cut too deep, infinite where the tool does not come.
        points: the points there, (U, V, 3), work coordinates.
    """

    name: str
    over: float
    under: float
    missed: float
    left: FloatArray
    points: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class OperationFlank(Record):
    """An operation's surfaces, and how its tool's axis turns along its passes.

    Attributes:
        operation: its id.
        speed_max: at most, deg/s.
        acceleration_max: at most, deg/s^2.
        unevenness: turn for each mm at the worst beside the mean.
        faces: what is left of each surface.
    """

    operation: str
    speed_max: float
    acceleration_max: float
    unevenness: float
    faces: list[FlankSurface]


Surface: TypeAlias = "tuple[str, float, float, float, list[int], FloatArray, FloatArray]"
Arrays: TypeAlias = "tuple[str, float, float, float, list[Surface]]"
"""An operation's surfaces as the engine hands them over."""


def of_arrays(arrays: Arrays) -> OperationFlank:
    """The engine's arrays as records."""
    operation, speed, acceleration, unevenness, faces = arrays
    return OperationFlank(operation, speed, acceleration, unevenness, [_surface(face) for face in faces])


def _surface(surface: Surface) -> FlankSurface:
    name, over, under, missed, (rows, columns), left, points = surface
    return FlankSurface(name, over, under, missed, left.reshape(rows, columns), points.reshape(rows, columns, 3))


def lines(found: list[OperationFlank]) -> Iterator[str]:
    """Each surface of some operations in a line."""
    for one in found:
        for face in one.faces:
            missed = f", {100.0 * face.missed:.2f} % not reached" if face.missed > 0.0 else ""
            errors = f"entered by {1e3 * face.over:.2f} um, left {1e3 * face.under:.2f} um at most"
            yield f"{one.operation}, {face.name}: {errors}{missed}; the axis turns by {one.speed_max:.1f} deg/s at most"
