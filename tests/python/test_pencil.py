"""Pencil passes: exact positions between two planes, every concave edge, and what is found where they are moved."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

import styluscam as sc

RADIUS, LENGTH, SIDE = 4.0, 30.0, 20.0
TOLERANCE = 0.005


def valley(left_deg: float, right_deg: float) -> sc.Part:
    """Two planes that rise from the X axis to both sides at these slopes."""

    def far(slope_deg: float, sign: float) -> tuple[float, float]:
        slope = np.radians(slope_deg)
        return sign * SIDE * np.cos(slope), SIDE * np.sin(slope)

    (y0, z0), (y1, z1) = far(left_deg, -1.0), far(right_deg, 1.0)
    points = [[x, y, z] for x in (0.0, LENGTH) for y, z in ((y0, z0), (0.0, 0.0), (y1, z1))]
    return sc.Part.from_mesh(np.array(points), np.array([[0, 3, 4], [0, 4, 1], [1, 4, 5], [1, 5, 2]]))


def job(part: sc.Part, profile: dict[str, Any] | None = None, **keys: Any) -> sc.Job:
    document = {
        "schema": 1,
        "part": {"file": "valley.stl", "units": "mm"},
        "setup": {"zero": "model"},
        "process": {"kind": "milling"},
        "tools": {"mill": {"profile": profile or {"kind": "ball", "diameter": 2.0 * RADIUS}}},
        "machine": {"name": "linuxcnc", "options": {"decimals": 4}},
        "operations": [
            {
                "kind": "pencil",
                "tool": "mill",
                "tolerance": TOLERANCE,
                "spindle": {"mode": "fixed", "rpm": 8000.0},
                **keys,
            }
        ],
    }
    return sc.Job.from_dict(document, part=part)


def text_of(asked: sc.Job) -> str:
    return str(next(iter(sc.post(sc.plan(asked)).files.values())))


@pytest.mark.parametrize(("left", "right"), [(30.0, 30.0), (20.0, 50.0), (0.0, 60.0)])
def test_the_ball_runs_where_it_touches_both_planes(left: float, right: float) -> None:
    """Its middle is a radius off both: n . p = R for both normals."""
    asked = job(valley(left, right))
    program = sc.plan(asked).programs["main"]
    cut = program.moves[(program.moves["kind"] != 0) & (program.moves["end"][:, 2] < RADIUS)]
    slopes = np.radians([left, right])
    normals = np.array([[np.sin(slopes[0]), np.cos(slopes[0])], [-np.sin(slopes[1]), np.cos(slopes[1])]])
    middle = np.linalg.solve(normals, [RADIUS, RADIUS])
    ends = cut["end"]
    assert len(ends) >= 2
    assert np.abs(ends[:, 1] - middle[0]).max() <= 2.0 * TOLERANCE
    assert np.abs(ends[:, 2] + RADIUS - middle[1]).max() <= 2.0 * TOLERANCE
    assert ends[:, 0].min() < 0.2 and ends[:, 0].max() > LENGTH - 0.2
    report = sc.verify(sc.post(sc.plan(asked)), asked)
    assert report.ok and {finding.kind for finding in report.findings} == {"not-checked"}


def test_edges_flatter_than_asked_are_left_out() -> None:
    part = valley(10.0, 10.0)
    assert sc.plan(job(part, least_turn_deg=19.0)).programs["main"].moves.size > 0
    with pytest.raises(sc.StylusError, match="concave edge"):
        sc.plan(job(part, least_turn_deg=21.0))


def test_convex_edges_have_none() -> None:
    roof = sc.Part.from_mesh(
        np.array([[x, y, z] for x in (0.0, 30.0) for y, z in ((-10.0, 0.0), (0.0, 8.0), (10.0, 0.0))]),
        np.array([[0, 3, 4], [0, 4, 1], [1, 4, 5], [1, 5, 2]]),
    )
    with pytest.raises(sc.StylusError, match="concave edge"):
        sc.plan(job(roof))


def test_the_foot_of_a_round_boss_is_followed_without_climbing_it() -> None:
    """Chords of a convex wall lie in it: a tool that follows them is lifted over the wall."""
    turns = 2.0 * np.pi * np.arange(120) / 120
    rings = [(40.0, 0.0), (10.0, 0.0), (10.0, 15.0)]
    points = [[r * np.cos(a), r * np.sin(a), z] for r, z in rings for a in turns] + [[0.0, 0.0, 15.0]]
    triangles = []
    for first in (0, 120):
        for k in range(120):
            a, b = first + k, first + (k + 1) % 120
            triangles += [[a, b, b + 120], [a, b + 120, a + 120]]
    triangles += [[240 + k, 240 + (k + 1) % 120, 360] for k in range(120)]
    asked = job(sc.Part.from_mesh(np.array(points), np.array(triangles)))
    program = sc.plan(asked).programs["main"]
    cut = program.moves[(program.moves["kind"] != 0) & (program.moves["end"][:, 2] < 5.0)]["end"]
    assert cut[:, 2].max() < 0.02
    assert np.abs(np.hypot(cut[:, 0], cut[:, 1]) - 10.0 - RADIUS).max() < 0.01
    assert sc.verify(sc.post(sc.plan(asked)), asked).ok


@pytest.mark.parametrize(("by", "found"), [(-0.02, "gouge"), (0.05, "excess")])
def test_a_pass_beside_the_edge_is_found(by: float, found: str) -> None:
    asked = job(valley(30.0, 30.0))
    text = text_of(asked)
    (depth,) = re.findall(r"^G1 Z(\S+)", text, re.MULTILINE)
    moved = text.replace(f"G1 Z{depth}", f"G1 Z{float(depth) + by:.4f}")
    assert found in {finding.kind for finding in sc.verify(moved, asked).findings}
