"""The section through a forming job, along X: the sheet with its thickness, flat and formed, what holds it, die and tools."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from styluscam.drawing.shapes import OTHER_TOOL, TOOL, Around, Look, Shape
from styluscam.tools.outline import silhouette
from styluscam.tools.tool import Tool
from styluscam.types import FloatArray, IntArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes

ASIDE = 1.234e-6
"""By which share of the size the plane goes beside round numbers, so that no point lies in it."""

LAYERS = ("clamp", "backing", "die", "blank", "formed-sheet")
"""In the order in which they are drawn."""

INK = "#1f2933"

LEAST = 0.35
"""Opacity of what is cut: it is small, and lies on white."""


def section(shape: Shape, y: float) -> list[FloatArray]:
    """The outlines (N, 2), X and Z in mm, of a shape's section by the plane at ``y``; each closed."""
    points, number = np.unique(np.round(shape.vertices, 9), axis=0, return_inverse=True)
    triangles = number.reshape(-1)[shape.triangles]
    above = points[:, 1] > y + ASIDE * float(np.ptp(points[:, 1]))
    crossed = triangles[above[triangles].any(axis=1) & ~above[triangles].all(axis=1)]
    sides = np.sort(np.stack([crossed, np.roll(crossed, -1, axis=1)], axis=-1), axis=-1)
    cut = sides[above[sides[..., 0]] != above[sides[..., 1]]].reshape(-1, 2, 2)
    keys = cut[..., 0] * len(points) + cut[..., 1]
    loops = _chained(keys)
    return [_points_on(points, np.stack([loop // len(points), loop % len(points)], axis=1), y) for loop in loops]


def _chained(pairs: IntArray) -> list[IntArray]:
    """Closed chains of numbers, of which each pair (N, 2) is a link."""
    beside: dict[int, list[int]] = {}
    for a, b in pairs.tolist():
        beside.setdefault(a, []).append(b)
        beside.setdefault(b, []).append(a)
    loops = []
    while beside:
        first = min(beside)
        loop, at = [first], first
        while beside.get(at):
            following = beside[at].pop()
            beside[following].remove(at)
            loop.append(following)
            at = following
        beside = {key: others for key, others in beside.items() if others}
        loops.append(np.array(loop))
    return loops


def _points_on(points: FloatArray, sides: IntArray, y: float) -> FloatArray:
    """Where sides cross the plane, (N, 2)."""
    a, b = points[sides[:, 0]], points[sides[:, 1]]
    share = np.clip((y - a[:, 1]) / (b[:, 1] - a[:, 1]), 0.0, 1.0)[:, None]
    return np.asarray((a + (b - a) * share)[:, [0, 2]])


def draw_section(axes: Axes, around: Around, y: float, tool: Tool | None, tips: tuple[FloatArray, FloatArray]) -> None:
    """Draws the section at ``y`` and the tools, each where its tip (3,) is; none where that is not a number."""
    tip, other = tips
    for key in LAYERS:
        for shape in around.shapes:
            if shape.key == key:
                _fill(axes, section(shape, y), shape.look, key)
    box = around.box
    height = 0.75 * float(np.ptp(box[:, 0]))
    if np.isfinite(other).all() and around.opposite is not None:
        _silhouette(axes, around.opposite.tool, other, -height, OTHER_TOOL)
    if tool is not None and np.isfinite(tip).all():
        _silhouette(axes, tool, tip, height, TOOL)


def _fill(axes: Axes, loops: list[FloatArray], look: Look, key: str) -> None:
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path

    if not loops:
        return
    path = Path.make_compound_path(*(Path(loop, closed=True) for loop in loops))
    solid = key == "formed-sheet"
    colour = tuple(part / 255.0 for part in look.colour)
    edge = INK if solid else tuple(0.7 * part for part in colour)
    style = {"facecolor": (0.42, 0.48, 0.55) if solid else colour, "edgecolor": edge, "linewidth": 0.7}
    dashes = {"linestyle": (0, (5, 2))} if key == "blank" else {}
    axes.add_patch(PathPatch(path, alpha=None if solid else max(look.opacity, LEAST), **style, **dashes))


def _silhouette(axes: Axes, tool: Tool, tip: FloatArray, height: float, look: Look) -> None:
    right = silhouette(tool, tool.to_dict(), abs(height))
    outline = np.concatenate([right[::-1] * [-1.0, 1.0], right]) * [1.0, np.sign(height)] + tip[[0, 2]]
    colour = tuple(part / 255.0 for part in look.colour)
    axes.fill(*outline.T, facecolor=(*colour, 0.85), edgecolor=tuple(0.6 * part for part in colour), linewidth=0.9)
