# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the panel of a tool draws, as numbers from the engine: meridian, radius of curvature by slope, scallop by stepover."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from .. import engine

WALLS_DEG = (15.0, 45.0, 75.0)
"""Slopes of the walls whose scallops are drawn: flat, middling, steep."""

LOWEST_SCALLOP = 1e-4
"""Height (mm) from which scallops are drawn: less is no finish that anyone asks for."""

HIGHEST_SCALLOP = 0.02
"""Height up to which scallops are drawn, as a part of the diameter."""

STATIONS = 48
"""Points of each curve."""

SHANK_SHOWN = 0.3
"""How much of the shank is drawn above profile and base, as a part of the diameter."""


@dataclass(frozen=True)
class Series:
    """A curve: x and y by point; a label."""

    x: list[float]
    y: list[float]
    label: str = ""


@dataclass(frozen=True)
class Curves:
    """A tool as it is drawn; lengths mm, slopes degrees."""

    profile: list[tuple[float, float]]
    """Radius and height from the tip to the base."""
    above: list[tuple[float, float]]
    """From the base over the shank, cut off a little above it."""
    diameter: float
    height: float
    shank: float
    curvature: Series
    """Radius of curvature by slope; empty where the profile has no curve."""
    scallops: list[Series]
    """Height of the scallop by stepover along the wall, one for each of `WALLS_DEG`."""


def curves_of(document: dict[str, Any]) -> Curves:
    """The curves of a tool document.

    Raises:
        EngineMissingError, styluscam.ToolError: there is no engine, or it refuses the document.
    """
    tool = engine.styluscam().Tool.from_dict(document)
    import numpy as np

    from styluscam.tools.outline import polyline, transition

    profile = polyline(tool)
    rim = (float(profile[-1, 0]), float(profile[-1, 1]))
    shank = float(document.get("shank_diameter") or tool.diameter)
    above = [(float(r), float(z)) for r, z in transition(document.get("base"), rim, shank / 2.0)]
    above.append((shank / 2.0, above[-1][1] + SHANK_SHOWN * max(tool.diameter, shank)))
    slopes = np.linspace(0.0, tool.max_slope, STATIONS)
    radii = tool.curvature_radius_at(slopes)
    kept = np.isfinite(radii) & (radii > 0.0) & (radii < 1e6)
    return Curves(
        [(float(r), float(z)) for r, z in profile],
        above,
        tool.diameter,
        float(tool.height_at(tool.max_slope)),
        shank,
        Series([math.degrees(slope) for slope in slopes[kept]], [float(radius) for radius in radii[kept]]),
        _scallops(tool),
    )


def _scallops(tool: Any) -> list[Series]:
    import numpy as np

    from styluscam.tools.scallop import spacing_of_scallop

    heights = np.geomspace(LOWEST_SCALLOP, max(HIGHEST_SCALLOP * tool.diameter, 2.0 * LOWEST_SCALLOP), STATIONS)
    walls = np.repeat(WALLS_DEG, STATIONS)
    spacings = spacing_of_scallop(tool, walls, np.tile(heights, len(WALLS_DEG))).reshape(len(WALLS_DEG), STATIONS)
    return [
        Series([float(p) for p in row], [float(h) for h in heights], f"{wall:g}°")
        for wall, row in zip(WALLS_DEG, spacings, strict=True)
    ]


def between(series: Series, x: float) -> float | None:
    """The curve's value at x; None beyond its ends."""
    if len(series.x) < 2 or not series.x[0] <= x <= series.x[-1]:
        return None
    index = next(number for number in range(1, len(series.x)) if series.x[number] >= x)
    x0, x1 = series.x[index - 1], series.x[index]
    share = (x - x0) / (x1 - x0) if x1 > x0 else 0.0
    return series.y[index - 1] + share * (series.y[index] - series.y[index - 1])
