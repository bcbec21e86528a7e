"""The meridian of a tool as points to draw: curves, and straight parts with their exact ends."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from styluscam.tools.scallop import Meridian
from styluscam.types import Document, FloatArray

STATIONS = 65
"""Slopes at which a whole profile is looked at."""

HALVINGS = 60
"""Of a slope between stations, in search of a straight part: what is then still long is straight."""

SHORT = 1e-6
"""Points nearer than this part of the tool's size are one point."""


@dataclass(frozen=True, eq=False)
class Piece:
    """A part of the meridian: ``points`` (N, 2) are radii and heights, mm; a straight one has two."""

    points: FloatArray
    straight: bool


def pieces(tool: Meridian, stations: int = STATIONS) -> list[Piece]:
    """From the tip to the base; each piece begins where the one before it ends. Curved ones hold no kink."""
    slopes = np.unique(np.linspace(0.0, tool.max_slope, stations))
    inner, outer = _ends(tool, slopes)
    size = float(max(outer[-1].max(), inner[-1].max()))
    hidden = _straight_between(tool, slopes)
    found = _Run(SHORT * size)
    for index in range(len(slopes)):
        found.line(inner[index], outer[index])
        if index + 1 < len(slopes):
            start, end, following = hidden[0][index], hidden[1][index], inner[index + 1]
            if np.linalg.norm(end - start) > found.short:
                found.curve(start)
                found.line(start, end)
            found.curve(following)
            if np.linalg.norm(following - outer[index]) <= found.short:
                found.kink()
    return found.finished()


def polyline(tool: Meridian, stations: int = STATIONS) -> FloatArray:
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


def silhouette(tool: Meridian, document: Document, top: float) -> FloatArray:
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


def _ends(tool: Meridian, slopes: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Inner and outer end (N, 2) of what has each slope: one point where the profile is curved."""
    inner, outer = tool.radius_range_at(slopes)
    height = tool.height_at(slopes)
    run = outer - inner
    lower = height - np.where(run > 0.0, run * np.tan(np.minimum(slopes, 1.57)), 0.0)
    return np.stack([inner, lower], axis=1), np.stack([outer, height], axis=1)


def _straight_between(tool: Meridian, slopes: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The ends of the longest stretch between each two stations that no slope divides: of a straight part, if any."""
    low, high = slopes[:-1].copy(), slopes[1:].copy()
    found = np.zeros(len(low), dtype=np.bool_)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        between = ~found & (low < middle) & (middle < high)
        a, (b, c), d = _ends(tool, low)[1], _ends(tool, middle), _ends(tool, high)[0]
        below, here, above = (np.linalg.norm(end - start, axis=1) for start, end in ((a, b), (b, c), (c, d)))
        found |= between & (here > np.maximum(below, above))
        upper = above > below
        low = np.where(between & (found | upper), middle, low)
        high = np.where(between & (found | ~upper), middle, high)
    (start, after), (before, _) = _ends(tool, low), _ends(tool, high)
    return np.where(found[:, None], start, after), np.where(found[:, None], after, before)


class _Run:
    """Collects points, and cuts them into pieces at straight parts and kinks."""

    def __init__(self, short: float) -> None:
        self.short = short
        self._pieces: list[Piece] = []
        self._open: list[FloatArray] = []

    def curve(self, point: FloatArray) -> None:
        """The curve goes on to a point."""
        if not self._open:
            self._open = [point]
        elif np.linalg.norm(point - self._open[-1]) > self.short:
            self._open.append(point)

    def kink(self) -> None:
        """The last point is a corner."""
        corner = self._open[-1]
        self._close()
        self._open = [corner]

    def line(self, start: FloatArray, end: FloatArray) -> None:
        """A straight part, if it is long enough to be one."""
        if np.linalg.norm(end - start) <= self.short:
            self.curve(start)
            return
        self._close()
        self._pieces.append(Piece(np.stack([start, end]), straight=True))
        self._open = [end]

    def _close(self) -> None:
        if len(self._open) > 1:
            self._pieces.append(Piece(np.stack(self._open), straight=len(self._open) == 2))
        self._open = []

    def finished(self) -> list[Piece]:
        """All pieces."""
        self._close()
        return self._pieces
