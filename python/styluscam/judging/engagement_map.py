"""The engagement along a program that clears stock level by level, layer by layer as the verifier looks at it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from styluscam.judging.engagement import RunEngagement, engagement
from styluscam.programs.program import CLOCKWISE, FEED, RAPID, Program
from styluscam.tools.outline import polyline
from styluscam.tools.tool import Tool
from styluscam.types import FloatArray, IntArray, Progress

LEVEL = 1e-6
"""A move that changes its height by less is level, mm."""

SAME_LEVEL = 1e-3
"""Levels nearer than this are one, mm."""

HALF = 0.999 * math.pi
"""Arcs are parted into pieces of no more than this, rad."""


@dataclass(frozen=True)
class Stock:
    """A box of material down to the lowest level, with holes that are drilled before. Lengths mm."""

    low: tuple[float, float]
    high: tuple[float, float]
    top: float
    holes: Sequence[tuple[float, float, float]] = ()
    """Axes (x, y) and diameters."""

    def outlines(self) -> list[FloatArray]:
        """Of the box and of the holes in it, as points with bulges."""
        (x0, y0), (x1, y1) = self.low, self.high
        box = np.array([[x0, y0, 0.0], [x1, y0, 0.0], [x1, y1, 0.0], [x0, y1, 0.0]])
        holes = [np.array([[x + 0.5 * d, y, 1.0], [x - 0.5 * d, y, 1.0]]) for x, y, d in self.holes]
        return [box, *holes]


@dataclass(frozen=True, eq=False, repr=False)
class EngagementMap:
    """The engagement at positions of the tip, in the order in which they are cut."""

    points: FloatArray
    """(N, 3), mm."""
    angles_deg: FloatArray
    """(N,)."""
    is_entry: IntArray
    """Whether the tool goes down there, (N,): the bound does not hold for these."""
    ends: IntArray
    """Behind the last point of each run, (R,)."""

    @property
    def worst(self) -> int | None:
        """The position of the largest angle that is bounded; none where nothing is cut."""
        angles = np.where(self.is_entry, -1.0, self.angles_deg)
        return int(angles.argmax()) if angles.size and angles.max() >= 0.0 else None

    def thinned(self, count: int) -> EngagementMap:
        """With about so many points: each has the largest angle of those that it stands for."""
        every = math.ceil(len(self.points) / count) if count else 1
        if every <= 1:
            return self
        kept, angles, ends = [], [], []
        first = 0
        for end in self.ends:
            starts = np.arange(first, end, every)
            kept.append(np.minimum(starts + every, end) - 1)
            angles.append(np.maximum.reduceat(self.angles_deg, starts) if len(starts) else np.zeros(0))
            if len(starts):  # where the run begins is where its line begins
                angles[-1][-1] = self.angles_deg[starts[-1] : end].max()
                kept[-1] = np.append(first, kept[-1])
                angles[-1] = np.append(self.angles_deg[first], angles[-1])
            ends.append(len(kept[-1]))
            first = end
        at = np.concatenate(kept)
        return EngagementMap(self.points[at], np.concatenate(angles), self.is_entry[at], np.cumsum(ends))


def engagement_map(program: Program, tool: Tool, stock: Stock, progress: Progress | None = None) -> EngagementMap:
    """The engagement along a program of one operation that clears stock, its tip's heights and angles.

    Each layer, from one level to the next, is a plane pocket of its own in the plane just below its top, with the tool's radius
    there; all of the box that no move of the layer has swept is material. Rapids cut nothing and are not in it.

    Raises:
        Cancelled: when ``progress`` returns ``False``.
    """
    moves = program.moves
    ends = moves["end"]
    starts = np.concatenate([np.full((1, 3), np.nan), ends[:-1]])
    heights, outlines = _levels(moves, starts, stock.top), stock.outlines()
    meridian = polyline(tool)
    found: list[tuple[RunEngagement, FloatArray, FloatArray]] = []
    above = stock.top
    for number, floor in enumerate(heights):
        runs = list(_runs(moves, starts, (above, floor)))
        radius = float(np.interp(above - floor, meridian[:, 1], meridian[:, 0]))
        share = None if progress is None else _share(progress, number, len(heights))
        if runs and radius > 0.0:
            measured = engagement([run[:2] for run in runs], radius, None, outlines, progress=share)
            pairs = zip(measured, runs, strict=True)
            found += [(one, _lengths(run[0]), run[2]) for one, run in pairs if one.kind != "rapid"]
        above = floor
    return _joined(found)


def _share(progress: Progress, number: int, count: int) -> Progress:
    return lambda phase, fraction: progress(phase, (number + fraction) / count)


def _levels(moves: Any, starts: FloatArray, top: float) -> list[float]:  # noqa: ANN401  # a structured array
    """The heights of level feeds, from the top down."""
    step = np.abs(moves["end"] - starts)
    is_level = (
        (moves["kind"] != RAPID) & (step[:, 2] < LEVEL) & ((step[:, :2].max(axis=1) > LEVEL) | (moves["kind"] > FEED))
    )
    heights = np.unique(moves["end"][is_level, 2])[::-1]
    levels: list[float] = []
    for height in heights[heights < top - LEVEL]:
        if not levels or levels[-1] - height > SAME_LEVEL:
            levels.append(float(height))
    return levels


def _runs(
    moves: Any,  # noqa: ANN401  # a structured array
    starts: FloatArray,
    layer: tuple[float, float],
) -> Iterator[tuple[FloatArray, str, FloatArray]]:
    """Points with bulges, kind, and heights at the points, of the moves that lie in a layer; moves that go on are one run."""
    top, floor = layer
    ends = moves["end"]
    lowest = np.fmin(starts[:, 2], ends[:, 2])
    in_plan = (np.abs(ends[:, :2] - starts[:, :2]) > LEVEL).any(axis=1) | (moves["kind"] > FEED)
    goes_up = ~in_plan & (ends[:, 2] >= starts[:, 2])
    inside = (lowest < top - LEVEL) & (lowest > floor - SAME_LEVEL) & np.isfinite(starts).all(axis=1) & ~goes_up
    falls = (starts[:, 2] - ends[:, 2] > LEVEL) & (starts[:, 2] > floor + SAME_LEVEL)
    kinds = np.where(moves["kind"] == RAPID, "rapid", np.where(falls, "entry", "cut"))
    points: list[list[float]] = []
    heights: list[float] = []
    last = -2
    for index in np.flatnonzero(inside):
        if points and (index != last + 1 or kinds[index] != kinds[last]):
            yield np.array(points), str(kinds[last]), np.array(heights)
            points, heights = [], []
        if not points:
            points, heights = [[*starts[index, :2], 0.0]], [starts[index, 2]]
        for x, y, z, bulge in _pieces(moves[index], starts[index]):
            points[-1][2] = bulge
            points.append([x, y, 0.0])
            heights.append(z)
        last = int(index)
    if points:
        yield np.array(points), str(kinds[last]), np.array(heights)


def _pieces(move: Any, start: FloatArray) -> Iterator[tuple[float, float, float, float]]:  # noqa: ANN401  # a record
    """The ends of a move's lines and arcs of less than a half, and the bulge with which each is come to."""
    x, y, z = (float(value) for value in move["end"])
    if move["kind"] <= FEED:
        if math.hypot(x - start[0], y - start[1]) > LEVEL:
            yield x, y, z, 0.0
        return
    centre = move["centre"][:2]
    one, other = (math.atan2(at[1] - centre[1], at[0] - centre[0]) for at in (start, (x, y)))
    sense = -1.0 if move["kind"] == CLOCKWISE else 1.0
    sweep = (sense * (other - one)) % (2.0 * math.pi) or 2.0 * math.pi
    sweep += 2.0 * math.pi * float(move["turns"])
    count = math.ceil(sweep / HALF)
    radius, bulge = math.hypot(start[0] - centre[0], start[1] - centre[1]), sense * math.tan(0.25 * sweep / count)
    for i in range(1, count):
        angle = one + sense * sweep * i / count
        height = start[2] + (z - start[2]) * i / count
        yield (
            float(centre[0] + radius * math.cos(angle)),
            float(centre[1] + radius * math.sin(angle)),
            float(height),
            bulge,
        )
    yield x, y, z, bulge


def _lengths(points: FloatArray) -> FloatArray:
    """The length of a path from its first point to each, mm."""
    half = 2.0 * np.arctan(np.abs(points[:-1, 2]))
    arcs = np.divide(half, np.sin(half), out=np.ones_like(half), where=half > LEVEL)
    return np.append(0.0, np.cumsum(arcs * np.hypot(*np.diff(points[:, :2], axis=0).T)))


def _joined(found: list[tuple[RunEngagement, FloatArray, FloatArray]]) -> EngagementMap:
    """All runs in one; heights between points follow the length."""
    found = [one for one in found if len(one[0].points)]
    if not found:
        return EngagementMap(np.zeros((0, 3)), np.zeros(0), np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64))
    rows = []
    for run, lengths, heights in found:
        rows.append(np.column_stack([run.points, np.interp(run.distances, lengths, heights)]))
    entries = [np.full(len(run.points), run.kind == "entry", dtype=np.int64) for run, *_ in found]
    counts = [len(run.points) for run, *_ in found]
    angles = np.concatenate([run.angles_deg for run, *_ in found])
    return EngagementMap(np.concatenate(rows), angles, np.concatenate(entries), np.cumsum(counts))
