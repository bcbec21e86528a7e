"""What a picture of a sheet has beside the path: what one looks through, the section, the names."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from styluscam.drawing.canvas import FINER, INK, SECTION, SIZE, SOFT, pane
from styluscam.drawing.raster import Raster, View, rasterise
from styluscam.drawing.section import LEAST, draw_section
from styluscam.drawing.shapes import OTHER_TOOL, TOOL, Around, Look, Opposite, Shape
from styluscam.programs.program import RAPID, Program
from styluscam.tools.tool import Tool
from styluscam.types import FloatArray, IntArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SLACK = 1.0 / 400.0
"""How far behind what is seen something still counts as seen, as a share of the size."""

DEEP = 0.55
"""Share of the depth at which the tools are shown."""

LEFT, RIGHT = 40, 900
"""Of the section, pixels."""

OUTLINE = 0.55
"""Of a colour: that of its edges."""


def moment(program: Program, y: float, opposite: Opposite | None) -> tuple[FloatArray, FloatArray]:
    """Where the tips (3,) of the tool and of that on the other side are at one moment; not a number where they are not known.

    The moment is one at which the tool goes through the plane at ``y``, on the right, about halfway down.
    """
    positions, owners = program.polyline
    nowhere = np.full(3, np.nan)
    starts, ends, moves = positions[:-1], positions[1:], owners[1:].astype(np.int64)
    rapid = program.moves["kind"][moves] == RAPID
    known = np.flatnonzero(np.isfinite(starts).all(axis=1) & np.isfinite(ends).all(axis=1) & ~rapid)
    if not len(known):
        return nowhere, nowhere
    starts, ends, moves = starts[known], ends[known], moves[known]
    along = ends[:, 1] - starts[:, 1]
    share = np.divide(y - starts[:, 1], along, out=np.zeros(len(along)), where=along != 0.0).clip(0.0, 1.0)
    points = starts + (ends - starts) * share[:, None]
    low, high = ends[:, 2].min(), ends[:, 2].max()
    deep = np.abs(points[:, 2] - (high - DEEP * (high - low)))
    right = points[:, 0] - float(np.median(points[:, 0]))
    best = int(np.argmin(10.0 * np.abs(points[:, 1] - y) + 3.0 * deep - right))
    return points[best], nowhere if opposite is None else _opposite(opposite, moves, int(best), float(share[best]))


def _opposite(opposite: Opposite, moves: IntArray, index: int, share: float) -> FloatArray:
    """Where the other tool is, a share of its move on the way."""
    move = int(moves[index])
    before, at = opposite.tips(np.array([max(move - 1, 0), move]))
    return np.asarray(before + (at - before) * share)


def tinted(view: View, raster: Raster, shape: Shape, box: FloatArray) -> npt.NDArray[np.float64]:
    """The image (H, W, 4) of a shape that one looks through, where nothing stands before it."""
    seen = rasterise(view.finer(FINER), shape.vertices, shape.triangles)
    slack = SLACK * float(np.linalg.norm(box[1] - box[0]))
    covers = (seen.triangle >= 0) & (seen.depth >= raster.depth - slack)
    image = np.zeros((*covers.shape, 4))
    image[..., :3] = np.array(shape.look.colour) / 255.0
    image[..., 3] = covers * shape.look.opacity
    height, width = covers.shape[0] // FINER, covers.shape[1] // FINER
    return np.asarray(image.reshape(height, FINER, width, FINER, 4).mean(axis=(1, 3)))


def edges(axes: Axes, view: View, raster: Raster, shape: Shape, box: FloatArray) -> None:
    """Draws what is seen of a shape's edges."""
    from matplotlib.collections import LineCollection

    size = float(np.linalg.norm(box[1] - box[0]))
    starts, stops = _cut(shape.vertices[shape.edges[:, 0]], shape.vertices[shape.edges[:, 1]], size / 100.0)
    hidden = raster.hides(view.finer(FINER).project((starts + stops) / 2.0), SLACK * size)
    lines = np.stack([view.project(starts)[:, :2], view.project(stops)[:, :2]], axis=1)[~hidden]
    colour = tuple(OUTLINE * part / 255.0 for part in shape.look.colour)
    axes.add_collection(LineCollection(list(lines), colors=[colour], linewidths=0.8, zorder=2))


def _cut(starts: FloatArray, stops: FloatArray, longest: float) -> tuple[FloatArray, FloatArray]:
    """Lines in pieces, so that a part of one can be hidden."""
    count = np.maximum(1, np.ceil(np.linalg.norm(stops - starts, axis=1) / longest)).astype(np.int64)
    line = np.repeat(np.arange(len(count)), count)
    step = (np.arange(len(line)) - np.repeat(np.cumsum(count) - count, count))[:, None]
    along, parts = (stops - starts)[line], count[line][:, None]
    return starts[line] + along * step / parts, starts[line] + along * (step + 1) / parts


def section_pane(figure: Figure, around: Around, tool: Tool | None, tips: tuple[FloatArray, FloatArray]) -> None:
    """The section below the view."""
    box = around.box
    points = np.concatenate([shape.vertices for shape in around.shapes])
    low, high = points.min(axis=0)[[0, 2]], points.max(axis=0)[[0, 2]]
    middle = float(box[:, 1].mean())
    aside = 0.2 * float(np.ptp(box[:, 0]))  # the tools above and below
    low[1] -= 0.6 * aside if around.opposite is not None else 0.0
    high[1] += aside
    width, height = RIGHT - LEFT, SECTION - 34
    scale = min(width / (high[0] - low[0]), height / (high[1] - low[1]))
    axes = pane(figure, (LEFT, 8, width, height))
    half = np.array([width, height]) / scale / 2.0
    centre = (low + high) / 2.0
    axes.set(xlim=(centre[0] - half[0], centre[0] + half[0]), ylim=(centre[1] - half[1], centre[1] + half[1]))
    draw_section(axes, around, middle, tool, tips)
    words = f"section along X at Y = {round(middle, 3) + 0.0:g} mm"
    figure.text(LEFT / SIZE[0], (SECTION - 14) / SIZE[1], words, va="center", fontsize=11, color=SOFT)


def names(figure: Figure, around: Around, tool: Tool | None) -> None:
    """What the colours stand for, right of the section."""
    from matplotlib.patches import Rectangle

    rows: list[tuple[Look, str]] = [(shape.look, shape.words) for shape in around.shapes]
    rows += [(TOOL, "tool")] if tool is not None else []
    rows += [(OTHER_TOOL, "tool on the other side")] if around.opposite is not None else []
    axes = pane(figure, (RIGHT + 20, 8, SIZE[0] - RIGHT - 20, SECTION - 16))
    for row, (look, words) in enumerate(rows):
        y = 14.0 + 25.0 * row
        colour = tuple(part / 255.0 for part in look.colour)
        face = (*colour, max(look.opacity, LEAST))
        axes.add_patch(
            Rectangle((4.0, y), 24.0, 14.0, facecolor=face, edgecolor=[0.6 * c for c in colour], linewidth=0.9)
        )
        axes.text(38.0, y + 7.5, words, va="center", fontsize=11, color=INK)
