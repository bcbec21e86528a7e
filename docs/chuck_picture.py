"""Draws docs/images/concept-chuck.png: the machine's axes with the chuck above the sheet and below it.

.venv/bin/python docs/chuck_picture.py
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from concept_drawing import BLUE, GREEN, INK, ORANGE, PART_EDGE, outline, plain
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.patches import Polygon, Rectangle
from PIL import Image

import styluscam as sc

PICTURE = Path(__file__).parent / "images" / "concept-chuck.png"
COLOURS = 96
"""Of the picture's palette."""
CUP = [(-30.0, 0.0), (-20.0, 0.0), (-10.0, -10.0), (10.0, -10.0), (20.0, 0.0), (30.0, 0.0)]
"""The formed sheet in section."""
TIP = (12.5, -5.4)
"""Of a ball 6 mm wide on the wall."""


def side(pane: Axes, title: str, way: float) -> None:
    """A cup that opens upwards, or downwards (`way` = -1), its tool, and the axes of the machine at the program's zero."""
    tool = sc.Tool.from_dict({"profile": {"kind": "ball", "diameter": 6.0}})
    sheet = np.array(CUP) * (1.0, way)
    pane.plot(*sheet.T, color=PART_EDGE, lw=3.5, zorder=1, solid_joinstyle="round")
    for x in (-26.0, 26.0):
        pane.add_patch(Rectangle((x - 5.0, -3.0), 10.0, 6.0, facecolor="none", edgecolor=PART_EDGE, hatch="////"))
    shape = outline(tool, TIP, 22.0) * (1.0, way)
    pane.add_patch(Polygon(shape, facecolor=BLUE, alpha=0.18, edgecolor="none", zorder=2))
    pane.plot(*shape.T, color=BLUE, lw=1.3, zorder=3)
    pane.plot(TIP[0], way * TIP[1], "o", color=BLUE, ms=5, zorder=6)
    pane.text(18.5, 20.0 * way, "chuck", color=BLUE, fontsize=10, va="center")
    arrow = {"arrowstyle": "-|>", "lw": 1.8, "shrinkA": 0, "shrinkB": 0}
    for end, name, colour in (((6.5, 0.0), "X", ORANGE), ((0.0, 15.0 * way), "Z", GREEN)):
        pane.annotate("", end, (0.0, 0.0), arrowprops={**arrow, "color": colour}, zorder=5)
        shift = 2.0 * np.sign(end)
        pane.text(end[0] + shift[0], end[1] + shift[1], name, color=colour, fontsize=11, ha="center", va="center")
    # Y goes into the picture above, and comes out of it below
    pane.plot(0.0, 0.0, "o", ms=11, mfc="white", mec=INK, zorder=6)
    pane.plot(0.0, 0.0, "x" if way > 0.0 else "o", ms=7 if way > 0.0 else 3.5, color=INK, zorder=7)
    pane.text(-4.5, -3.5 * way, "Y", color=INK, fontsize=11, ha="center", va="center")
    pane.set_title(title, fontsize=11, color=INK)
    plain(pane, (-34.0, 34.0), (-25.0, 25.0))


def main() -> None:
    """Draws it."""
    figure, panes = plt.subplots(1, 2, figsize=(9.0, 3.8))
    side(panes[0], 'chuck = "above"', 1.0)
    side(panes[1], 'chuck = "below"', -1.0)
    figure.tight_layout()
    figure.savefig(PICTURE, dpi=100)
    with Image.open(PICTURE) as picture:
        small = picture.convert("RGB").quantize(COLOURS)
    small.save(PICTURE, optimize=True)


if __name__ == "__main__":
    main()
