"""Exact tip heights over a fixture's meridian, in numpy; nothing of StylusCAM takes part.

A fixture's height depends on one distance alone (`fixtures/truth/rolling.py` has the proof): d from the axis, or from the
core square. So the tip height at the signed distance D is the largest z(d) - Z(|d - D|) along the meridian, and it is taken
at a slope match inside a piece or at a piece's end. Every piece's own height is kept: the free side of a kink is the
intersection of the free sides of the pieces that meet there.
"""

from __future__ import annotations

import itertools
import json
import math
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

Floats: TypeAlias = NDArray[np.float64]

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"
SETTLED = 1e-11  # mm: the largest error of a solved slope match's position


def fresnel(u: Floats) -> tuple[Floats, Floats]:
    """C(u) and S(u) for 0 <= u <= 1 by their power series (DLMF 7.6.4, 7.6.6)."""
    x = 0.5 * np.pi * u * u
    c = s = np.zeros_like(x)
    for n in range(12, -1, -1):
        c = (-1) ** n / (math.factorial(2 * n) * (4 * n + 1)) + x * x * c
        s = (-1) ** n / (math.factorial(2 * n + 1) * (4 * n + 3)) + x * x * s
    return u * c, u * x * s


@dataclass(frozen=True)
class Profile:
    """Clothoid (of arc length `curve`) grown by a ball of radius `ball`; a ball is nothing grown. By u: slope pi u^2/2."""

    curve: float
    ball: float

    @classmethod
    def of(cls, document: dict[str, Any], grown: float = 0.0) -> Profile:
        """From a tool's profile document, grown by a sheet of constant thickness."""
        half = document["diameter"] / 2
        if document["kind"] == "ball":
            return cls(0.0, half + grown)
        return cls(half / float(fresnel(np.array(1.0))[0]), grown)

    def at(self, u: Floats) -> tuple[Floats, Floats]:
        """Radius and height, mm."""
        c, s = fresnel(u)
        phi = 0.5 * np.pi * u * u
        return self.curve * c + self.ball * np.sin(phi), self.curve * s + 2 * self.ball * np.sin(0.5 * phi) ** 2

    @cached_property
    def _table(self) -> tuple[Floats, Floats]:
        u = np.linspace(0.0, 1.0, 4001)
        return u, self.at(u)[0]

    def height_at_radius(self, r: Floats) -> tuple[Floats, Floats]:
        """Height (mm; infinite beyond the base) and u at the radius r."""
        if self.curve == 0.0:
            sine = np.minimum(r / self.ball, 1.0)
            u = np.sqrt(np.arcsin(sine) * 2 / np.pi)
        else:
            grid, radius = self._table
            u = np.interp(r, radius, grid)
            for _ in range(6):
                step = (self.at(u)[0] - r) / np.maximum(_speed(u) * (self.curve + np.pi * u * self.ball), 1e-9)
                u = np.clip(u - step, 0.0, 1.0)
        return np.where(r <= self.at(np.array(1.0))[0], self.at(u)[1], np.inf), u


def _speed(u: Floats) -> Floats:
    """Cosine of the slope."""
    return np.cos(0.5 * np.pi * u * u)


@dataclass(frozen=True)
class Envelope:
    """Tip heights by piece: (N, pieces), -inf where a piece does not match, with the cosine of the slope there."""

    tips: Floats
    cosines: Floats

    @property
    def height(self) -> Floats:
        """Exact tip height (N,)."""
        return np.asarray(self.tips.max(axis=1))

    @property
    def cosine(self) -> Floats:
        """Cosine of the slope where the tool rests."""
        return np.asarray(np.take_along_axis(self.cosines, self.tips.argmax(axis=1)[:, None], axis=1)[:, 0])

    def clearance(self, z: Floats) -> Floats:
        """Distance of tips at heights z from the envelope along its normal: positive free, negative inside."""
        above = (z[:, None] - self.tips) * self.cosines
        return np.asarray(np.where(np.isfinite(self.tips), above, np.inf).min(axis=1))


