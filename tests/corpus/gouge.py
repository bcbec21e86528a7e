"""Does a posted text enter the part as it was made? Sampled positions of the path against all triangles near them.

The text is read by `gcode`, the tool is `convex_tool`'s, the triangles are the modeller's own: nothing of the engine takes
part. A triangle is entered where the signed distance to the tool, a convex function, is below zero on it: it is least on an
edge, or where a plane beside the triangle's touches the tool. Supporting planes of the tool bound that distance from below;
what they leave open is measured. Lengths in mm, work coordinates.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from cycles import expanded

import gcode
from brute_force import least_on
from controllers import Family
from convex_tool import Floats, Tool

SAMPLES = 1600
NEAR = 0.05
"""mm: a position of the path nearer than this, and the job's tolerance, touches."""
LOOSE = 0.1
"""mm: tolerances count up to this: a path over a part of 10 m lies that far above it."""
PLANES = 64
"""Supporting planes of the tool."""
MEASURED = 64
"""Pairs that are measured at a time, the deepest first."""
PARTED = 8
"""Planes that are tried to part a triangle from the tool."""
HALVED = 12
"""Times that an edge over the tool is halved."""
PAIRS = 400_000
"""Pairs of a position and a triangle at a time."""
FEATURE = 1.0
"""mm: the smallest feature of an operation that names none."""


@dataclass
class Checked:
    """What was found."""

    samples: int = 0
    deepest: float = 0.0
    """mm, 0 where nothing is entered by more than is allowed."""
    at: tuple[float, float, float] | None = None
    line: int = 0
    touching: float = 0.0
    """Share of the positions at feed that are near the part."""
    refused: str = ""
    """Why a controller would not take the text, or why nothing could be checked."""
    path_box: list[list[float]] | None = None
    """Of the tips at feed."""
    cuts: int = 0
    """Paths at feed between two rapids."""
    lifts: int = 0
    """Times that the tool was lifted between two of them, nearer to each other than half the job's smallest feature."""


def checked(text: str, job: dict[str, Any], corners: Floats, allowed: float, family: Family, seed: int) -> Checked:
    """Checks a text; `corners` (T, 3, 3) in work coordinates, `allowed` the depth that is none."""
    text, line_of = expanded(text)
    program = gcode.read(text, family)
    found = Checked()
    if program.refused is not None:
        found.refused = f"line {line_of[program.refused[0] - 1]}: {program.refused[1]}"
        return found
    moves = [move for move in program.moves if move.placed]
    feeds = [move for move in moves if move.kind != "rapid"]
    if not feeds:
        found.refused = "nothing moves at feed"
        return found
    ends = np.array([move.end for move in feeds])
    found.path_box = [ends.min(axis=0).tolist(), ends.max(axis=0).tolist()]
    cuts = _cuts(moves)
    features = [operation.get("smallest_feature", FEATURE) for operation in job.get("operations", ())]
    gaps = [math.dist(a.end, b.begin) for a, b in itertools.pairwise(cuts) if a.tool == b.tool]
    found.cuts, found.lifts = len(cuts), sum(gap < 0.5 * min(features, default=FEATURE) for gap in gaps)
    tools = {tool.get("number", 1): tool for tool in job["tools"].values()}
    tips, numbers, lines, feeding = _samples(moves, seed)
    tolerances = [operation.get("tolerance", 0.0) for operation in job.get("operations", ())]
    near, reach = 0, NEAR + min(max(tolerances, default=0.0), LOOSE)
    for number in np.unique(numbers):
        of_tool = numbers == number
        tool = Tool.of(tools[int(number)]["profile"], job["setup"].get("sheet"), job["part"].get("model_face"))
        depths = Scene(tool, corners, reach).distances(tips[of_tool], allowed)
        found.samples += len(depths)
        near += int(np.sum((depths < reach) & feeding[of_tool]))
        worst = int(depths.argmin())
        if depths[worst] < -allowed and -depths[worst] > found.deepest:
            tip = tips[of_tool][worst]
            found.deepest, found.line = float(-depths[worst]), line_of[int(lines[of_tool][worst]) - 1]
            found.at = (float(tip[0]), float(tip[1]), float(tip[2]))
    found.touching = near / max(1, int(feeding.sum()))
    return found


@dataclass
class Cut:
    """Moves at feed between two rapids, from the first move aside to the last."""

    begin: gcode.Point
    end: gcode.Point
    tool: int


