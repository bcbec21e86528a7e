"""The sheet of paper on which pictures of parts and paths are drawn: 1200 x 800 pixels."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from styluscam.extras import require
from styluscam.files import drawn_whole

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SIZE, DPI = (1200, 800), 100
FINER = 2
"""Pixels are computed at this many times the size and averaged: smooth edges."""
SECTION = 210
"""Height of the section below a sheet, pixels."""
INK, SOFT = "#1f2933", "#7b8794"
PNG: Any = {"format": "png", "dpi": DPI, "metadata": {"Software": None}}
"""How pictures are saved."""


def new_figure() -> Figure:
    """White paper."""
    require("plot", "a picture")
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(SIZE[0] / DPI, SIZE[1] / DPI), dpi=DPI, facecolor="white")
    FigureCanvasAgg(figure)
    return figure


def pane(figure: Figure, box: tuple[int, int, int, int]) -> Axes:
    """Axes whose data are pixels, right and down; ``box`` is left, bottom, width, height."""
    left, bottom, width, height = box
    axes = figure.add_axes((left / SIZE[0], bottom / SIZE[1], width / SIZE[0], height / SIZE[1]))
    axes.set(xlim=(0, width), ylim=(height, 0))
    axes.set_axis_off()
    axes.set_autoscale_on(False)
    return axes


def save(figure: Figure, path: Path) -> None:
    """Writes the PNG to a temporary name and renames it; without the name of the program that made it."""
    with drawn_whole(path) as name:
        figure.savefig(name, **PNG)
