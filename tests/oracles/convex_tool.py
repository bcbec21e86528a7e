"""Signed distance of points to a tool, by the nearest point of its meridian: lines, arcs, a clothoid.

The tool is the solid that the meridian sweeps about its axis, and above the base a cylinder without end. A sheet of
constant thickness makes it larger by a ball; one by the sine law stands under it. Lengths in mm, tip at the origin.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

from meridian import Profile

Floats: TypeAlias = NDArray[np.float64]

TABLE = 17
"""Positions of a clothoid from which its nearest point is searched."""
HIGH = 1e4
"""Where the cylinder above the base ends, mm."""


class Piece(Protocol):
    """A piece of the meridian, from the tip outwards."""

    def distance(self, r: Floats, z: Floats) -> Floats:
        """Distance of the nearest point, not negative."""

    def height(self, r: Floats) -> Floats:
        """Height at a radius; infinite where the piece is not."""

    def support(self, slope: float) -> tuple[float, float]:
        """The point that a plane of this slope, rad, touches."""


@dataclass(frozen=True)
class Line:
    """A straight piece."""

    start: tuple[float, float]
    end: tuple[float, float]

    def distance(self, r: Floats, z: Floats) -> Floats:
        dr, dz = self.end[0] - self.start[0], self.end[1] - self.start[1]
        share = ((r - self.start[0]) * dr + (z - self.start[1]) * dz) / (dr * dr + dz * dz)
        share = np.clip(share, 0.0, 1.0)
        return np.asarray(np.hypot(r - self.start[0] - share * dr, z - self.start[1] - share * dz))

    def height(self, r: Floats) -> Floats:
        if self.end[0] <= self.start[0]:
            return np.full_like(r, np.inf)
        share = (r - self.start[0]) / (self.end[0] - self.start[0])
        on = (share >= 0.0) & (share <= 1.0)
        return np.where(on, self.start[1] + share * (self.end[1] - self.start[1]), np.inf)

    def support(self, slope: float) -> tuple[float, float]:
        return max(self.start, self.end, key=lambda point: point[0] * math.sin(slope) - point[1] * math.cos(slope))


@dataclass(frozen=True)
class Round:
    """An arc that bulges outwards and down; its slopes run from `low` to `high`, rad."""

    centre: tuple[float, float]
    radius: float
    low: float
    high: float

    def distance(self, r: Floats, z: Floats) -> Floats:
        out, down = r - self.centre[0], self.centre[1] - z
        slope = np.clip(np.arctan2(out, down), self.low, self.high)
        nearest_r, nearest_z = self.radius * np.sin(slope), self.radius * np.cos(slope)
        return np.asarray(np.hypot(out - nearest_r, down - nearest_z))

    def height(self, r: Floats) -> Floats:
        out = r - self.centre[0]
        on = (out >= self.radius * math.sin(self.low)) & (out <= self.radius * math.sin(self.high))
        return np.where(on, self.centre[1] - np.sqrt(np.maximum(self.radius**2 - out**2, 0.0)), np.inf)

    def support(self, slope: float) -> tuple[float, float]:
        within = min(max(slope, self.low), self.high)
        return self.centre[0] + self.radius * math.sin(within), self.centre[1] - self.radius * math.cos(within)


@dataclass(frozen=True)
class Clothoid:
    """The curve whose curvature grows with its length, up to a right angle; its axis is `flat` away from the tool's."""

    profile: Profile
    flat: float = 0.0

    def distance(self, r: Floats, z: Floats) -> Floats:
        r = r - self.flat
        grid = np.linspace(0.0, 1.0, TABLE)
        table_r, table_z = self.profile.at(grid)
        nearest = ((r[:, None] - table_r) ** 2 + (z[:, None] - table_z) ** 2).argmin(axis=1)
        low, high = grid[np.maximum(nearest - 1, 0)], grid[np.minimum(nearest + 1, TABLE - 1)]
        u = grid[nearest]
        for _ in range(30):  # the path ahead along the tangent falls from one end to the other
            at_r, at_z = self.profile.at(u)
            slope = 0.5 * np.pi * u * u
            ahead = (r - at_r) * np.cos(slope) + (z - at_z) * np.sin(slope)
            low, high = np.where(ahead > 0, u, low), np.where(ahead > 0, high, u)
            bend = np.pi * u * ((r - at_r) * np.sin(slope) - (z - at_z) * np.cos(slope)) + self.profile.curve
            step = np.where(bend > 0, u + ahead / np.where(bend > 0, bend, 1.0), 0.5 * (low + high))
            step = np.clip(step, low, high) - u
            u = u + step
            if np.abs(step).max(initial=0.0) < 1e-9:
                break
        at_r, at_z = self.profile.at(u)
        return np.asarray(np.hypot(r - at_r, z - at_z))

    def height(self, r: Floats) -> Floats:
        inside = np.maximum(r - self.flat, 0.0)
        return np.where(r >= self.flat, self.profile.height_at_radius(inside)[0], np.inf)

    def support(self, slope: float) -> tuple[float, float]:
        r, z = self.profile.at(np.array(math.sqrt(2 * slope / math.pi)))
        return self.flat + float(r), float(z)


