"""What stands around the path of a forming job: blank, formed sheet, what holds it, die, and the tool on the other side.

The engine makes the shapes; report, PNG pictures and FreeCAD draw them in these colours.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from styluscam import _engine
from styluscam.programs.program import Program
from styluscam.tools.tool import Tool
from styluscam.types import FloatArray, IntArray

if TYPE_CHECKING:
    from styluscam.programs.job import Job
    from styluscam.programs.planning import Plan

FINE = 1.5e-4
"""Deviation of what is drawn from the part, as a share of the part's size."""

Colour = tuple[int, int, int]


@dataclass(frozen=True)
class Look:
    """How a kind of shape is drawn: apart from the others on light and dark ground, and with any kind of colour vision."""

    colour: Colour
    opacity: float


LOOKS = {
    "blank": Look((0x3F, 0x8F, 0xD2), 0.16),
    "formed-sheet": Look((0xB9, 0xC2, 0xCC), 1.0),
    "clamp": Look((0x6F, 0x8F, 0xAE), 0.45),
    "backing": Look((0x8A, 0x7F, 0xA8), 0.45),
    "die": Look((0xA9, 0x7C, 0x50), 1.0),
}
"""By the engine's keys."""

TOOL, OTHER_TOOL = Look((0xD9, 0xA4, 0x41), 0.82), Look((0x2F, 0x9E, 0x8A), 0.82)
"""The tool of the program that is shown, and that on the sheet's other side."""


@dataclass(frozen=True, eq=False)
class Shape:
    """A closed body in work coordinates, for drawing."""

    key: str
    """"blank", "formed-sheet", "clamp", "backing" or "die"."""
    words: str
    vertices: FloatArray
    """(V, 3), mm: one for each normal that a point has."""
    normals: FloatArray
    """(V, 3), unit, outward."""
    triangles: IntArray
    """(T, 3), of vertices, counterclockwise seen from outside."""
    edges: IntArray
    """(E, 2), of vertices: where the surface turns sharply."""

    @property
    def look(self) -> Look:
        """How it is drawn."""
        return LOOKS[self.key]


def shapes_of(job: Job, scene: _engine.Scene) -> tuple[Shape, ...]:
    """The shapes of a job's sheet in the work coordinates of the scene's channel; none without a sheet."""
    return tuple(Shape(*columns) for columns in scene.shapes(job.engine, _tolerance(scene)))


@dataclass(frozen=True, eq=False)
class Travel:
    """A path over a sheet."""

    tips: FloatArray
    """(N, 3), mm."""
    tools: Sequence[Tool | None]
    """The program's, as far as they are known."""
    loaded: IntArray
    """Which of them goes to each position, (N,); -1 where none does."""

    def numbered(self) -> tuple[list[Tool], IntArray]:
        """The known tools, and which of them goes to each position, (N,): -1 where it is not known."""
        known = [index for index, tool in enumerate(self.tools) if tool is not None]
        numbers = np.full(len(self.tools) + 1, -1)
        numbers[known] = np.arange(len(known))
        return [tool for tool in self.tools if tool is not None], numbers[self.loaded]


def standing(job: Job, scene: _engine.Scene, travel: Travel, moments: IntArray) -> FloatArray | None:
    """How far each vertex of the formed sheet stands above its formed height, (K, V), mm, behind each moment of a travel.

    ``moments`` (K,) are indices of its positions, rising. None without a sheet, and for a tool from below.
    """
    tools, loaded = travel.numbered()
    cutters = [tool._engine for tool in tools]
    return scene.standing(job.engine, _tolerance(scene), travel.tips, loaded, cutters, moments.tolist())


def _tolerance(scene: _engine.Scene) -> float:
    low, high = (np.array(corner) for corner in scene.bounds)
    return FINE * float(np.linalg.norm(high - low))


@dataclass(frozen=True, eq=False)
class Opposite:
    """The tool on the other side of the sheet, in the coordinates of the program that is shown."""

    program: Program
    """Its own program, move by move beside the one that is shown."""
    tool: Tool
    name: str

    def tips(self, moves: IntArray) -> FloatArray:
        """Where its tip is at the ends of moves (N,), (N, 3), mm: turned half about X, as its machine is."""
        return np.asarray(self.program.moves["end"][moves] * [1.0, -1.0, -1.0])


@dataclass(frozen=True, eq=False)
class Around:
    """What a picture of a program shows beside the program."""

    shapes: Sequence[Shape] = ()
    opposite: Opposite | None = None

    @property
    def box(self) -> FloatArray:
        """Lower and upper corner (2, 3) of the sheet, flat and formed."""
        return _box([shape.vertices for shape in self.shapes if shape.key in ("blank", "formed-sheet")])

    @property
    def whole(self) -> FloatArray:
        """The same of all shapes."""
        return _box([shape.vertices for shape in self.shapes])


def _box(corners: list[FloatArray]) -> FloatArray:
    every = np.concatenate(corners)
    return np.array([every.min(axis=0), every.max(axis=0)])


def opposite_of(job: Job, channel: str, shown: Program, other: Program | None) -> Opposite | None:
    """The tool of the channel that works together with another; None where there is none, or the moves are no pairs."""
    if other is None or len(other.moves) != len(shown.moves) or not other.tools:
        return None
    partner = job.engine.partner_of(channel)
    record = other.tools[0]
    tool = job.tools().get(record.name)
    return None if partner is None or tool is None else Opposite(other, tool, record.description)


def around_plan(plan: Plan, channel: str) -> Around:
    """What stands around the program of a plan's channel."""
    partner = plan.job.engine.partner_of(channel)
    other = plan.programs[partner] if partner else None
    opposite = opposite_of(plan.job, channel, plan.programs[channel], other)
    return Around(shapes_of(plan.job, plan.settings[channel].scene), opposite)
