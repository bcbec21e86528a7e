"""Drilled holes: edits of a word, and lines left out, by which the drill breaks or the hole is not made, are found."""

from __future__ import annotations

import math
from typing import Any

import pytest

import styluscam as sc
from gcode import Move

from .cases import stack
from .edits import assert_found

DEPTH, PECK, RADIUS = 6.0, 2.0, 2.5
NEAR = 0.02
"""Edits that change less do not matter, mm."""
LEAST = 50
"""Edits that matter, at least."""


def job(cycle: dict[str, Any]) -> sc.Job:
    """A round block with a blind hole in its middle, its floor flat, on a machine without cycles."""
    sides = 48
    vertices, triangles = stack(sides, [(9, -8), (9, 0), (RADIUS, 0), (RADIUS, -DEPTH)])
    faces = [1 + min(number // (2 * sides), 3) for number in range(len(triangles))]
    document = {
        "schema": 1,
        "part": {"file": "made.stl", "units": "mm"},
        "setup": {"zero": "model", "clearance": 10.0, "retract": 5.0},
        "process": {"kind": "milling"},
        "tools": {"drill": {"number": 1, "profile": {"kind": "v", "diameter": 2 * RADIUS, "angle_deg": 118.0}}},
        "operations": [
            {
                "kind": "drill",
                "tool": "drill",
                "cycle": cycle,
                "feeds": {"plunge": 200.0},
                "spindle": {"mode": "fixed", "rpm": 3000.0},
            }
        ],
        "machine": {"name": "grbl"},
    }
    return sc.Job.from_dict(document, part=sc.Part.from_mesh(vertices, triangles, face_ids=faces))


def harm(moves: list[Move], peck: float) -> str:
    """What is wrong with the hole, or with the way to it."""
    drilled = 0.0
    begun: float | None = None
    for move in moves:
        if not move.placed:
            continue
        (x, y, high), (to_x, to_y, low) = move.start, move.end
        is_down = low < high and math.hypot(to_x - x, to_y - y) < 1e-6
        if min(high, low) < -NEAR and max(math.hypot(x, y), math.hypot(to_x, to_y)) > NEAR:
            return "beside the hole"
        if low < -DEPTH - NEAR:
            return "too deep"
        if move.kind == "rapid" and low < high and low < drilled - NEAR:
            return "a rapid into material"
        if move.kind == "rapid" or not is_down:
            begun = None
            continue
        begun = min(high, drilled) if begun is None else begun
        if begun - low > peck + NEAR:
            return "a peck too deep"
        drilled = min(drilled, low)
    return "not drilled to its depth" if drilled > -DEPTH + NEAR else ""


@pytest.mark.parametrize("kind", ["drill", "peck", "chip-break"])
def test_every_edit_that_matters_is_found(kind: str) -> None:
    cycle = {"kind": kind} if kind == "drill" else {"kind": kind, "peck": PECK}
    peck = math.inf if kind == "drill" else PECK
    assert_found(job(cycle), lambda moves: harm(moves, peck), LEAST if kind != "drill" else LEAST // 3)