@dataclass(frozen=True)
class Tool:
    """A convex solid of revolution that points down, grown by a ball, seen from a tip that stands higher by `raised`."""

    pieces: tuple[Piece, ...]
    base: tuple[float, float]
    ball: float = 0.0
    raised: float = 0.0
    """Of the point that the text moves over the tip that would stand on the model."""

    @classmethod
    def of(cls, profile: dict[str, Any], sheet: dict[str, Any] | None = None, model_face: str | None = None) -> Tool:
        """From a job's profile, sheet and the face of it that the model shows."""
        pieces, base = _pieces(profile)
        share = {"tool": 0.0, "mid": 0.5, "back": 1.0}[model_face or "tool"]
        between = share * sheet["thickness"] if sheet else 0.0
        constant = sheet is not None and sheet.get("law", "constant") == "constant"
        return cls(tuple(pieces), base, between if constant else 0.0, between)

    def holder(self, diameter: float, length: float) -> Tool:
        """A cylinder that begins at a length above this tool's tip and has no end."""
        radius = diameter / 2
        return Tool((Line((0.0, 0.0), (radius, 0.0)),), (radius, 0.0), self.ball, self.raised - length)

    @property
    def radius(self) -> float:
        """Of the solid with its ball, mm."""
        return self.base[0] + self.ball

    def distance(self, points: Floats) -> Floats:
        """Signed distance of points (N, 3), relative to the tip: negative inside."""
        r, z = np.hypot(points[:, 0], points[:, 1]), points[:, 2] + self.raised - self.ball
        cylinder = Line(self.base, (self.base[0], HIGH))
        away = np.min([piece.distance(r, z) for piece in (*self.pieces, cylinder)], axis=0)
        bottom = np.min([piece.height(r) for piece in self.pieces], axis=0)
        return np.asarray(np.where((r < self.base[0]) & (z > bottom), -away, away) - self.ball)

    def support(self, slope: float) -> tuple[float, float]:
        """Radius and height over the tip of the point that a plane of this slope, rad, touches."""
        points = [piece.support(slope) for piece in self.pieces]
        r, z = max(points, key=lambda point: point[0] * math.sin(slope) - point[1] * math.cos(slope))
        return r + self.ball * math.sin(slope), z + self.ball * (1 - math.cos(slope)) - self.raised


def _pieces(profile: dict[str, Any]) -> tuple[list[Piece], tuple[float, float]]:
    """Pieces from the tip to the base, and the base's radius and height."""
    kind, flat = profile["kind"], profile.get("tip_flat", 0.0)
    radius = profile["diameter"] / 2
    start: list[Piece] = [Line((0.0, 0.0), (flat, 0.0))] if flat > 0 else []
    if kind == "ball":
        ball = radius - flat
        return [*start, Round((flat, ball), ball, 0.0, math.pi / 2)], (radius, ball)
    if kind == "clothoid":
        curve = Clothoid(Profile.of({"kind": kind, "diameter": 2 * (radius - flat)}), flat)
        return [*start, curve], (radius, float(curve.profile.at(np.array(1.0))[1]))
    if kind == "flat":
        return [Line((0.0, 0.0), (radius, 0.0))], (radius, 0.0)
    if kind == "bull-nose":
        corner = profile["corner_radius"]
        end = Line((0.0, 0.0), (radius - corner, 0.0))
        return [end, Round((radius - corner, corner), corner, 0.0, math.pi / 2)], (radius, corner)
    if kind in ("cone", "tapered-ball"):
        ball, slope = profile.get("tip_radius", 0.0), math.radians(90.0 - profile["half_angle_deg"])
        foot = (ball * math.sin(slope), ball * (1 - math.cos(slope)))
        top = (radius, foot[1] + (radius - foot[0]) * math.tan(slope))
        tip: list[Piece] = [Round((0.0, ball), ball, 0.0, slope)] if ball > 0 else []
        return [*tip, Line(foot, top)], top
    if kind == "v" and not profile.get("tip_diameter", 0.0):
        top = (radius, radius / math.tan(math.radians(0.5 * profile["angle_deg"])))
        return [Line((0.0, 0.0), top)], top
    raise ValueError(f"no meridian for {kind}")
