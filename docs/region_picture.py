"""Draws the picture of docs/concepts/regions.md: rows on one of two cups, within three bounds."""

from __future__ import annotations

from typing import Any

import numpy as np
from concept_drawing import BLUE, ORANGE, plain
from matplotlib import pyplot as plt
from matplotlib.figure import Figure

import styluscam as sc


def cups() -> sc.Part:
    """Two cups of 45 degrees in rings of land: faces 1 to 3 are land, wall and floor of the left one."""
    angles = np.radians(np.arange(0.0, 360.0, 5.0))
    count = len(angles)
    sizes = ((18.0, 0.0), (16.0, 0.0), (4.0, -12.0))
    vertices, triangles, faces = [], [], []
    for cup, middle in enumerate((-19.0, 19.0)):
        first = cup * (3 * count + 1)
        rings = [
            np.stack([middle + r * np.cos(angles), r * np.sin(angles), np.full(count, z)], axis=1) for r, z in sizes
        ]
        vertices += [*rings, np.array([[middle, 0.0, -12.0]])]
        for k in range(2):
            for i in range(count):
                a, b = first + count * k + i, first + count * k + (i + 1) % count
                triangles += [(a, b, a + count), (b, b + count, a + count)]
            faces += [3 * cup + k + 1] * (2 * count)
        triangles += [
            (first + 2 * count + i, first + 2 * count + (i + 1) % count, first + 3 * count) for i in range(count)
        ]
        faces += [3 * cup + 3] * count
    return sc.Part.from_mesh(np.vstack(vertices), np.array(triangles), face_ids=np.array(faces))


def regions() -> Figure:
    """Rows on one of two cups: all, those clear of check faces, and those inside a wire with an island."""
    figure, panes = plt.subplots(1, 3, figsize=(11.4, 4.4))
    outer = [[-40.0, -13.0], [0.0, -13.0], [0.0, 13.0], [-40.0, 13.0]]
    island = [[-16.0, -5.0], [-6.0, -5.0], [-6.0, 5.0], [-16.0, 5.0]]
    bounds: list[tuple[str, dict[str, Any]]] = [
        ("the wall of one cup", {}),
        ("2 mm off floor and land", {"check_faces": "rest", "check_clearance": 2.0}),
        ("the axis inside a wire with an island", {"boundary": {"wire": [outer, island]}}),
    ]
    turns = np.radians(np.linspace(0.0, 360.0, 121))
    for pane, (title, keys) in zip(panes, bounds, strict=True):
        document = {
            "schema": 1,
            "part": {"file": "cups.stl", "units": "mm", "faces": ["Face2"]},
            "process": {"kind": "milling"},
            "tools": {"ball": {"number": 1, "profile": {"kind": "ball", "diameter": 6.0}}},
            "operations": [{"kind": "zig-zag", "tool": "ball", "stepover": 1.5, "spindle": {"mode": "off"}, **keys}],
            "machine": {"name": "linuxcnc"},
        }
        moves = sc.plan(sc.Job.from_dict(document, part=cups())).programs["main"].moves
        for radius in (18.0, 16.0, 4.0):
            pane.plot(-19.0 + radius * np.cos(turns), radius * np.sin(turns), color="#9aa5b4", lw=1.0)
        for loop in (outer, island) if "boundary" in keys else ():
            pane.plot(*np.array([*loop, loop[0]]).T, color=ORANGE, lw=1.8)
        cuts = moves["kind"] == 1
        ends = moves["end"]
        for i in np.flatnonzero(cuts[1:] & cuts[:-1]) + 1:
            pane.plot(*ends[i - 1 : i + 1, :2].T, color=BLUE, lw=1.0)
        plain(pane, (-41.0, 2.0), (-20.0, 24.0))
        pane.set_title(title, fontsize=11, y=0.93)
    return figure
