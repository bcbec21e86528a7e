"""Draws the picture of docs/concepts/addendum.md: a bowl with an uneven edge, and the addendum that the engine builds around it.

.venv/bin/python docs/addendum_picture.py
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import trimesh
from concept_drawing import BLUE, GREEN, INK, ORANGE, SOFT
from matplotlib import pyplot as plt
from matplotlib.figure import Figure
from PIL import Image

import styluscam as sc

PICTURE = Path(__file__).parent / "images" / "concept-addendum.png"
COLOURS = 96
"""Of the picture's palette."""


def drawn() -> Figure:
    """A bowl with an uneven edge in its addendum, seen from the side and in section through its lowest and its highest edge."""
    turn, shares = np.radians(np.arange(0.0, 360.0, 3.0)), np.linspace(0.0, 1.0, 25)[1:]
    rings = [
        np.column_stack([30 * s * np.cos(turn), 30 * s * np.sin(turn), 12 * (s * s - 1) + 3 * s * s * np.cos(2 * turn)])
        for s in shares
    ]
    count = len(turn)
    ahead = np.roll(np.arange(count), -1)
    triangles = [np.column_stack([np.zeros(count), 1 + np.arange(count), 1 + ahead])]
    for ring in range(len(rings) - 1):
        a, b = 1 + count * ring + np.arange(count), 1 + count * ring + ahead
        triangles += [np.column_stack([a, a + count, b + count]), np.column_stack([a, b + count, b])]
    bowl = sc.Part.from_mesh(np.concatenate([[[0.0, 0.0, -12.0]], *rings]), np.concatenate(triangles).astype(np.int64))
    document = {
        "schema": 1,
        "part": {
            "file": "bowl.stl",
            "units": "mm",
            "model_face": "tool",
            "tolerance": 0.01,
            "addendum": {"wall_angle_deg": 45.0, "corner_radius": 5.0, "height": 6.0, "flange_width": 10.0},
        },
        "setup": {"sheet": {"thickness": 1.0}},
        "tools": {"ball": {"profile": {"kind": "ball", "diameter": 10.0}}},
        "operations": [{"kind": "z-level", "tool": "ball", "step": {"height": 1.0}}],
        "machine": {"name": "linuxcnc"},
    }
    part = sc.Job.from_dict(document, part=bowl).part()
    vertices, corners, faces, _ = part.engine.arrays()
    figure = plt.figure(figsize=(11.0, 4.6))
    solid = figure.add_subplot(1, 2, 1, projection="3d")
    for face, colour in ((3, SOFT), (2, ORANGE), (1, BLUE)):
        own = corners[faces == face]
        solid.plot_trisurf(*vertices.T, triangles=own, color=colour, linewidth=0.0, alpha=0.35 if face == 3 else 1.0)
    (trim,) = part.engine.trim
    closed = np.vstack([trim, trim[:1]])
    solid.plot(*closed.T, color=INK, lw=1.5, zorder=10)
    solid.set_box_aspect((1.0, 1.0, 0.28))
    solid.view_init(32, -60)
    solid.set_axis_off()
    solid.set_title("part, addendum (a wall of 45°) and blank; black: the trim curve", fontsize=11)
    section = figure.add_subplot(1, 2, 2)
    mesh = trimesh.Trimesh(vertices, corners, process=False)
    for heading, colour in ((0.3, BLUE), (90.3, GREEN)):
        along = np.array([np.cos(np.radians(heading)), np.sin(np.radians(heading)), 0.0])
        cut = trimesh.intersections.mesh_plane(mesh, np.array([-along[1], along[0], 0.0]), np.zeros(3))
        for piece in cut:
            far = piece @ along
            if far.min() >= -1e-9:
                section.plot(far, piece[:, 2], color=colour, lw=2)
    section.axhline(9.0, color=SOFT, lw=0.8, ls="--")
    section.text(1.0, 9.4, "blank's plane", color=SOFT)
    section.text(20.0, -9.5, "through the edge's highest points", color=BLUE)
    section.text(20.0, -12.0, "and through its lowest ones", color=GREEN)
    section.plot([30, 30], [-3, 3], "s", color=INK, ms=5)
    section.set_ylim(-14.0, 13.0)
    section.set_aspect("equal")
    section.set_title("the wall begins at the edge's height, and ends in one plane", fontsize=11)
    return figure


def main() -> None:
    """Draws it."""
    figure = drawn()
    figure.tight_layout()
    figure.savefig(PICTURE, dpi=100)
    with Image.open(PICTURE) as picture:
        small = picture.convert("RGB").quantize(COLOURS)
    small.save(PICTURE, optimize=True)


if __name__ == "__main__":
    main()
