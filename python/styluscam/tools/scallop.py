"""Scallops on planar walls, exact for any convex profile: no radius of curvature is assumed to be constant.

Look along the passes. Each pass leaves the tool's section, and the next pass the same section moved along the wall by
the spacing p. Cut the section by a line parallel to the wall at the height h over it: the chord grows with h, and the two
sections cross where it is as long as p. So the scallop of a spacing is the height of the chord of that length. Where p is
small this is p^2 / (8 rho), rho the profile's radius of curvature at the wall's slope.

The slope at which a chord ends is searched for: the engine inverts profiles by radius and by height over the tip, and a
chord ends at a height over the wall, for which no kind of profile has a closed form.

Walls are named by their angle in degrees, 0 for a floor and 90 for a vertical wall; lengths are mm. Passes are level lines
(Z-levels, spirals), so that the spacing runs straight up the wall; :func:`scallop_of_rows` is for rows that do so themselves.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
import numpy.typing as npt

from styluscam.errors import ToolError
from styluscam.types import FloatArray

HALVINGS = 64
"""Of a slope or a height: more than a double distinguishes."""

THIRDS = 100
"""Steps of a search by thirds: each leaves two thirds of the interval."""

SIDE = 1e3
"""The base goes on as a cylinder of this many diameters: longer than any chord that matters."""


class Meridian(Protocol):
    """What is asked of a profile: a :class:`styluscam.Tool` answers, and so does a closed form."""

    @property
    def max_slope(self) -> float:
        """Slope at which the profile ends, rad."""

    def radius_range_at(self, slope: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Inner and outer radius (mm) by slope (rad)."""

    def height_at(self, slope: npt.ArrayLike) -> FloatArray:
        """Height over the tip (mm) at the outer radius, by slope (rad)."""


class Radial(Meridian, Protocol):
    """A profile that also answers by radius."""

    def height_at_radius(self, radius: npt.ArrayLike) -> FloatArray:
        """Height over the tip (mm) by radius (mm)."""


def scallop_of_spacing(tool: Meridian, wall_deg: npt.ArrayLike, spacing: npt.ArrayLike) -> FloatArray:
    """Scallop height (mm) by wall angle (degrees, 0 < angle < 90) and spacing along the wall (mm).

    NaN where the passes lie farther apart than the tool is wide: a strip between them is not touched at all.

    Raises:
        ToolError: an angle or a spacing beyond those.
    """
    walls, spacings = _checked(wall_deg, spacing)
    wanted = spacings.ravel()
    section = _Section(tool, np.radians(walls.ravel()))
    low, high = np.zeros(len(wanted)), np.full(len(wanted), section.highest)
    touched = section.chord(high) >= wanted
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        wide = section.chord(middle) >= wanted
        high, low = np.where(wide, middle, high), np.where(wide, low, middle)
    return np.where(touched, high, np.nan).reshape(walls.shape)


def spacing_of_scallop(tool: Meridian, wall_deg: npt.ArrayLike, height: npt.ArrayLike) -> FloatArray:
    """Spacing along the wall (mm) that leaves a scallop of a height (mm), by wall angle (degrees, 0 < angle < 90).

    The inverse of :func:`scallop_of_spacing`, and much quicker; no longer than the tool is wide.

    Raises:
        ToolError: an angle or a height beyond those.
    """
    walls, heights = _checked(wall_deg, height, "height")
    section = _Section(tool, np.radians(walls.ravel()))
    return section.chord(np.minimum(heights.ravel(), section.highest)).reshape(walls.shape)


def scallop_of_step(tool: Meridian, wall_deg: npt.ArrayLike, step: npt.ArrayLike) -> FloatArray:
    """Scallop height (mm) by wall angle (degrees, 0 < angle < 90) and step down between Z-levels (mm).

    NaN and errors as of :func:`scallop_of_spacing`.
    """
    walls, steps = _checked(wall_deg, step)
    return scallop_of_spacing(tool, walls, steps / np.sin(np.radians(walls)))


