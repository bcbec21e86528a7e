"""Gouge and excess by brute force: the distance of the part's edges and faces to the tool, searched position by position.

A convex function is least on a triangle at an edge, or where a plane beside the triangle's touches the tool. Along an edge
and along a move it is least between the neighbours of the best position of a grid: so every search narrows a grid. What the
distance cannot reach (it changes by a mm per mm at most) is not looked at. Lengths in mm.

Where the tool is in deeper than its radius of curvature there (at a sharp rim: anywhere), that it is in is certain, and
how deep is not: points of the part and points of the tool then measure different depths.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from convex_tool import Floats, Tool

GRID = 9
FINE = 14
"""Times that a grid is narrowed to a quarter: to 1e-8 of its length."""
ROUGH = 6
"""To 1e-3 of its length: what decides whether 0.02 mm matter."""
SCAN = 241
"""Positions of a path that is not straight, from which dips are searched."""
DIP = 0.02
"""mm by which a scanned dip may be above the deepest and still turn out deeper."""
PAIRS = 100_000
"""Pairs of a position and an edge that are searched at a time."""


@dataclass(frozen=True)
class Deepest:
    """The least distance along a path, and where the tip stands there."""

    value: float
    tip: Floats


class Solid:
    """A part as edges and faces; triangles (T, 3, 3) of some area."""

    def __init__(self, triangles: Floats) -> None:
        sides = np.concatenate([triangles[:, [i, (i + 1) % 3]] for i in range(3)])
        turned = [tuple(map(tuple, sorted(side.tolist()))) for side in np.round(sides, 9)]
        _, first = np.unique(np.array(turned).reshape(-1, 6), axis=0, return_index=True)
        self.edges = sides[first]
        normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
        normals /= np.linalg.norm(normals, axis=1)[:, None]
        normals *= np.where(normals[:, 2] < 0, -1.0, 1.0)[:, None]
        up = normals[:, 2] > 1e-9
        self.faces, self.normals = triangles[up], normals[up]

    def clearances(self, tool: Tool, tips: Floats, steps: int = FINE) -> Floats:
        """Least signed distance of the part to the tool at each tip (N, 3): negative where it is entered."""
        best = np.full(len(tips), np.inf)
        rows = max(1, PAIRS // len(self.edges))
        for begin in range(0, len(tips), rows):
            chunk = slice(begin, begin + rows)
            best[chunk] = self._clearances(tool, tips[chunk], steps)
        return best

    def deepest(self, tool: Tool, start: Floats, end: Floats, steps: int = FINE) -> Deepest:
        """The least signed distance over a straight path of the tip."""
        start, end = np.asarray(start, dtype=float), np.asarray(end, dtype=float)
        tips = np.stack([start, end])
        at_faces = self._at_faces(tool, tips)
        least = Deepest(float(at_faces.min()), tips[at_faces.argmin()])
        bound, travel = (
            self.clearances(tool, start + np.linspace(0, 1, 17)[:, None] * (end - start), ROUGH).min(),
            end - start,
        )
        near = self.edges[self._may_reach(tool, start, travel, float(bound))]

        def along(shares: Floats) -> Floats:
            """(E, G): the least on each edge."""
            moved = start + shares[..., None] * travel
            return least_on(tool, np.repeat(near, shares.shape[1], axis=0), moved.reshape(-1, 3), steps).reshape(
                shares.shape
            )

        values, shares = _narrowed(along, len(near), steps)
        if len(near) and values.min() < least.value:
            least = Deepest(float(values.min()), start + shares[values.argmin()] * travel)
        return least

    def deepest_along(self, tool: Tool, travel: Callable[[Floats], Floats], steps: int = FINE) -> Deepest:
        """The least signed distance over a smooth path, shares (N,) to tips (N, 3): every dip of a fine scan is searched."""
        shares = np.linspace(0.0, 1.0, SCAN)
        values = self.clearances(tool, travel(shares), ROUGH)
        dips = np.nonzero(
            (values <= np.roll(values, 1)) & (values <= np.roll(values, -1)) & (values < values.min() + DIP)
        )[0]
        low = np.maximum(shares[dips] - 1 / (SCAN - 1), 0.0)
        width = np.minimum(shares[dips] + 1 / (SCAN - 1), 1.0) - low

        def along(inner: Floats) -> Floats:
            tips = travel((low[:, None] + inner * width[:, None]).reshape(-1))
            return self.clearances(tool, tips, steps).reshape(inner.shape)

        found, where = _narrowed(along, len(dips), steps)
        best = found.argmin()
        return Deepest(float(found[best]), travel(low[best : best + 1] + where[best] * width[best])[0])

    def nearest(self, tool: Tool, tip: Floats, within: float) -> Floats | None:
        """A point of the part that the tool at a tip is nearest to; none if it is farther off than `within`."""
        best: tuple[float, Floats | None] = (within, None)
        gaps, feet = self._over_faces(tool, tip[None])
        if len(self.faces) and gaps[0].min() < within:
            best = (float(gaps[0].min()), feet[0, gaps[0].argmin()])
        first, travel = self.edges[:, 0] - tip, self.edges[:, 1] - self.edges[:, 0]
        values, shares = _narrowed(
            lambda t: _distances(tool, first[:, None] + t[..., None] * travel[:, None]), len(first), ROUGH
        )
        if values.min() < best[0]:
            edge = values.argmin()
            best = (float(values.min()), self.edges[edge, 0] + shares[edge] * travel[edge])
        return best[1]

    def _clearances(self, tool: Tool, tips: Floats, steps: int) -> Floats:
        middles = self.edges.mean(axis=1)
        halves = 0.5 * np.linalg.norm(self.edges[:, 1] - self.edges[:, 0], axis=1)
        at_middles = _distances(tool, middles[None] - tips[:, None])
        best = np.minimum(at_middles.min(axis=1), self._at_faces(tool, tips))
        rows, edges = np.nonzero(at_middles - halves[None] < best[:, None])
        np.minimum.at(best, rows, least_on(tool, self.edges[edges], tips[rows], steps))
        return best

    def _at_faces(self, tool: Tool, tips: Floats) -> Floats:
        """Least distance at each tip over the faces above which the touching point lies."""
        return np.asarray(self._over_faces(tool, tips)[0].min(axis=1, initial=np.inf))

    def _over_faces(self, tool: Tool, tips: Floats) -> tuple[Floats, Floats]:
        """Gaps along the faces' normals (N, F), and the touching points' feet; infinite where those are not on the faces.

        A foot that the tool does not hold belongs to a face behind the one that is entered.
        """
        touching = tips[:, None] + self._touching(tool)
        gaps = np.einsum("nfi,fi->nf", touching - self.faces[:, 0], self.normals)
        feet = touching - gaps[..., None] * self.normals
        sides = [(self.faces[:, i], self.faces[:, (i + 1) % 3]) for i in range(3)]
        turns = np.array([np.einsum("nfi,fi->nf", np.cross(b - a, feet - a), self.normals) for a, b in sides])
        inside = np.all(turns >= 0, axis=0) | np.all(turns <= 0, axis=0)
        entered = inside & (gaps < 0)
        rows = np.nonzero(entered)[0]
        inside[entered] = tool.distance(feet[entered] - tips[rows]) < 0
        return np.where(inside, gaps, np.inf), feet

    def _touching(self, tool: Tool) -> Floats:
        """The tool's point that a plane along each face touches (F, 3)."""
        points = np.empty((len(self.faces), 3))
        for row, normal in enumerate(self.normals):
            radius, height = tool.support(math.acos(min(normal[2], 1.0)))
            flat = math.hypot(normal[0], normal[1])
            out = -normal[:2] / flat * radius if flat > 1e-12 else np.zeros(2)
            points[row] = out[0], out[1], height
        return points

    def _may_reach(self, tool: Tool, start: Floats, travel: Floats, bound: float) -> Floats:
        """Which edges may come as near as the bound."""
        shares = np.linspace(0.0, 1.0, 33)
        tips = start + shares[:, None] * travel
        half = 0.5 * np.linalg.norm(travel) / (len(shares) - 1)
        middles = self.edges.mean(axis=1)
        halves = 0.5 * np.linalg.norm(self.edges[:, 1] - self.edges[:, 0], axis=1)
        return np.asarray(_distances(tool, middles[None] - tips[:, None]).min(axis=0) - halves - half <= bound)


