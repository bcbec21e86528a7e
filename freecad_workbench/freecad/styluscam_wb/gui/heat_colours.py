# SPDX-License-Identifier: LGPL-2.1-or-later
"""The colours of heat maps, the same as on a report's page: a scale that is readable with any kind of colour vision."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .scene import Colour

if TYPE_CHECKING:
    from styluscam.report.heatmaps import HeatMap
    from styluscam.types import FloatArray, IntArray

SCALE: tuple[Colour, ...] = (
    (68, 1, 84), (72, 20, 103), (72, 38, 119), (69, 55, 129), (63, 71, 136), (57, 86, 140), (50, 100, 142), (44, 113, 142),
    (39, 127, 142), (34, 139, 141), (31, 152, 139), (33, 165, 133), (44, 177, 126), (64, 189, 114), (92, 200, 99),
    (122, 209, 81), (157, 217, 59), (194, 223, 35), (229, 228, 25),
)  # fmt: skip
"""Even steps of viridis (van der Walt and Smith, CC0) without its palest end."""

NOTHING: Colour = (0xD3, 0xD8, 0xDE)
OVER: Colour = (0xCC, 0x4C, 0x9C)
UNFORMED: Colour = (0xE8, 0xE2, 0xCF)
"""Where a map shows nothing, what is over its limit, and where nothing is to be done."""


def colours_of(shown: HeatMap) -> IntArray:
    """The colour (V, 3) of each vertex."""
    from styluscam.report import heatmaps

    span = (shown.high - shown.low) or 1.0
    found = scaled((shown.values - shown.low) / span)
    if shown.limit is not None:
        found[shown.values > shown.limit] = OVER
    found[shown.values == heatmaps.NOTHING] = NOTHING
    found[shown.values == heatmaps.UNFORMED] = UNFORMED
    return np.asarray(found)


def scaled(shares: FloatArray) -> IntArray:
    """The colour (N, 3) of each share (N,) of the scale, 0 to 1; what is beyond has that of the end."""
    steps: FloatArray = np.array(SCALE, dtype=np.float64)
    even = np.arange(len(SCALE))
    at = np.clip(shares, 0.0, 1.0) * (len(SCALE) - 1)
    return np.stack([np.interp(at, even, steps[:, k]) for k in range(3)], axis=1).round().astype(np.int64)


def marks_of(shown: HeatMap) -> list[str]:
    """What stands under the scale: its low end, its middle and its high end."""
    is_cut = bool((shown.values > shown.high).any())
    low, middle, high = (short(value) for value in (shown.low, (shown.low + shown.high) / 2.0, shown.high))
    return [low, middle, f"≥ {high}" if is_cut else high]


def short(value: Any) -> str:
    """A number with three digits that count."""
    return f"{float(value):.3g}"
