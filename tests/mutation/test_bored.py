"""Bored holes: edits by which the wall is entered or left, the tool plunges, or the hole is not made, are found."""

from __future__ import annotations

import math

import numpy as np

import styluscam as sc
from gcode import Move

from .cases import stack
from .edits import assert_found

DEPTH, RADIUS, TOOL, PITCH = 3.0, 4.0, 2.5, 1.0
NEAR = 0.04
"""Edits that change less do not matter, mm: it is more than the wall's 64 triangles are off."""
RAYS = 36
LEAST = 50


def job() -> sc.Job:
    """A round block with a blind hole in its middle, its floor flat."""
    sides = 64
    vertices, triangles = stack(sides, [(9, -8), (9, 0), (RADIUS, 0), (RADIUS, -DEPTH)])
    faces = [1 + min(number // (2 * sides), 3) for number in range(len(triangles))]
    operation = {"kind": "helix-bore", "tool": "mill", "pitch": PITCH, "feeds": {"cut": 600.0, "plunge": 200.0}}
    document = {
        "schema": 1,
        "part": {"file": "made.stl", "units": "mm"},
        "setup": {"zero": "model", "clearance": 10.0, "retract": 5.0},
        "process": {"kind": "milling"},
        "tools": {"mill": {"number": 1, "profile": {"kind": "flat", "diameter": 2 * TOOL}}},
        "operations": [operation | {"spindle": {"mode": "fixed", "rpm": 3000.0}}],
        "machine": {"name": "grbl"},
    }
    return sc.Job.from_dict(document, part=sc.Part.from_mesh(vertices, triangles, face_ids=faces))


def harm(moves: list[Move]) -> str:
    """What is wrong with the hole, or with the way to it."""
    lowest = np.zeros(RAYS)
    reached = np.full(RAYS, np.inf)
    at_wall = RADIUS - TOOL
    for move in moves:
        if not move.placed:
            continue
        count = max(1, math.ceil(move.length / 0.05))
        for x, y, z in (move.at((i + 1) / count) for i in range(count)):
            out = math.hypot(x, y)
            if z < -NEAR and out > at_wall + NEAR:
                return "in the wall"
            if z < -DEPTH - NEAR:
                return "too deep"
            ray = math.floor(math.atan2(y, x) / (2 * math.pi) * RAYS) % RAYS
            if z < lowest[ray] - PITCH - NEAR - PITCH / RAYS:
                return "deeper at once than the pitch"
            if move.kind == "rapid" and z < lowest.max() - NEAR and z < move.start[2] - NEAR:
                return "a rapid into material"
            if move.kind != "rapid" and out > at_wall - NEAR:
                lowest[ray] = min(lowest[ray], z)
                reached[ray] = min(reached[ray], z)
    return "not bored to its depth" if reached.max() > -DEPTH + NEAR else ""


def test_every_edit_that_matters_is_found() -> None:
    assert_found(job(), harm, LEAST)
