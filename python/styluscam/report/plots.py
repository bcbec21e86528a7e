"""Plots as SVG for a page: over time with room for a cursor, and histograms. Colours are the page's own."""

from __future__ import annotations

import io
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from styluscam.drawing.toolplot import COLOURS, GRID, INK, SOFT
from styluscam.programs.program import RAPID
from styluscam.types import FloatArray, IntArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SIZE = (5.2, 2.3)
"""Inches."""

FRAME = (0.135, 0.215, 0.835, 0.73)
"""Left, bottom, width, height of the axes, shares of the figure."""

BINS = 700
"""Of the time axis: a plot shows the lowest and the highest of each."""

BARS = 40

STYLE: Any = {
    "font.family": "sans-serif",
    "font.size": 9.5,
    "svg.fonttype": "none",
    "svg.hashsalt": "styluscam",
    "axes.edgecolor": SOFT,
    "axes.labelcolor": INK,
    "xtick.color": SOFT,
    "ytick.color": SOFT,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
}

Draw: TypeAlias = Callable[["Axes"], None]
"""Puts something on axes."""

VARIABLES = {INK: "--ink", SOFT: "--soft", GRID: "--grid", COLOURS[0]: "--first", COLOURS[1]: "--second"}
"""Colours of the drawing by the page's names for them: a dark page has others."""


@dataclass(frozen=True)
class Plot:
    """An SVG with a caption, and notes below; ``seconds`` are the ends of its time axis, if that is what it has."""

    title: str
    svg: str
    seconds: tuple[float, float] | None = None
    notes: tuple[str, ...] = ()

    @property
    def left(self) -> float:
        """Where the time axis begins, share of the width."""
        return FRAME[0]

    @property
    def width(self) -> float:
        """How long it is, share of the width."""
        return FRAME[2]


@dataclass(frozen=True, eq=False)
class Series:
    """A program over time: seconds (N,), heights (N,) mm, feeds (N,) mm/min, kinds (N,)."""

    times: FloatArray
    heights: FloatArray
    feeds: FloatArray
    kinds: IntArray
    label: str = ""


def height_over_time(series: Sequence[Series]) -> Plot:
    """Z of the tip."""

    def draw(axes: Axes) -> None:
        for one, colour in zip(series, COLOURS, strict=False):
            _line(axes, *_outlined(one.times, one.heights), colour, one.label)
        axes.set_ylabel("Z of the tip, mm")

    return _over_time("Height over time", series, draw)


def feed_over_time(series: Sequence[Series]) -> Plot:
    """Feed; nothing where the machine goes at its own rapid rate."""

    def draw(axes: Axes) -> None:
        for one, colour in zip(series, COLOURS, strict=False):
            starts = np.concatenate([[0.0], one.times[:-1]])
            feeds = np.where(one.kinds == RAPID, np.nan, one.feeds)
            both = np.stack([starts, one.times], axis=1).reshape(-1)
            _line(axes, *_outlined(both, np.repeat(feeds, 2)), colour, one.label)
        axes.set_ylim(bottom=0.0)
        axes.set_ylabel("feed, mm/min")

    return _over_time("Feed over time", series, draw)


def scallop_histogram(scallops: FloatArray, weights: FloatArray) -> Plot:
    """How much area has how high a scallop."""

    def draw(axes: Axes) -> None:
        top = max(float(scallops.max(initial=0.0)) * 1e3, 1e-3)
        heights, edges = np.histogram(scallops * 1e3, bins=BARS, range=(0.0, top), weights=weights)
        axes.bar(edges[:-1], heights, width=np.diff(edges), align="edge", color=COLOURS[0], linewidth=0)
        axes.set_xlim(0.0, top)
        axes.set_xlabel("scallop, µm")
        axes.set_ylabel("area, mm²")

    return Plot("Scallop where it is covered", drawn(draw))


