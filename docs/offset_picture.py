"""Draws the picture of docs/guide.md: a part and its offset surface, coloured by flag.

.venv/bin/python docs/offset_picture.py
"""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import numpy as np
from PIL import Image

import styluscam as sc
from styluscam.drawing.raster import View, rasterise
from styluscam.offset.surface import COLOURS, FLAGS
from styluscam.types import FloatArray

mpl.use("agg")

from matplotlib import pyplot as plt
from matplotlib.patches import Patch

PICTURE = Path(__file__).parent / "images" / "offset-surface.png"
WIDTH, HEIGHT, FINER = 560, 400, 2
LIGHT = np.array([-0.35, -0.45, 0.82])
DEPTH = 26.0
"""Of the part along Y, mm."""


def arc(centre: tuple[float, float], radius: float, first_deg: float, last_deg: float) -> list[tuple[float, float]]:
    """Points of an arc, its angles as a clock's hand from below, turning left."""
    angles = np.radians(np.linspace(first_deg, last_deg, 40))
    return [(centre[0] + radius * float(np.sin(a)), centre[1] - radius * float(np.cos(a))) for a in angles]


def part() -> sc.Part:
    """A plateau, a wall of 80 deg with a sharp foot, a floor, a fillet, a ridge, an overhang: drawn out along Y."""
    fillet = arc((24.0, 1.5), 1.5, 0.0, 50.0)
    foot = fillet[-1]
    ridge = (foot[0] + 8.0, foot[1] + 8.0 * float(np.tan(np.radians(50.0))))
    section = [(0.0, 10.0), (9.0, 10.0), (10.8, 0.0), *fillet, ridge, (ridge[0] + 6.0, ridge[1])]
    section += [(ridge[0] + 4.0, 0.0), (ridge[0] + 14.0, 0.0)]
    points = np.array([(x, y, z) for x, z in section for y in (0.0, DEPTH)])
    pieces = range(len(section) - 1)
    triangles = [t for i in pieces for t in ((2 * i, 2 * i + 2, 2 * i + 3), (2 * i, 2 * i + 3, 2 * i + 1))]
    return sc.Part.from_mesh(points, triangles)


def drawn(view: View, found: sc.OffsetSurface, points: FloatArray) -> FloatArray:
    """The triangles at ``points``, each pixel in the colour of the nearest corner's flag."""
    raster = rasterise(view.finer(FINER), points, found.triangles)
    hit = raster.triangle >= 0
    corners = found.triangles[raster.triangle[hit]]
    nearest = np.take_along_axis(corners, raster.weights[hit].argmax(axis=1)[:, None], axis=1)[:, 0]
    light = 0.62 + 0.38 * np.abs(found.normals[nearest] @ LIGHT)
    image = np.ones((*hit.shape, 3))
    image[hit] = np.array(COLOURS)[found.flags[nearest]] / 255.0 * light[:, None]
    return np.asarray(image.reshape(HEIGHT, FINER, WIDTH, FINER, 3).mean(axis=(1, 3)))


def main() -> None:
    """Draws it."""
    tool = sc.Tool.from_dict({"profile": {"kind": "ball", "diameter": 6.0, "radius": 3.1}})
    found = sc.offset_surface(part(), tool)
    view = View(-68.0, 38.0, WIDTH, HEIGHT).framed(np.concatenate([found.contacts, found.points]), 12.0)
    figure, panes = plt.subplots(1, 2, figsize=(11.2, 4.6), dpi=100)
    for pane, points, title in zip(panes, (found.contacts, found.points), ("the part", "the tool's tips"), strict=True):
        pane.imshow(drawn(view, found, points))
        pane.set_title(title)
        pane.axis("off")
    shown = [Patch(color=np.array(COLOURS[flag]) / 255.0, label=FLAGS[flag]) for flag in np.unique(found.flags)]
    figure.legend(handles=shown, loc="lower center", ncol=len(shown), frameon=False)
    figure.subplots_adjust(left=0.01, right=0.99, top=0.92, bottom=0.09, wspace=0.02)
    figure.savefig(PICTURE)
    with Image.open(PICTURE) as picture:
        small = picture.convert("RGB").quantize(64)
    small.save(PICTURE, optimize=True)


if __name__ == "__main__":
    main()
