"""Plans on coarse triangles, where what a path does between two positions is not smooth."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from conftest import Floats, Mesh

import styluscam as sc


def job(mesh: Mesh, profile: dict[str, Any] | None = None, **operation: Any) -> sc.Job:
    """Milling by a ball of 6 mm, or another tool."""
    document = {
        "schema": 1,
        "part": {"file": "made.stl", "units": "mm"},
        "setup": {},
        "process": {"kind": "milling"},
        "tools": {"ball": {"profile": profile or {"kind": "ball", "diameter": 6.0}}},
        "operations": [{"tool": "ball", "spindle": {"mode": "fixed", "rpm": 8000.0}, **operation}],
        "machine": {"name": "linuxcnc"},
    }
    return sc.Job.from_dict(document, part=sc.Part.from_mesh(*mesh))


def net(x: Floats, y: Floats, z: Floats) -> Mesh:
    """Two triangles for each cell of a grid of points (N, M)."""
    columns = z.shape[1]
    corner = np.arange(z.size).reshape(z.shape)[:-1, :-1].reshape(-1)
    right, up = corner + 1, corner + columns
    triangles = np.concatenate([np.stack([corner, right, up + 1], 1), np.stack([corner, up + 1, up], 1)])
    return np.stack([x, y, z], axis=-1).reshape(-1, 3), triangles


def waves(cell: float) -> Mesh:
    """Hills and valleys over 60 x 60 mm, in cells of this size."""
    axis = np.arange(0.0, 60.0 + 0.5 * cell, cell)
    x, y = np.meshgrid(axis, axis)
    return net(x, y, 4.0 * np.sin(x / 7.0) * np.cos(y / 9.0) + 1.5 * np.sin(x / 2.9 + y / 4.3))


def turned(radii: Floats, heights: Floats) -> Mesh:
    """A meridian turned about Z, from outside in."""
    angles = np.linspace(0.0, 2.0 * np.pi, 181)
    x, y = (np.outer(radii, turn) for turn in (np.cos(angles), np.sin(angles)))
    return net(x, y, np.repeat(heights[:, None], angles.size, axis=1))


@pytest.mark.parametrize("angle_deg", [0.0, 20.0, 77.0])
@pytest.mark.parametrize("cell", [1.0, 2.0, 4.0])
def test_rows_over_facets_enter_nothing(cell: float, angle_deg: float) -> None:
    rows = job(waves(cell), kind="zig-zag", stepover=0.7, angle_deg=angle_deg, tolerance=0.005)
    report = sc.verify(sc.post(sc.plan(rows)).text, rows)
    assert report.ok
    assert report.gouge_max == 0.0
    assert report.excess_max <= 0.005


SHARP = {
    "v": {"kind": "v", "tip_diameter": 0.5, "angle_deg": 60.0, "diameter": 6.0},
    "cone": {"kind": "cone", "tip_radius": 0.5, "half_angle_deg": 30.0, "diameter": 6.0},
    "flat": {"kind": "flat", "diameter": 6.0},
}


@pytest.mark.parametrize("turn_deg", [0.0, 17.0])
@pytest.mark.parametrize("profile", SHARP)
@pytest.mark.parametrize("kind", ["z-level", "zig-zag"])
def test_rims_and_tips_ride_over_corners(profile: str, kind: str, turn_deg: float) -> None:
    """They meet a corner of the triangles for a tenth of a millimetre of their path: links and rows rise over it."""
    axis = np.linspace(-20.0, 20.0, 31)
    x, y = np.meshgrid(axis, axis)
    turn = np.radians(turn_deg)
    z = (
        4.0 * np.sin(x / 5.0) * np.cos(y / 6.0)
        if kind == "z-level"
        else np.round(3.0 * np.sin(x / 6.0) + 2.0 * np.cos(y / 5.0))
    )
    mesh = net(x * np.cos(turn) - y * np.sin(turn), x * np.sin(turn) + y * np.cos(turn), z)
    pitch: dict[str, Any] = {"step": {"height": 2.0}} if kind == "z-level" else {"stepover": 3.0, "angle_deg": 37.0}
    of = job(mesh, SHARP[profile], kind=kind, tolerance=0.02, **pitch)
    report = sc.verify(sc.post(sc.plan(of)).text, of)
    assert report.gouge_max <= 0.001
    assert report.excess_max <= 0.02


ARC = np.linspace(0.0, 0.5 * np.pi, 60)
ROUND = {
    "dome": turned(10.0 * np.cos(ARC) + 1e-3, 10.0 * np.sin(ARC)),
    "bowl": turned(10.0 * np.cos(ARC) + 1e-3, -10.0 * np.sin(ARC)),
    "ring": turned(12.0 + 4.0 * np.cos(2.0 * ARC), 4.0 * np.sin(2.0 * ARC)),
}


@pytest.mark.parametrize("part", ROUND)
def test_levels_begin_and_end_where_the_tool_first_and_last_touches(part: str) -> None:
    levels = job(ROUND[part], kind="z-level", step={"height": 1.2}, tolerance=0.02, z_bottom=-20.0)
    report = sc.verify(sc.post(sc.plan(levels)).text, levels)
    assert report.ok
    assert "missing-level" not in {finding["kind"] for finding in report.findings}
    lowest = {"dome": -3.0, "bowl": -10.0, "ring": -3.0}[part]
    assert report.program.moves["end"][:, 2].min() == pytest.approx(lowest, abs=0.1)
