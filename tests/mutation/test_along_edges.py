"""Contours and chamfers: edits by which an edge is entered, left or missed, or the tool plunges into the stock, are found."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

import styluscam as sc
from blocks import box
from convex_tool import Floats
from gcode import Move, Point

from .edits import assert_found

SIZE = (20.0, 16.0, 8.0)
RADIUS, OVER, SIDES, STEP, SLOPE = 3.0, 1.0, 8.0, 4.5, math.tan(math.radians(3.0))
WIDTH = 0.6
"""Of chamfers, mm."""
NEAR = 0.03
"""Edits that change less do not matter, mm."""
ALONG = 0.1
"""Moves are looked at so far apart, mm."""


def job(profile: dict[str, Any], **operation: Any) -> sc.Job:
    common = {"tool": "mill", "feeds": {"cut": 600.0, "plunge": 200.0}, "spindle": {"mode": "fixed", "rpm": 3000.0}}
    stock = {"kind": "box", "top": OVER, "sides": SIDES}
    document = {
        "schema": 1,
        "part": {"file": "block.stl", "units": "mm"},
        "setup": {"zero": "model"} | ({"stock": stock} if operation["kind"] == "contour" else {}),
        "process": {"kind": "milling"},
        "tools": {"mill": {"number": 1, "length": 60.0, "profile": profile}},
        "operations": [common | operation],
        "machine": {"name": "grbl"},
    }
    return sc.Job.from_dict(document, part=sc.Part.from_mesh(*box((0.0, 0.0, 0.0), SIZE)))


def beside(at: Floats, around: float = 0.0) -> Floats:
    """Distances in plan from the block widened by `around`, mm; negative inside."""
    half = np.array(SIZE[:2]) / 2
    over = np.abs(at[:, :2] - half) - half - around
    return np.where((over <= 0.0).all(axis=1), over.max(axis=1), np.hypot(*np.maximum(over, 0.0).T))


def pieces(moves: list[Move]) -> tuple[Floats, Floats, NDArray[np.bool_]]:
    """Moves in short pieces: where these begin and end, and which are rapids."""
    starts: list[Point] = []
    ends: list[Point] = []
    rapid: list[bool] = []
    for move in moves:
        if move.placed:
            count = max(1, math.ceil(move.length / ALONG))
            points = [move.at(i / count) for i in range(count + 1)]
            starts += points[:-1]
            ends += points[1:]
            rapid += [move.kind == "rapid"] * count
    return np.reshape(starts, (-1, 3)), np.reshape(ends, (-1, 3)), np.array(rapid, dtype=bool)


def walls(away: float) -> Floats:
    """Positions so far beside the middles of the four walls."""
    (x, y, _), steps = SIZE, np.linspace(0.05, 0.95, 19)
    return np.array(
        [(x * t, s) for t in steps for s in (-away, y + away)] + [(s, y * t) for t in steps for s in (-away, x + away)]
    )


def missed(points: Floats, passes: Floats) -> float:
    """How far the farthest of some points is from passes, mm."""
    if not len(passes):
        return math.inf
    return float(np.linalg.norm(points[:, None] - passes[:, :2], axis=2).min(axis=1).max())


def of_contour(moves: list[Move]) -> str:
    """What is wrong with a contour round the block: its levels end at Z0, a step apart from the stock's top on."""
    top = SIZE[2] + OVER
    start, end, rapid = pieces(moves)
    height, away = end[:, 2], beside(end)
    if ((height < SIZE[2] - NEAR) & (away < RADIUS - NEAR)).any():
        return "in the wall"
    if (height < -NEAR).any():
        return "too deep"
    in_stock = (height < top - NEAR) & (beside(end, SIDES) < RADIUS - NEAR)
    fall = np.minimum(start[:, 2], top) - height
    steep = fall > SLOPE * np.hypot(*(end - start)[:, :2].T) + NEAR
    for number in np.flatnonzero(in_stock & (rapid | steep)):
        before, at = end[:number][~rapid[:number]], end[number]
        if not ((np.hypot(*(before - at)[:, :2].T) < ALONG) & (before[:, 2] < at[2] + NEAR)).any():
            return "a rapid into the stock" if rapid[number] else "too steep"
    for level in range(1, round(top / STEP) + 1):
        on = ~rapid & (np.abs(top - height - STEP * level) < NEAR)
        if missed(walls(RADIUS), end[on]) > ALONG + NEAR:
            return "a wall is missed"
    return ""


def of_chamfer(moves: list[Move]) -> str:
    """What is wrong with a chamfer of 45 degrees round the block: beside a wall the cone is to come so far into its edge."""
    start, end, rapid = pieces(moves)
    deep = SIZE[2] - end[:, 2] - beside(end)
    low = end[:, 2] < SIZE[2]
    if (low & (deep > WIDTH + NEAR)).any():
        return "too wide"
    if (low & rapid & (deep > NEAR) & (end[:, 2] < start[:, 2])).any():
        return "a rapid into the edge"
    made = end[low & ~rapid & (deep > WIDTH - NEAR)]
    nearest = np.clip(made[:, :2], 0.0, SIZE[:2])
    return "not as wide as asked" if missed(walls(0.0), nearest) > ALONG + NEAR else ""


def test_every_edit_of_a_contour_that_matters_is_found() -> None:
    operation = {"kind": "contour", "edge_side": "outside", "step": {"height": STEP}, "faces": "all", "fit": "arcs"}
    assert_found(job({"kind": "flat", "diameter": 2 * RADIUS}, **operation), of_contour, 100)


def test_every_edit_of_a_chamfer_that_matters_is_found() -> None:
    profile = {"kind": "v", "tip_diameter": 0.0, "angle_deg": 90.0, "diameter": 10.0}
    assert_found(job(profile, kind="chamfer", width=WIDTH, faces="all"), of_chamfer, 60)
