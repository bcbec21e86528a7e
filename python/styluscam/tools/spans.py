"""The meridian of a tool as lines, arcs and conics, for solids: each with the slopes of the profile at both ends.

A conic through two points with given tangents is fixed by one more number, its weight; a circle's arc, a parabola's and an
ellipse's are conics and come out exactly. Others are halved by slope until the conic is near enough (E. T. Lee, "The
rational Bezier representation for conics", 1987).
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np

from styluscam.tools.tool import OutlinePart, Tool
from styluscam.types import FloatArray

TOLERANCE = 1e-5
"""How far (mm) a span may be from the profile: a hundredth of what verification tolerates."""

SHORT = 1e-6
"""Points nearer than this part of the tool's size are one point."""

ROUND = 1e-9
"""A conic whose weight and sides differ from a circle's by less, relative to them, is one."""

CHECKED = 17
"""Slopes at which a span is compared with the profile."""

DEEPEST = 40
"""Halvings of a slope: the size of a span is then below every tolerance."""

LOOKED_AT = 129
"""Slopes between which a jump of the curvature is looked for."""

HALVINGS = 48
"""Of a slope in which the curvature may jump: down to neighbouring numbers."""

JUMP = 1e-3
"""The curvature jumps where its logarithm changes by more between neighbouring slopes."""


@dataclass(frozen=True)
class Span:
    """A part of the meridian; points are (radius, height), mm."""

    start: tuple[float, float]
    end: tuple[float, float]
    control: tuple[float, float] | None = None
    """Where the tangents of both ends meet; None on a line."""
    weight: float = 1.0
    """Of the control point: 1 on a parabola, less on an ellipse."""
    middle: tuple[float, float] | None = None
    """A point of a circle's arc between its ends; None where it is no circle."""


def spans(tool: Tool, tolerance: float = TOLERANCE) -> list[Span]:
    """From the tip to the base, each from where the one before it ends; within ``tolerance`` (mm) of the profile."""
    parts = tool.outline()
    short = SHORT * max(parts[-1].outer)
    found: list[Span] = []
    for part in parts:
        ends = np.array(part.inner), np.array(part.outer)
        if math.dist(*ends) <= short:
            continue
        if part.straight:
            found.append(_line(*ends))
            continue
        bounds = [part.slopes[0], *_jumps(tool, part), part.slopes[1]]
        points = [ends[0], *(_point(tool, slope) for slope in bounds[1:-1]), ends[1]]
        for (low, a), (high, b) in itertools.pairwise(zip(bounds, points, strict=True)):
            found += _Fit(tool, tolerance, short).between((low, a), (high, b))
    return _joined(found)


def _line(start: FloatArray, end: FloatArray) -> Span:
    return Span(_pair(start), _pair(end))


def _pair(point: FloatArray) -> tuple[float, float]:
    return float(point[0]), float(point[1])


def _point(tool: Tool, slope: float) -> FloatArray:
    return np.array([float(tool.radius_at(slope)), float(tool.height_at(slope))])


def _jumps(tool: Tool, part: OutlinePart) -> list[float]:
    """Slopes inside a curved part where its curvature jumps, from one arc to the next for example."""
    slopes = np.linspace(*part.slopes, LOOKED_AT)[1:-1]
    curvature = _log_curvature(tool, slopes)
    steps = np.flatnonzero(np.abs(np.diff(curvature)) > JUMP)
    low, high = slopes[steps], slopes[steps + 1]
    at_low, at_high = curvature[steps], curvature[steps + 1]
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        value = _log_curvature(tool, middle)
        below = np.abs(value - at_low) < np.abs(value - at_high)
        low, at_low = np.where(below, middle, low), np.where(below, value, at_low)
        high, at_high = np.where(below, high, middle), np.where(below, at_high, value)
    return [float(slope) for slope in high[np.abs(at_high - at_low) > JUMP]]


def _log_curvature(tool: Tool, slopes: FloatArray) -> FloatArray:
    return np.log(np.clip(tool.curvature_radius_at(slopes), 1e-300, 1e300))


