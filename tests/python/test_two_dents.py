"""Two dents in a sheet, one deeper than the other, and the rim of a bowl: what belongs to one side is not asked of the other."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import styluscam as sc


def dents(*at: tuple[float, float, float, float], half: tuple[float, float] = (18.0, 10.0)) -> sc.Part:
    """A grid over which cones with rounded floors (x, y, rim's radius, depth; mm) are let down."""
    x, y = np.meshgrid(np.linspace(-half[0], half[0], 73), np.linspace(-half[1], half[1], 41), indexing="ij")
    z = np.zeros_like(x)
    for cx, cy, radius, depth in at:
        inside = np.clip(1.2 * (radius - np.hypot(x - cx, y - cy)), 0.0, depth)
        z -= depth * np.sin(0.5 * np.pi * inside / depth)
    number = np.arange(z.size).reshape(z.shape)
    a, b, c, d = number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]
    triangles = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
    return sc.Part.from_mesh(np.stack([x, y, z], -1).reshape(-1, 3), triangles)


def job(part: sc.Part, process: str = "milling", **operation: Any) -> sc.Job:
    document = {
        "schema": 1,
        "part": {"file": "dents.stl", "units": "mm", **({"model_face": "tool"} if process == "spif" else {})},
        "process": {"kind": process},
        "setup": {"sheet": {"thickness": 1.0}} if process == "spif" else {},
        "tools": {"ball": {"profile": {"kind": "ball", "diameter": 4.0}}},
        "operations": [
            {
                "tool": "ball",
                "step": {"height": 1.0},
                "tolerance": 0.01,
                "spindle": {"mode": "fixed", "rpm": 8000.0},
                **operation,
            }
        ],
        "machine": {"name": "linuxcnc"},
    }
    return sc.Job.from_dict(document, part=part)


@pytest.mark.parametrize(
    "operation",
    [{"kind": "spiral"}, {"kind": "z-level", "ramp_angle_deg": 6.0, "lead": "tangent", "lead_radius": 1.0}],
    ids=["spiral", "ramps and leads"],
)
def test_programs_for_two_depths_are_sound(operation: dict[str, Any]) -> None:
    asked = job(dents((-8.0, 0.0, 7.0, 6.0), (8.5, 0.0, 6.0, 4.0)), **operation)
    report = sc.verify(sc.post(sc.plan(asked)).text, asked)
    assert report.ok and not {finding["kind"] for finding in report.findings} & {"missing-pass", "missing-level"}


def test_a_tool_on_the_rim_of_a_bowl_does_not_press_down_what_lies_outside() -> None:
    """The sheet is clamped there."""
    angles = np.linspace(0.0, 2.0 * np.pi, 97)[:-1]
    rings = [
        np.stack([r * np.cos(angles), r * np.sin(angles), 0.0 * angles + z], -1) for r, z in ((14, 0), (9, -5), (3, -6))
    ]
    here = np.arange(96)
    there = np.roll(here, -1)
    sides = [
        np.concatenate([np.stack([o + here, i + there, i + here], -1), np.stack([o + here, o + there, i + there], -1)])
        for o, i in ((0, 96), (96, 192))
    ]
    floor = np.stack([0 * here[1:-1] + 192, 192 + here[1:-1], 192 + there[1:-1]], -1)
    triangles = np.concatenate([*sides, floor])
    normals = np.cross(
        *(np.concatenate(rings)[triangles[:, i]] - np.concatenate(rings)[triangles[:, 0]] for i in (1, 2))
    )
    triangles[normals[:, 2] < 0.0] = triangles[normals[:, 2] < 0.0][:, ::-1]
    asked = job(
        sc.Part.from_mesh(np.concatenate(rings), triangles),
        "spif",
        kind="z-level",
        step={"height": 0.5},
        smallest_feature=0.5,
    )
    moves = sc.read_gcode(sc.post(sc.plan(asked)).text, "linuxcnc").moves
    low = moves["end"][moves["end"][:, 2] < -0.1]
    assert len(low) > 100 and np.hypot(low[:, 0], low[:, 1]).max() < 14.0