def _cuts(moves: list[gcode.Move]) -> list[Cut]:
    """All cuts of a program, in their order."""
    cuts: list[Cut] = []
    goes_on = False
    for move in moves:
        goes_on = goes_on and move.kind != "rapid"
        goes_aside = move.kind == "arc" or math.dist(move.start[:2], move.end[:2]) > 0.0
        if move.kind == "rapid" or not goes_aside:
            continue
        if goes_on:
            cuts[-1].end = move.end
        else:
            cuts.append(Cut(move.start, move.end, move.state.tool))
        goes_on = True
    return cuts


def _samples(moves: list[gcode.Move], seed: int) -> tuple[Floats, np.ndarray, np.ndarray, np.ndarray]:
    """Tips (N, 3) spread over the path, the tool's number, the line, and whether it is at feed."""
    rng = np.random.default_rng(seed)
    lengths = np.array([move.length for move in moves])
    ends = np.cumsum(lengths)
    samples = (np.arange(SAMPLES) + rng.uniform(0, 1, SAMPLES)) / SAMPLES * ends[-1]
    chosen = np.minimum(np.searchsorted(ends, samples), len(moves) - 1)
    shares = np.clip(1 - (ends[chosen] - samples) / np.maximum(lengths[chosen], 1e-12), 0.0, 1.0)
    corners = rng.choice(len(moves), min(len(moves), SAMPLES // 4), replace=False)
    chosen, shares = np.concatenate([chosen, corners]), np.concatenate([shares, np.ones(len(corners))])
    tips = np.array([moves[i].at(float(share)) for i, share in zip(chosen, shares, strict=True)])
    numbers = np.array([moves[i].state.tool for i in chosen])
    lines = np.array([moves[i].line for i in chosen])
    return tips, numbers, lines, np.array([moves[i].kind != "rapid" for i in chosen])


def _touching(tool: Tool, slopes: Floats) -> Floats:
    """Radius and height of the point that a plane of each slope touches (N, 2)."""
    return np.array([tool.support(float(slope)) for slope in slopes])


class Scene:
    """Triangles in cells of a grid over the plan, and a tool."""

    def __init__(self, tool: Tool, corners: Floats, near: float = NEAR) -> None:
        self.tool, self.near = tool, near
        self.corners = corners
        self.low, self.high = corners.min(axis=1), corners.max(axis=1)
        self.slopes = np.linspace(0.0, 0.5 * math.pi, PLANES)
        touching = _touching(tool, self.slopes)
        self.sine, self.cosine = np.sin(self.slopes), np.cos(self.slopes)
        self.offsets = touching[:, 0] * self.sine - touching[:, 1] * self.cosine
        self.fine = np.linspace(0.0, 0.5 * math.pi, 30 * PLANES)
        self.touch_r, self.touch_z = _touching(tool, self.fine).T
        self.bottom_r = np.concatenate([[0.0], np.maximum.accumulate(self.touch_r)])
        self.bottom_z = np.concatenate([[-tool.raised], self.touch_z])
        self.radius = tool.radius + near
        self._sort()

    def _sort(self) -> None:
        """Triangles by cell, in one array with a start for each cell."""
        self.origin = self.low[:, :2].min(axis=0)
        extent = float((self.high[:, :2].max(axis=0) - self.origin).max())
        self.cell = max(2 * self.radius, extent / 128, 1e-9)
        first = ((self.low[:, :2] - self.origin) // self.cell).astype(np.int64)
        last = ((self.high[:, :2] - self.origin) // self.cell).astype(np.int64)
        self.columns = int(last[:, 1].max()) + 1
        self.rows = int(last[:, 0].max()) + 1
        across = last - first + 1
        counts = across.prod(axis=1)
        which = np.repeat(np.arange(len(counts)), counts)
        within = np.arange(len(which)) - np.repeat(np.cumsum(counts) - counts, counts)
        row = first[which, 0] + within // across[which, 1]
        column = first[which, 1] + within % across[which, 1]
        key = row * self.columns + column
        order = np.argsort(key, kind="stable")
        self.held = which[order]
        self.starts = np.searchsorted(key[order], np.arange(self.rows * self.columns + 1))

    def distances(self, tips: Floats, allowed: float) -> Floats:
        """Least signed distance at each tip (N, 3), from below; the worst are measured until one is under `-allowed`, or none."""
        least = np.full(len(tips), np.inf)
        deep_rows, deep_triangles, deep_bounds = [], [], []
        for rows, triangles in self._pairs(tips):
            bounds = self._bounds(tips[rows], triangles)
            deep = bounds < -allowed
            np.minimum.at(least, rows[~deep], bounds[~deep])
            deep_rows.append(rows[deep])
            deep_triangles.append(triangles[deep])
            deep_bounds.append(bounds[deep])
        rows, triangles = np.concatenate(deep_rows), np.concatenate(deep_triangles)
        np.minimum.at(least, rows, -allowed)  # near at least; how deep is measured
        order = np.argsort(np.concatenate(deep_bounds), kind="stable")
        for begin in range(0, len(order), MEASURED):
            chosen = order[begin : begin + MEASURED]
            measured = self._measured(tips[rows[chosen]], triangles[chosen])
            np.minimum.at(least, rows[chosen], measured)
            if measured.min() < -allowed:
                break
        return least

    def _pairs(self, tips: Floats) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """Positions and triangles that may be near each other, whole positions at a time."""
        cells = (
            tips[:, None, :2] + np.array([(-1, -1), (-1, 1), (1, -1), (1, 1)]) * self.radius - self.origin
        ) // self.cell
        inside = np.all((cells >= 0) & (cells < (self.rows, self.columns)), axis=2)
        keys = np.where(inside, cells[..., 0] * self.columns + cells[..., 1], -1).astype(np.int64)
        keys = np.sort(keys, axis=1)
        keys[:, 1:][keys[:, 1:] == keys[:, :-1]] = -1
        counts = np.where(keys >= 0, self.starts[keys + 1] - self.starts[keys], 0)
        total = np.cumsum(counts.sum(axis=1))
        begin = 0
        while begin < len(tips):
            before = total[begin - 1] if begin else 0
            end = max(begin + 1, int(np.searchsorted(total, before + PAIRS, side="right")))
            yield self._near(tips, np.arange(begin, end), keys[begin:end], counts[begin:end])
            begin = end

    def _near(
        self, tips: Floats, rows: np.ndarray, keys: np.ndarray, counts: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        flat = counts.reshape(-1)
        starts = np.repeat(np.where(keys >= 0, self.starts[keys], 0).reshape(-1), flat)
        within = np.arange(int(flat.sum())) - np.repeat(np.cumsum(flat) - flat, flat)
        triangles = self.held[starts + within]
        samples = np.repeat(np.repeat(rows, keys.shape[1]), flat)
        tip = tips[samples]
        aside = np.maximum(np.maximum(self.low[triangles, :2] - tip[:, :2], tip[:, :2] - self.high[triangles, :2]), 0.0)
        apart = np.maximum(np.hypot(aside[:, 0], aside[:, 1]) - self.near, 0.0)
        bottom = np.interp(apart, self.bottom_r, self.bottom_z, right=np.inf) - 0.01 * self.tool.radius - 2 * self.near
        keep = self.high[triangles, 2] > tip[:, 2] + bottom
        return samples[keep], triangles[keep]

    def _planes(self, points: Floats) -> Floats:
        """A distance from below of points (..., 3) that are relative to the tip."""
        r, z = np.hypot(points[..., 0], points[..., 1]), points[..., 2]
        return np.asarray((r[..., None] * self.sine - z[..., None] * self.cosine - self.offsets).max(axis=-1))

    def _bounds(self, tips: Floats, triangles: np.ndarray) -> Floats:
        """Least distance of each pair, from below: on edges by narrowing a grid, and over the face."""
        out = np.full(len(tips), np.inf)
        for begin in range(0, len(tips), 5000):
            part = np.arange(begin, min(begin + 5000, len(tips)))
            corners = self.corners[triangles[part]] - tips[part, None]
            near = self._not_parted(corners)
            corners, part = corners[near], part[near]
            best = self._over_face(corners)
            for i in range(3):
                best = np.minimum(best, self._along(corners[:, i], corners[:, (i + 1) % 3]))
            out[part] = best
        return out

    def _not_parted(self, corners: Floats) -> np.ndarray:
        """Indices of triangles (N, 3, 3) that no plane tried parts from the tool by `near`.

        The plane that is best at a point of the triangle bounds all of it; the point then goes towards the corner that the
        plane is nearest to (Frank and Wolfe).
        """
        left, points = np.arange(len(corners)), corners.mean(axis=1)
        for turn in range(1, PARTED):
            r = np.hypot(points[:, 0], points[:, 1])
            best = (r[:, None] * self.sine - points[:, 2:] * self.cosine - self.offsets).argmax(axis=1)
            out = points[:, :2] / np.maximum(r, 1e-12)[:, None] * self.sine[best][:, None]
            direction = np.column_stack([out, -self.cosine[best]])
            values = np.einsum("ijk,ik->ij", corners[left], direction) - self.offsets[best][:, None]
            keep = values.min(axis=1) < self.near
            left, points, values = left[keep], points[keep], values[keep]
            nearest = corners[left, values.argmin(axis=1)]
            points = points + 2 / (turn + 2) * (nearest - points)
        return left

    def _along(self, start: Floats, end: Floats) -> Floats:
        low, width = self._over_disc(start, end)
        best = np.full(len(start), np.inf)
        rows = np.arange(len(start))
        for _ in range(HALVED):
            shares = low[:, None] + width[:, None] * np.linspace(0.0, 1.0, 5)
            values = self._planes(start[:, None] + shares[..., None] * (end - start)[:, None])
            least = values.argmin(axis=1)
            best = np.minimum(best, values[rows, least])
            step = width / 4
            after = np.minimum(shares[rows, least] + step, low + width)
            low = np.maximum(shares[rows, least] - step, low)
            width = after - low
        return best

    def _over_disc(self, start: Floats, end: Floats) -> tuple[Floats, Floats]:
        """First share and width of the piece of each edge over the tool's disc; the nearest point where none is."""
        direction = (end - start)[:, :2]
        square = np.maximum(np.einsum("ij,ij->i", direction, direction), 1e-30)
        middle = -np.einsum("ij,ij->i", start[:, :2], direction) / square
        off = np.einsum("ij,ij->i", start[:, :2], start[:, :2]) - middle**2 * square
        half = np.sqrt(np.maximum(self.radius**2 - off, 0.0) / square)
        low, high = np.clip(middle - half, 0.0, 1.0), np.clip(middle + half, 0.0, 1.0)
        return low, high - low

    def _over_face(self, corners: Floats) -> Floats:
        """The distance where the touching point of the triangle's plane lies over it, else infinite."""
        foot, held = self._feet(corners)
        return np.where(held, self._planes(foot), np.inf)

    def _feet(self, corners: Floats) -> tuple[Floats, np.ndarray]:
        """Where each triangle's plane is nearest to the tool's touching point, and whether that is on the triangle."""
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        area = np.linalg.norm(normal, axis=1)
        normal = normal / np.where(area > 0, area, 1.0)[:, None]
        upright = np.abs(normal[:, 2]) < 1e-9
        towards_axis = np.einsum("ij,ij->i", normal, corners[:, 0]) > 0
        normal *= np.where(np.where(upright, towards_axis, normal[:, 2] < 0), -1.0, 1.0)[:, None]
        flat = np.hypot(normal[:, 0], normal[:, 1])
        slope = np.arctan2(flat, normal[:, 2])
        r = np.where(flat > 1e-12, np.interp(slope, self.fine, self.touch_r), 0.0)
        z = np.where(flat > 1e-12, np.interp(slope, self.fine, self.touch_z), -self.tool.raised)
        away = -normal[:, :2] / np.where(flat > 1e-12, flat, 1.0)[:, None] * r[:, None]
        touching = np.column_stack([away, z])
        gap = np.einsum("ij,ij->i", touching - corners[:, 0], normal)
        foot = touching - gap[:, None] * normal
        signs = []
        for i in range(3):
            side = np.cross(corners[:, (i + 1) % 3] - corners[:, i], foot - corners[:, i])
            signs.append(np.einsum("ij,ij->i", side, normal))
        turned = np.stack(signs)
        held = (area > 0) & (np.all(turned >= -1e-12, axis=0) | np.all(turned <= 1e-12, axis=0))
        return foot, held

    def _measured(self, tips: Floats, triangles: np.ndarray) -> Floats:
        """The same by the tool's own distance."""
        corners = self.corners[triangles]
        best = np.full(len(tips), np.inf)
        for i in range(3):
            best = np.minimum(best, least_on(self.tool, corners[:, [i, (i + 1) % 3]], tips))
        foot, held = self._feet(corners - tips[:, None])
        return np.where(held, np.minimum(best, self.tool.distance(foot)), best)
