"""The meridian of a tool as points to draw: curves, and straight parts with their exact ends."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from styluscam.tools.tool import Tool
from styluscam.types import Document, FloatArray

STATIONS = 65
"""Slopes of a whole profile; a curve goes through the points of those that it has."""

SHORT = 1e-6
"""Points nearer than this part of the tool's size are one point."""


@dataclass(frozen=True, eq=False)
class Piece:
    """A part of the meridian: ``points`` (N, 2) are radii and heights, mm; a straight one has two."""

    points: FloatArray
    straight: bool


def pieces(tool: Tool, stations: int = STATIONS) -> list[Piece]:
    """From the tip to the base; each piece begins where the one before it ends. Curved ones hold no kink."""
    parts, slopes = tool.outline(), np.linspace(0.0, tool.max_slope, stations)
    drawn = _Drawn(SHORT * max(parts[-1].outer))
    for part in parts:
        if part.straight:
            drawn.line(np.array(part.inner), np.array(part.outer))
            continue
        within = slopes[(slopes > part.slopes[0]) & (slopes < part.slopes[1])]
        inside = np.stack([tool.radius_at(within), tool.height_at(within)], axis=1)
        drawn.curve(np.concatenate([[part.inner], inside, [part.outer]]))
    return drawn.finished()


def polyline(tool: Tool, stations: int = STATIONS) -> FloatArray:
    """Radii and heights (N, 2), mm, from the tip to the base."""
    parts = [piece.points for piece in pieces(tool, stations)]
    return np.concatenate([parts[0][:1], *(part[1:] for part in parts)])


def transition(base: Document | None, rim: tuple[float, float], shank: float) -> FloatArray:
    """From the profile's rim (radius and height) over the base to the shank's radius: radii and heights (N, 2), mm.

    Without a base the shank begins at the rim, a wider one behind a cone of 45 degrees. A tangent one goes upright at
    both ends.
    """
    radius, height = rim
    if base is None:
        return np.array([rim, (shank, height + max(0.0, shank - radius))])
    top = height + float(base["height"])
    if base["kind"] == "cylindrical":
        return np.array([rim, (radius, top), (shank, top)])
    if base["kind"] == "chamfer":
        return np.array([rim, (shank, top)])
    share = np.linspace(0.0, 1.0, 33)
    smooth = 0.5 - 0.5 * np.cos(np.pi * share)
    return np.stack([radius + (shank - radius) * smooth, height + (top - height) * share], axis=1)


def silhouette(tool: Tool, document: Document, top: float) -> FloatArray:
    """Radii and heights (N, 2), mm, from the tip over base, shank and holder; up to ``top`` where nothing ends before.

    ``document`` is the tool's: without a length the shank goes on to the top, without a holder it ends at the length.
    """
    profile = polyline(tool)
    rim = (float(profile[-1, 0]), float(profile[-1, 1]))
    shank = float(document.get("shank_diameter") or 2.0 * rim[0]) / 2.0
    above = transition(document.get("base"), rim, shank)
    end = max(float(document.get("length") or top), float(above[-1, 1]))
    points = [*above[1:], (shank, end)]
    holder = document.get("holder")
    if holder is not None:
        wide, over = float(holder["diameter"]) / 2.0, end + float(holder["length"])
        points += [(wide, end), (wide, over), (0.0, over)]
    elif document.get("length"):
        points.append((0.0, end))
    return np.concatenate([profile, np.array(points)])


@dataclass
class _Drawn:
    """Collects pieces; what is shorter than ``short`` (mm) joins its neighbours."""

    short: float
    _pieces: list[Piece] = field(default_factory=list)
    _open: list[FloatArray] = field(default_factory=list)
    _joins: bool = False

    def curve(self, points: FloatArray) -> None:
        """A smooth curve through points: it goes on from one before it where only a short line lies between."""
        if not self._joins:
            self._close()
        for point in points:
            if not self._open or np.linalg.norm(point - self._open[-1]) > self.short:
                self._open.append(point)
        self._joins = False

    def line(self, start: FloatArray, end: FloatArray) -> None:
        """A straight part."""
        if np.linalg.norm(end - start) <= self.short:
            self._joins = True
            return
        self._close()
        self._pieces.append(Piece(np.stack([start, end]), straight=True))

    def _close(self) -> None:
        if len(self._open) > 1:
            self._pieces.append(Piece(np.stack(self._open), straight=len(self._open) == 2))
        self._open = []

    def finished(self) -> list[Piece]:
        """All pieces."""
        self._close()
        return self._pieces
