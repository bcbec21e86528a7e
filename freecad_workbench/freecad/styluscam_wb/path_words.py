# SPDX-License-Identifier: LGPL-2.1-or-later
"""A program's moves as the words of FreeCAD's path commands: G0, G1, G2, G3, and the plane of arcs.

FreeCAD reads I, J, K as the centre relative to an arc's start, and an arc that ends where it starts as a full circle; it
has no word for further turns (FreeCAD src/Mod/CAM/App/PathSegmentWalker.cpp, Path/Geom.py). Lengths mm, feeds mm/s.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from styluscam import Program

Words = tuple[str, dict[str, float]]
"""A command's name and its parameters."""

Point = tuple[float, float, float]

RAPID, NAMES = 0, ("G0", "G1", "G2", "G3")
"""Commands by a move's kind in `Program.moves`."""

CLOCKWISE = 2

AXES = "XYZ"

CENTRE = "IJK"

PLANES = {17: (0, 1, 2), 18: (2, 0, 1), 19: (1, 2, 0)}
"""By G17, G18, G19: the first and second axis, and the one along which an arc may rise; a right-handed system."""

XY = 17
"""The plane that FreeCAD takes where none is stated."""

SAME = 1e-9
"""In the plane, ends of an arc nearer than this share of its radius are one point: a full circle, as for the engine."""

WRITTEN = 1e-5
"""FreeCAD writes six decimals: an arc whose ends are nearer than this (mm) could be read back as a full circle."""

UP = (0.0, 0.0, 1.0)


class WordsError(ValueError):
    """A move that FreeCAD's commands cannot express; the message names it."""


def words_of(program: Program) -> Iterator[Words]:
    """The commands of all moves, in order; they leave the XY plane as they found it.

    Raises:
        WordsError: an arc with an unknown start, or a tilted tool axis.
    """
    start: Point | None = None
    plane = XY
    tilts = "axis" in (program.moves.dtype.names or ())
    for number, move in enumerate(program.moves, 1):
        if tilts and tuple(move["axis"]) != UP:
            raise WordsError(f"move {number} tilts the tool: a path for FreeCAD has three axes")
        end = _point(move["end"])
        if move["kind"] == RAPID:
            yield NAMES[RAPID], _at(end)
        elif move["kind"] < CLOCKWISE:
            yield NAMES[1], {**_at(end), "F": _feed(move)}
        elif start is None:
            raise WordsError(f"move {number} is an arc with an unknown start: begin with a rapid move or a line")
        else:
            for own_plane, words in _arc(start, end, move):
                if own_plane != plane:
                    plane = own_plane
                    yield f"G{plane}", {}
                yield words
        start = end
    if plane != XY:
        yield f"G{XY}", {}


def _point(values: Any) -> Point:
    x, y, z = (float(value) for value in values)
    return x, y, z


def _at(point: Point) -> dict[str, float]:
    return dict(zip(AXES, point, strict=True))


def _feed(move: Any) -> float:
    return float(move["feed"]) / 60.0


def _arc(start: Point, end: Point, move: Any) -> Iterator[tuple[int, Words]]:
    """The planes and commands of an arc: full turns first, each its share of the rise."""
    plane, turns = int(move["plane"]), int(move["turns"])
    centre = _point(move["centre"])
    first, second, third = PLANES[plane]
    apart = math.hypot(end[first] - start[first], end[second] - start[second])
    radius = math.hypot(start[first] - centre[first], start[second] - centre[second])
    last = _sweep(start, end, centre, move)
    rise = (end[third] - start[third]) / (2.0 * math.pi * turns + last)
    at = start
    for turn in range(1, turns + 1):
        after = list(start)
        after[third] = start[third] + rise * 2.0 * math.pi * turn
        yield plane, _turn(at, _point(after), centre, move)
        at = _point(after)
    if apart <= SAME * radius:  # FreeCAD closes a circle only where the coordinates are equal
        closed = list(end)
        closed[first], closed[second] = start[first], start[second]
        end = _point(closed)
    elif apart < WRITTEN and last < math.pi:
        yield plane, (NAMES[1], {**_at(end), "F": _feed(move)})
        return
    yield plane, _turn(at, end, centre, move)


def _turn(start: Point, end: Point, centre: Point, move: Any) -> Words:
    """One G2 or G3, at most a full turn."""
    first, second, _ = PLANES[int(move["plane"])]
    offsets = {CENTRE[axis]: centre[axis] - start[axis] for axis in sorted((first, second))}
    return NAMES[int(move["kind"])], {**_at(end), **offsets, "F": _feed(move)}


def _sweep(start: Point, end: Point, centre: Point, move: Any) -> float:
    """The angle to the first arrival at the end, rad, above 0 and up to a full turn."""
    first, second, _ = PLANES[int(move["plane"])]
    angles = [math.atan2(at[second] - centre[second], at[first] - centre[first]) for at in (start, end)]
    turned = angles[0] - angles[1] if move["kind"] == CLOCKWISE else angles[1] - angles[0]
    apart = math.hypot(end[first] - start[first], end[second] - start[second])
    radius = math.hypot(start[first] - centre[first], start[second] - centre[second])
    return 2.0 * math.pi if apart <= SAME * radius else turned % (2.0 * math.pi)
