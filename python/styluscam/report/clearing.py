"""Plots of what a pocket engages and removes over the length of its feed moves."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from styluscam.drawing.toolplot import COLOURS, INK, SOFT
from styluscam.judging.clearing import EngagementFigures, EntryFigures, Largest, OperationEngagement
from styluscam.report.plots import BINS, Plot, drawn
from styluscam.types import FloatArray
from styluscam.words import counted

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FRAME = (0.135, 0.215, 0.835, 0.66)
"""As :data:`plots.FRAME`, with the key above it."""

HEADROOM = 1.08
"""Of the axes' height over the highest value."""

CUBIC = 1e3
"""mm^3 in a cm^3."""

FEW = 4 * BINS
"""Positions up to which all are drawn."""

GAP = 1e-6
"""mm: moves that lie farther apart have one between them that was not measured."""

LISTED = 4
"""Entries without a bound that are listed one by one."""


def over_length(found: OperationEngagement) -> list[Plot]:
    """The engagement angle and the removal rate of an operation on which something was measured."""
    figures = found.figures
    return [_angles(found, figures), _rates(found, figures)]


def _angles(found: OperationEngagement, figures: EngagementFigures) -> Plot:
    angles = found.bounded_deg
    limits = np.full(len(angles), found.bound_deg)
    largest = figures.angle
    notes = ["No move that cuts was measured."]
    if largest is not None:
        notes = [
            f"Largest angle {largest.value:.2f}° in line {largest.line}, after {largest.distance:.1f} of {found.length:.1f} mm at"
            f" feed; bound {found.bound_deg:g}°. {_drawn(found)}"
        ]
    svg = _plot(
        found, Curve(angles, limits, f"bound {found.bound_deg:g}°", "engagement angle, °", largest), figures.exempt
    )
    return Plot("Engagement angle over length", svg, notes=(*notes, _exempt(figures.exempt)))


def _rates(found: OperationEngagement, figures: EngagementFigures) -> Plot:
    rates, references = found.rates / CUBIC, found.reference_rates / CUBIC
    largest = figures.rate
    note = "No move states a feed per minute."
    if largest is not None:
        note = (
            f"Highest rate {largest.value / CUBIC:.3g} cm³/min in line {largest.line}, {100.0 * largest.share:.1f} % of the "
            "reference: that of a straight pass at the bound, at the feed of the passes. Not measured on entries."
        )
        largest = replace(largest, value=largest.value / CUBIC)
    svg = _plot(found, Curve(rates, references, "reference", "removal rate, cm³/min", largest), figures.exempt)
    return Plot("Removal rate over length", svg, notes=(note,))


def _drawn(found: OperationEngagement) -> str:
    if len(found.distances) <= FEW:
        return "Drawn at every position that was measured."
    return f"Drawn by the largest value in each {found.length / BINS:.2g} mm."


def _exempt(entries: list[EntryFigures]) -> str:
    """In words: where the bound does not hold."""
    if not entries:
        return "No entry goes through stock: the bound is for all of the length."
    listed = [
        f"lines {one.first_line} to {one.last_line} ({one.length:.1f} mm, up to {one.max_deg:.0f}°)"
        for one in entries[:LISTED]
    ]
    more = [f"{len(entries) - LISTED} more"] if len(entries) > LISTED else []
    number, length = counted(len(entries), "entry", "entries"), sum(one.length for one in entries)
    return f"The bound does not hold on {number}, {length:.1f} mm in all: {', '.join([*listed, *more])}."


@dataclass(frozen=True, eq=False)
class Curve:
    """Values over length (N,), nan where there are none, their limits (N,), and the largest."""

    values: FloatArray
    limits: FloatArray
    limit: str
    label: str
    largest: Largest | None


def _plot(found: OperationEngagement, curve: Curve, entries: list[EntryFigures]) -> str:
    top = HEADROOM * max(float(np.nanmax(curve.values, initial=0.0)), float(curve.limits.max()))

    def draw(axes: Axes) -> None:
        for number, entry in enumerate(entries):
            low, high, name = entry.start, entry.start + entry.length, "entry" if number == 0 else None
            axes.axvspan(low, high, facecolor=SOFT, edgecolor=SOFT, alpha=0.35, linewidth=0.8, label=name)
        axes.plot(*highest_of(found, curve.values), color=COLOURS[0], linewidth=1.0, solid_joinstyle="round")
        at = np.flatnonzero(np.diff(curve.limits, prepend=np.nan, append=np.nan) != 0.0)
        limits = curve.limits[np.minimum(at, len(curve.limits) - 1)]
        ends = np.append(np.append(0.0, found.distances[at[1:-1]]), found.length)
        axes.step(ends, limits, where="post", color=COLOURS[1], linewidth=1.1, label=curve.limit)
        if curve.largest is not None:
            name = f"largest: line {curve.largest.line}"
            axes.plot(curve.largest.distance, curve.largest.value, "o", color=INK, markersize=4.0, label=name)
        axes.set_xlim(0.0, found.length)
        axes.set_ylim(0.0, top)
        axes.set_xlabel("length at feed, mm")
        axes.set_ylabel(curve.label)
        axes.legend(
            fontsize=8.5,
            frameon=False,
            labelcolor=INK,
            ncols=3,
            loc="lower left",
            bbox_to_anchor=(0.0, 1.0),
            borderpad=0.2,
        )

    return drawn(draw, FRAME)


def highest_of(found: OperationEngagement, values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Values over length as they are drawn: the highest of each of some stretches of it, where it is; nan where there is none.

    ``values`` (N,) are those at the positions. Few are drawn as they are.
    """
    distances = found.distances
    if len(values) > FEW:
        number = np.minimum(distances / found.length * BINS, BINS - 1).astype(np.int64)
        last = np.append(np.flatnonzero(np.diff(number)), len(number) - 1)
        chosen = np.lexsort((np.where(np.isnan(values), -np.inf, values), number))[last]
        distances, values = distances[chosen], values[chosen]
    starts, ends = found.moves.starts, found.moves.ends
    gaps = ends[:-1][starts[1:] - ends[:-1] > GAP]
    at = np.searchsorted(distances, gaps, side="right")
    return np.insert(distances, at, gaps), np.insert(values, at, np.nan)
