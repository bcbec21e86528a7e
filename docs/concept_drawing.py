"""What the pictures of docs/concepts are drawn with: parts in section, tools, panes and remarks."""

from __future__ import annotations

import matplotlib as mpl
import numpy as np

import styluscam as sc
from styluscam.types import FloatArray

mpl.use("agg")

from matplotlib.axes import Axes
from matplotlib.patches import Polygon

PART, PART_EDGE, INK, SOFT = "#dfe4ea", "#69758a", "#1f2933", "#69758a"
BLUE, ORANGE, GREEN, PINK, SKY = "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9"
WIDE = 40.0
"""Half the length along Y of a part that is shown in section, mm: much longer than the tools are wide."""

Section = list[tuple[float, float]]


def mesh_of(section: Section) -> tuple[FloatArray, list[tuple[int, int, int]]]:
    """Vertices and triangles of a section in X and Z, drawn out along Y."""
    points = np.array([(x, y, z) for x, z in section for y in (-WIDE, WIDE)])
    pieces = range(len(section) - 1)
    return points, [t for i in pieces for t in ((2 * i, 2 * i + 2, 2 * i + 3), (2 * i, 2 * i + 3, 2 * i + 1))]


def drawn_out(section: Section) -> sc.Part:
    """The part of a section in X and Z, drawn out along Y."""
    return sc.Part.from_mesh(*mesh_of(section))


def arc(centre: tuple[float, float], radius: float, first_deg: float, last_deg: float) -> Section:
    """Points of an arc; its angles count from straight below, turning left."""
    angles = np.radians(np.linspace(first_deg, last_deg, 48))
    return [(centre[0] + radius * float(np.sin(a)), centre[1] - radius * float(np.cos(a))) for a in angles]


def outline(tool: sc.Tool, tip: tuple[float, float], top: float) -> FloatArray:
    """The tool's section (N, 2) with its tip at a point, up to a height."""
    slopes = np.linspace(0.0, tool.max_slope, 200)
    right = np.stack([tool.radius_at(slopes), tool.height_at(slopes)], axis=1)
    right = np.concatenate([[(0.0, 0.0)], right, [(right[-1, 0], max(top - tip[1], right[-1, 1]))]])
    return np.concatenate([right[::-1] * (-1.0, 1.0), right]) + tip


def draw_tool(
    pane: Axes, tool: sc.Tool, tip: tuple[float, float], top: float, colour: str, *, alpha: float = 0.18
) -> None:
    """The tool, and a dot at its tip."""
    shape = outline(tool, tip, top)
    pane.add_patch(Polygon(shape, facecolor=colour, alpha=alpha, edgecolor="none", zorder=2))
    pane.plot(*shape.T, color=colour, lw=1.3, zorder=3)
    pane.plot(*tip, "o", color=colour, ms=5, zorder=6)


def draw_section(pane: Axes, section: Section, floor: float) -> None:
    """The part in section, down to a height."""
    points = [(section[0][0], floor), *section, (section[-1][0], floor)]
    pane.add_patch(Polygon(points, facecolor=PART, edgecolor="none", zorder=0))
    pane.plot(*np.array(section).T, color=PART_EDGE, lw=1.6, zorder=1)


def plain(pane: Axes, x: tuple[float, float], z: tuple[float, float]) -> None:
    """A pane to scale and without axes."""
    pane.set_xlim(*x)
    pane.set_ylim(*z)
    pane.set_aspect("equal")
    pane.axis("off")


def labelled(pane: Axes, x: str, y: str) -> None:
    """A pane with axes."""
    pane.set_xlabel(x)
    pane.set_ylabel(y)
    pane.spines[["top", "right"]].set_visible(False)
    pane.grid(color="#e4e8ee", lw=0.8)
    pane.set_axisbelow(True)


def note(pane: Axes, text: str, at: tuple[float, float], text_at: tuple[float, float], colour: str = INK) -> None:
    """A remark with a line to what it is about."""
    arrow = {"arrowstyle": "-", "color": colour, "lw": 0.9, "shrinkA": 2, "shrinkB": 3}
    pane.annotate(text, at, text_at, color=colour, fontsize=10, arrowprops=arrow, zorder=9, ha="center", va="center")