def _distances(tool: Tool, points: Floats) -> Floats:
    return tool.distance(points.reshape(-1, 3)).reshape(points.shape[:-1])


def least_on(tool: Tool, edges: Floats, tips: Floats, steps: int = FINE) -> Floats:
    """Least distance on each of N edges (N, 2, 3) for the tip (N, 3) of the same row."""
    first, travel = edges[:, 0] - tips, edges[:, 1] - edges[:, 0]
    return _narrowed(lambda t: _distances(tool, first[:, None] + t[..., None] * travel[:, None]), len(tips), steps)[0]


def _narrowed(function: Callable[[Floats], Floats], count: int, steps: int) -> tuple[Floats, Floats]:
    """Least values of `count` convex functions over 0 to 1, and where; the function takes (count, GRID) positions."""
    low, width = np.zeros(count), np.ones(count)
    best, where = np.full(count, np.inf), np.zeros(count)
    rows = np.arange(count)
    for _ in range(steps):
        grid = low[:, None] + width[:, None] * np.linspace(0.0, 1.0, GRID)
        values = function(grid)
        least = values.argmin(axis=1)
        better = values[rows, least] < best
        best = np.where(better, values[rows, least], best)
        where = np.where(better, grid[rows, least], where)
        step = width / (GRID - 1)
        low = np.clip(grid[rows, least] - step, 0.0, 1.0)
        width = np.minimum(2 * step, 1.0 - low)
    return best, where
