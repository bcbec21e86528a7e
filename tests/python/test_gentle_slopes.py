"""Passes by scallop over slopes on which a small error of the tool's height or distance is a long way along the wall."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

import styluscam as sc


def wedge(size: float, slope_deg: float) -> sc.Part:
    """An upright block of a square `size` (mm) in plan, whose top falls towards -Y."""
    half, fall = size / 2, size * math.tan(math.radians(slope_deg))
    corners = np.array([[-half, -half], [half, -half], [half, half], [-half, half]])
    top = np.column_stack([corners, [-fall, -fall, 0.0, 0.0]])
    bottom = np.column_stack([corners, np.full(4, -2.0 * fall)])
    sides = [[a, a + 4, b] for a, b in ((0, 1), (1, 2), (2, 3), (3, 0))]
    sides += [[a + 4, b + 4, b] for a, b in ((0, 1), (1, 2), (2, 3), (3, 0))]
    return sc.Part.from_mesh(np.concatenate([top, bottom]), np.array([[0, 1, 2], [0, 2, 3], *sides]))


def cone(radius: float, slope_deg: float, facets: int = 720) -> sc.Part:
    """A cone that stands on its rim of a `radius` (mm)."""
    angles = np.linspace(0.0, 2.0 * np.pi, facets, endpoint=False)
    rim = np.column_stack([radius * np.cos(angles), radius * np.sin(angles), 0.0 * angles])
    here = np.arange(facets)
    tip = [[0.0, 0.0, radius * math.tan(math.radians(slope_deg))]]
    return sc.Part.from_mesh(
        np.concatenate([rim, tip]), np.column_stack([here, (here + 1) % facets, 0 * here + facets])
    )


def verified(part: sc.Part, **operation: Any) -> sc.Report:
    document = {
        "schema": 1,
        "part": {"file": "slope.stl", "units": "mm"},
        "process": {"kind": "milling"},
        "tools": {"ball": {"profile": {"kind": "ball", "diameter": 6.0}}},
        "operations": [{"tool": "ball", "spindle": {"mode": "fixed", "rpm": 8000.0}, **operation}],
        "machine": {"name": "linuxcnc"},
    }
    asked = sc.Job.from_dict(document, part=part)
    return sc.verify(sc.post(sc.plan(asked)), asked)


def test_turns_of_a_spiral_are_even_along_a_straight_side() -> None:
    """The sides of its loops are as long as the block: they have no points of their own that belong together."""
    report = verified(wedge(40.0, 8.0), kind="spiral", step={"scallop": 0.15}, tolerance=0.02)
    assert not report.findings


def test_levels_leave_the_scallop_whatever_the_tolerance() -> None:
    """A chord that is off the wall, at its height, lies elsewhere along it: on 12 degrees, five times as far."""
    report = verified(cone(15.0, 12.0), kind="z-level", step={"scallop": 0.05}, tolerance=0.05)
    assert not report.findings
