"""Long lines, large arcs and tools of other sizes: what is looked at does not thin out with size."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from conftest import Mesh

import styluscam as sc

HEAD = "G21 G90 G94 G17 G40 G49 G80\nG54\nG64 P0.001 Q0\nT1 M6\nG43 H1\nG0 Z150\n"


def job(mesh: Mesh, *tools: float, **operation: Any) -> sc.Job:
    """Milling with balls of these diameters, an operation each."""
    document = {
        "schema": 1,
        "part": {"file": "made.stl", "units": "mm"},
        "setup": {"zero": "model"},
        "process": {"kind": "milling"},
        "tools": {
            f"D{d:g}": {"number": n + 1, "profile": {"kind": "ball", "diameter": d}} for n, d in enumerate(tools)
        },
        "operations": [
            {
                "id": f"D{d:g}",
                "kind": "zig-zag",
                "tool": f"D{d:g}",
                "stepover": 2.0,
                "spindle": {"mode": "off"},
                **operation,
            }
            for d in tools
        ],
        "machine": {"name": "linuxcnc"},
    }
    return sc.Job.from_dict(document, part=sc.Part.from_mesh(*mesh))


def strip(profile: list[tuple[float, float]], width: float) -> Mesh:
    """A section along X, as wide as that."""
    vertices = np.array([(x, y, z) for x, z in profile for y in (0.0, width)])
    corners = [(2 * i, 2 * i + 1, 2 * i + 2, 2 * i + 3) for i in range(len(profile) - 1)]
    return vertices, np.array([t for a, b, c, d in corners for t in ((a, c, d), (a, d, b))])


@pytest.mark.parametrize("length", [240.0, 1600.0, 6000.0])
def test_a_groove_under_a_long_line_is_seen(length: float) -> None:
    start = 0.3 * length
    groove = strip([(0.0, 0.0), (start, 0.0), (start + 1.5, -2.0), (start + 3.0, 0.0), (length, 0.0)], 20.0)
    text = f"{HEAD}X0.5 Y10\nG1 Z0.001 F300\nX{length - 0.5} F1500\nG0 Z150\nM2\n"
    assert sc.verify(text, job(groove, 1.0)).excess_max > 1.0


@pytest.mark.parametrize("radius", [300.0, pytest.param(3000.0, marks=pytest.mark.long)])
def test_an_arc_is_as_deep_as_it_is_however_large(radius: float) -> None:
    """A ball of 20 mm around a post: the corners of the polygon are met, the depth is that of the circle."""
    depth, count = 0.0009, 3000
    angle = 2.0 * np.pi * np.arange(count) / count
    ring = np.column_stack([np.cos(angle), np.sin(angle)])
    flat = [
        np.column_stack([r * ring, np.full(count, z)])
        for r, z in ((radius, 50.0), (radius, 0.0), (radius + 200.0, 0.0))
    ]
    here, on = np.arange(count), np.roll(np.arange(count), -1)
    quads = [
        np.stack([a, b, c], axis=1)
        for low, high in ((here, here + count), (here + count, here + 2 * count))
        for a, b, c in ((low, high, high - here + on), (low, high - here + on, low - here + on))
    ]
    lid = np.stack([np.full(count, 3 * count), here, on], axis=1)
    post = np.concatenate([*flat, [[0.0, 0.0, 50.0]]]), np.concatenate([lid, *quads])
    travel = radius + 10.0 - depth
    text = f"{HEAD}X{travel:.4f} Y0\nG1 Z20 F300\nG3 I{-travel:.4f} J0 F1500\nG0 Z150\nM2\n"
    report = sc.verify(text, job(post, 20.0))
    assert report.gouge_max == pytest.approx(depth, abs=1e-7)
    assert "gouge" not in {finding["kind"] for finding in report.findings}


def test_a_tool_that_touches_nothing_reports_nothing_as_covered() -> None:
    plate = strip([(0.0, 0.0), (20.0, 0.0)], 20.0)
    rows = "".join(f"G0 X0 Y{y}\nG1 Z0 F300\nX20 F1500\nG0 Z150\n" for y in range(0, 21, 2))
    shares = [
        sc.verify(f"{HEAD}{rows}M2\n", job(plate, *tools)).coverage()[0]["covered"] for tools in ((2.0,), (2.0, 40.0))
    ]
    assert shares[0] == shares[1] < 0.6