class Meridian:
    """A fixture's meridian; `sheet` is one of the keys of its JSON."""

    def __init__(self, document: dict[str, Any]) -> None:
        self.document = document
        self.core = float(document["meridian"]["core_half_side"])
        self.pieces = document["meridian"]["segments"]

    @classmethod
    def of(cls, part: str) -> Meridian:
        """Of the fixture with this name."""
        return cls(json.loads((FIXTURES / f"{part}.json").read_text(encoding="utf-8")))

    def distance(self, xy: Floats) -> Floats:
        """Signed distance from the axis, or from the core square (negative inside)."""
        if self.core == 0.0:
            return np.asarray(np.hypot(xy[:, 0], xy[:, 1]))
        away = np.abs(xy) - self.core
        return np.asarray(np.linalg.norm(np.maximum(away, 0.0), axis=1) + np.minimum(away.max(axis=1), 0.0))

    def envelope(self, xy: Floats, tool: str, sheet: str) -> Envelope:
        """Exact envelope over the positions (N, 2): the tool's tip in the model's frame."""
        section = self.document["sheets"][sheet]
        thickness = section["thickness"] if section else 0.0
        grown = thickness if section and section["law"] == "constant" else 0.0
        profile = Profile.of(self.document["tools"][tool], grown)
        axis = self.distance(np.asarray(xy, dtype=np.float64))
        columns = [column for piece in self.pieces for column in self._columns(piece, profile, axis)]
        return Envelope(
            np.stack([tip for tip, _ in columns], axis=1) + thickness,
            np.stack([cosine for _, cosine in columns], axis=1),
        )

    def _columns(self, piece: dict[str, Any], profile: Profile, axis: Floats) -> list[tuple[Floats, Floats]]:
        matches = [_line(piece, profile, axis)] if piece["kind"] == "line" else _arc(piece, profile, axis)
        return matches + [_end(end, profile, axis) for end in (piece["from"], piece["to"])]


def _line(piece: dict[str, Any], profile: Profile, axis: Floats) -> tuple[Floats, Floats]:
    (d0, z0), (d1, z1) = piece["from"], piece["to"]
    psi = math.atan2(z1 - z0, d1 - d0)
    r, height = profile.at(np.sqrt(np.array(abs(psi)) * 2 / np.pi))
    d = axis + np.sign(psi) * r
    on = (d <= d1) & ((d >= d0) | ((psi == 0.0) & (d0 == 0.0)))
    tip = np.where(on, z0 + (d - d0) * math.tan(psi) - height, -np.inf)
    return tip, np.full_like(tip, math.cos(psi))


def _end(end: list[float], profile: Profile, axis: Floats) -> tuple[Floats, Floats]:
    height, u = profile.height_at_radius(np.abs(end[0] - axis))
    return end[1] - height, _speed(u)


def _arc(piece: dict[str, Any], profile: Profile, axis: Floats) -> list[tuple[Floats, Floats]]:
    """Matches on each stretch of the arc over which the tool's position D(u) is monotonic."""
    reach = piece["radius"] * (1 if piece["bend"] == "concave" else -1)
    (d_centre, z_centre), slopes = piece["centre"], np.radians(piece["signed_slope_deg"])
    sign = 1.0 if slopes.sum() > 0 else -1.0
    ends = np.sort(np.sqrt(np.abs(slopes) * 2 / np.pi))

    def position(u: Floats) -> Floats:
        phi = 0.5 * np.pi * u * u
        return np.asarray(d_centre + sign * (reach * np.sin(phi) - profile.at(u)[0]))

    def rate(u: Floats) -> Floats:
        return np.asarray(sign * _speed(u) * (np.pi * u * (reach - profile.ball) - profile.curve))

    turn = profile.curve / (np.pi * (reach - profile.ball)) if reach > profile.ball else np.inf
    knots = [ends[0], *([turn] if ends[0] < turn < ends[1] else []), ends[1]]
    found = []
    for low, high in itertools.pairwise(knots):
        grid = np.linspace(low, high, 4001)
        positions = position(grid)
        order = slice(None, None, 1 if positions[-1] > positions[0] else -1)
        u = np.interp(axis, positions[order], grid[order])
        inside = (axis >= positions.min()) & (axis <= positions.max())
        for _ in range(8):
            slope = rate(u)
            step = np.where(np.abs(slope) > 1e-12, (position(u) - axis) / np.where(slope == 0, 1.0, slope), 0.0)
            u = np.clip(u - step, low, high)
        # unsettled only beside the turn, where the tool cannot rest: it is held elsewhere
        inside &= np.abs(position(u) - axis) < SETTLED
        phi = 0.5 * np.pi * u * u
        z = z_centre - reach * np.cos(phi)
        found.append((np.where(inside, z - profile.at(u)[1], -np.inf), _speed(u)))
    return found