def _over_time(title: str, series: Sequence[Series], draw: Draw) -> Plot:
    end = max((float(one.times[-1]) for one in series if len(one.times)), default=0.0) or 1.0
    unit, name = next(((u, n) for u, n in ((3600.0, "h"), (60.0, "min")) if end >= 3.0 * u), (1.0, "s"))

    def with_axis(axes: Axes) -> None:
        draw(axes)
        axes.set_xlim(0.0, end)
        ticks = _ticks(end / unit)
        axes.set_xticks(ticks * unit, [f"{tick:g}" for tick in ticks])
        axes.set_xlabel(f"time, {name}")
        if len(series) > 1:
            axes.legend(fontsize=8.5, frameon=False, labelcolor=INK, loc="best")

    return Plot(title, drawn(with_axis), (0.0, end))


def _ticks(end: float) -> FloatArray:
    """Round numbers from 0 to the end."""
    from matplotlib.ticker import MaxNLocator

    ticks = np.asarray(MaxNLocator(6, steps=[1, 2, 5, 10]).tick_values(0.0, end))
    return ticks[ticks <= end]


def _line(axes: Axes, times: FloatArray, values: FloatArray, colour: str, label: str) -> None:
    axes.plot(times, values, color=colour, linewidth=1.1, solid_joinstyle="round", label=label)


def _outlined(times: FloatArray, values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The lowest and the highest value of each of :data:`BINS` stretches of time, in order."""
    if len(times) <= 4 * BINS:
        return times, values
    number = np.minimum((times / max(float(times[-1]), 1e-12) * BINS).astype(np.int64), BINS - 1)
    first = np.flatnonzero(np.diff(number, prepend=-1))
    keep = set(first.tolist())
    finite = np.isfinite(values)
    for fill, best in ((np.inf, np.minimum), (-np.inf, np.maximum)):
        filled = np.where(finite, values, fill)
        extreme = best.reduceat(filled, first)
        hit = np.flatnonzero(finite & (filled == extreme[np.searchsorted(first, np.arange(len(times)), "right") - 1]))
        _, once = np.unique(number[hit], return_index=True)
        keep.update(hit[once].tolist())
    chosen = np.array(sorted({*keep, len(times) - 1}))
    return times[chosen], values[chosen]


def drawn(draw: Draw, frame: tuple[float, float, float, float] = FRAME) -> str:
    """What ``draw`` puts on axes, as an element for a page: the same numbers give the same text."""
    from matplotlib import rc_context
    from matplotlib.backends.backend_svg import FigureCanvasSVG
    from matplotlib.figure import Figure

    with rc_context(STYLE):
        figure: Figure = Figure(figsize=SIZE)
        FigureCanvasSVG(figure)
        figure.patch.set_visible(False)
        axes = figure.add_axes(frame)
        axes.patch.set_visible(False)
        draw(axes)
        axes.grid(True, color=GRID, linewidth=0.8)
        axes.set_axisbelow(True)
        axes.tick_params(length=3)
        for side in ("top", "right"):
            axes.spines[side].set_visible(False)
        text = io.StringIO()
        figure.savefig(text, format="svg", metadata=dict.fromkeys(("Date", "Creator", "Format", "Type")))
    return _in_page_colours(element(text.getvalue()))


def element(svg: str) -> str:
    """An SVG file's text as an element inside a page, as wide as its container."""
    svg = re.sub(r"^.*?(?=<svg )", "", svg, flags=re.DOTALL)
    svg = re.sub(r'(<svg [^>]*?) width="[^"]*"', r"\1", svg, count=1)
    svg = re.sub(r'(<svg [^>]*?) height="[^"]*"', r"\1", svg, count=1)
    return svg.replace("<svg ", '<svg aria-hidden="true" ', 1)


def _in_page_colours(svg: str) -> str:
    for colour, name in VARIABLES.items():
        svg = re.sub(re.escape(colour), f"var({name})", svg, flags=re.IGNORECASE)
    return svg