class _Fit:
    """Conics between slopes of a profile."""

    def __init__(self, tool: Tool, tolerance: float, short: float) -> None:
        self._tool, self._tolerance, self._short = tool, tolerance, short

    def between(self, low: tuple[float, FloatArray], high: tuple[float, FloatArray], depth: int = 0) -> list[Span]:
        """One span between two slopes and their points, or several."""
        (s0, a), (s1, b) = low, high
        if math.dist(a, b) <= self._short or depth == DEEPEST:
            return [_line(a, b)]
        span = self._conic(low, high)
        if span is not None:
            return [span]
        middle = 0.5 * (s0 + s1)
        halfway = middle, _point(self._tool, middle)
        return self.between(low, halfway, depth + 1) + self.between(halfway, high, depth + 1)

    def _conic(self, low: tuple[float, FloatArray], high: tuple[float, FloatArray]) -> Span | None:
        """The conic, where it is near enough; a line, where that is."""
        (s0, a), (s1, b) = low, high
        slopes = np.linspace(s0, s1, CHECKED)[1:-1]
        points = np.stack([self._tool.radius_at(slopes), self._tool.height_at(slopes)], axis=1)
        chord = b - a
        length = float(np.hypot(*chord))
        over = np.abs(_cross(points - a, chord)) / length
        if over.max() <= min(self._tolerance, self._short):
            return _line(a, b)
        turned = math.sin(s1 - s0)
        if turned <= 0.0:
            return None
        reach = _cross(chord, np.array([math.cos(s1), math.sin(s1)])) / turned
        control = a + reach * np.array([math.cos(s0), math.sin(s0)])
        highest = _point(self._tool, float(np.clip(math.atan2(chord[1], chord[0]), s0, s1)))
        rise, most = abs(_cross(highest - a, chord)), abs(_cross(control - a, chord))
        if not 0.0 < rise < most:
            return None
        weight = float(rise / (most - rise))
        if self._deviation(points, a, control, b, weight) > self._tolerance:
            return None
        sides = math.dist(a, control), math.dist(control, b)
        is_round = (
            abs(sides[0] - sides[1]) <= ROUND * sides[0] and abs(weight / math.cos(0.5 * (s1 - s0)) - 1.0) <= ROUND
        )
        middle = (0.5 * (a + b) + weight * control) / (1.0 + weight)
        return Span(_pair(a), _pair(b), _pair(control), weight, _pair(middle) if is_round else None)

    @staticmethod
    def _deviation(points: FloatArray, a: FloatArray, control: FloatArray, b: FloatArray, weight: float) -> float:
        """The largest distance (mm) from points to the conic, to first order: its value by the length of its gradient."""
        area = _cross(control - a, b - a)
        first = _cross(control - points, b - points) / area
        last = _cross(control - a, points - a) / area
        inside = 1.0 - first - last
        value = inside**2 - 4.0 * weight**2 * first * last
        by_first, by_last, by_inside = -4.0 * weight**2 * last, -4.0 * weight**2 * first, 2.0 * inside
        sides = np.array([_turned(b - control), _turned(a - b), _turned(control - a)]) / area
        gradient = by_first[:, None] * sides[0] + by_inside[:, None] * sides[1] + by_last[:, None] * sides[2]
        size = np.hypot(gradient[:, 0], gradient[:, 1])
        return float(np.max(np.abs(value) / np.maximum(size, 1e-300)))


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])


def _turned(side: FloatArray) -> FloatArray:
    """By a quarter: the gradient of a corner's share is the opposite side, turned."""
    return np.array([-side[1], side[0]])


def _joined(found: list[Span]) -> list[Span]:
    """Each begins exactly where the one before it ends: what was left out between was shorter than can be seen."""
    joined = found[:1]
    for span in found[1:]:
        end = joined[-1].end
        joined.append(Span(end, span.end, span.control, span.weight, span.middle) if span.start != end else span)
    return joined