def scallop_of_rows(tool: Radial, wall_deg: npt.ArrayLike, spacing: npt.ArrayLike) -> FloatArray:
    """Scallop height (mm) of rows straight up the wall, by wall angle (degrees, 0 < angle < 90) and spacing (mm).

    Half a spacing beside the row the tool is cut by an upright plane; what stays below the cut is the scallop. There a
    point at radius r stands Z(r) cos a - sqrt(r^2 - p^2/4) sin a over a plane parallel to the wall: lowest at one r.
    For small spacings it is p^2 sin a / (8 r), r the radius at the wall's slope. NaN beyond the tool's width.

    Raises:
        ToolError: as :func:`scallop_of_spacing`.
    """
    walls, spacings = _checked(wall_deg, spacing)
    angle, aside = np.radians(walls.ravel()), 0.5 * spacings.ravel()
    rim = float(np.asarray(tool.radius_range_at(tool.max_slope)[1]))

    def over(radius: FloatArray, offset: FloatArray) -> FloatArray:
        reach = np.sqrt(np.maximum(radius**2 - offset**2, 0.0))
        return np.asarray(tool.height_at_radius(radius) * np.cos(angle) - reach * np.sin(angle))

    def lowest(offset: FloatArray) -> FloatArray:
        low, high = np.minimum(offset, rim), np.full(len(offset), rim)
        for _ in range(THIRDS):
            a, b = low + (high - low) / 3.0, high - (high - low) / 3.0
            falls = over(a, offset) > over(b, offset)
            low, high = np.where(falls, a, low), np.where(falls, high, b)
        return over(0.5 * (low + high), offset)

    scallop = lowest(aside) - lowest(np.zeros(len(aside)))
    return np.where(aside < rim, scallop, np.nan).reshape(walls.shape)


def _checked(wall_deg: npt.ArrayLike, lengths: npt.ArrayLike, what: str = "spacing") -> tuple[FloatArray, FloatArray]:
    """Wall angles and lengths (spacings, or what is named) of one shape, in their ranges."""
    walls, spacings = np.broadcast_arrays(np.asarray(wall_deg, dtype=np.float64), np.asarray(lengths, dtype=np.float64))
    for name, values, good in (
        ("wall_deg", walls, (walls > 0.0) & (walls < 90.0)),
        (what, spacings, (spacings > 0.0) & np.isfinite(spacings)),
    ):
        if not good.all():
            hint = "walls lie between 0 and 90 degrees, passes some distance apart"
            message = f"{name} = {values[~good].flat[0]:g}: out of range"
            raise ToolError(message, code="out-of-range", where=name, hint=hint)
    return walls, spacings


class _Section:
    """The tool's section against a wall of each slope: chords parallel to it."""

    def __init__(self, tool: Meridian, walls: FloatArray) -> None:
        self._tool = tool
        self._top = tool.max_slope
        self._rim = float(np.asarray(tool.radius_range_at(self._top)[1]))
        self._rise = float(np.asarray(tool.height_at(self._top)))
        self._sin, self._cos = np.sin(walls), np.cos(walls)
        self._walls = walls
        self._foot = self._outline(walls)
        self.highest = max(2.0 * self._rim, self._rise)
        """A height (mm) over the wall that is above every scallop of a tool that touches all of it."""

    def chord(self, height: FloatArray) -> FloatArray:
        """Length of the chord at a height over each wall, mm."""
        up = self._along(height, self._walls, np.full(len(height), np.pi / 2.0))
        down = self._along(height, self._walls, np.full(len(height), -np.pi / 2.0))
        return up - down

    def _along(self, height: FloatArray, near: FloatArray, far: FloatArray) -> FloatArray:
        """Where the outline between two slopes is at a height over the wall: distance along the wall, mm.

        The slope is halved down to neighbouring numbers; between their points the outline is straight, be it because
        they are so near or because a straight part of the profile lies there.
        """
        for _ in range(HALVINGS):
            middle = 0.5 * (near + far)
            below = self._seen(self._outline(middle))[1] < height
            near, far = np.where(below, middle, near), np.where(below, far, middle)
        (s0, d0), (s1, d1) = self._seen(self._outline(near)), self._seen(self._outline(far))
        rise = np.where(d1 > d0, d1 - d0, 1.0)
        share = np.clip((height - d0) / rise, 0.0, 1.0)
        return np.asarray(s0 + share * (s1 - s0))

    def _seen(self, points: tuple[FloatArray, FloatArray]) -> tuple[FloatArray, FloatArray]:
        """From radius and height to distances along the wall and over it."""
        r, z = points[0] - self._foot[0], points[1] - self._foot[1]
        return r * self._cos + z * self._sin, z * self._cos - r * self._sin

    def _outline(self, slope: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The section's point by slope from -90 (the far side) to 90 degrees: the end of a straight part away from 0."""
        size = np.abs(slope)
        asked = np.minimum(size, self._top)
        r, z = self._tool.radius_range_at(asked)[1], self._tool.height_at(asked)
        upright = size >= np.pi / 2.0
        z = np.where(upright, self._rise + SIDE * 2.0 * self._rim, z)
        return np.copysign(np.where(upright, self._rim, r), slope), z
