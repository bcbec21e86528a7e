"""Positions of a tool that mills a ruled surface with its flank."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from styluscam import _engine
from styluscam.arguments import refused
from styluscam.errors import GeometryError, ToolError
from styluscam.flank.rails import Rail, RailLike
from styluscam.flank.shape import Flank
from styluscam.tools.tool import Tool, ToolLike
from styluscam.types import FloatArray, points

Method: TypeAlias = Literal["swept", "rails", "three-points", "two-points", "one-point"]

ALONG, ACROSS = 161, 41
"""Points of the strip at which its error is measured."""


@dataclass(frozen=True, eq=False)
class FlankError:
    """What a moving tool leaves of a strip, measured along its normals on the surface that it sweeps. Lengths mm."""

    left: FloatArray
    """At shares ``u`` of the rails and ``v`` of the rulings, (U, V): above 0 what stands, below 0 what is cut too deep; NaN where
    the first or the last position comes nearest, for what the tool does before and behind is not known."""
    u: FloatArray
    v: FloatArray

    @property
    def over(self) -> float:
        """How deep the tool enters the surface at the worst, mm; NaN where that is known nowhere."""
        return self._worst(-1.0)

    @property
    def under(self) -> float:
        """How much is left at the worst, mm; NaN where that is known nowhere."""
        return self._worst(1.0)

    def _worst(self, sign: float) -> float:
        known = sign * self.left[np.isfinite(self.left)]
        return max(0.0, float(known.max())) if known.size else math.nan

    def between(self, first: float, last: float) -> FlankError:
        """The same of a part of the strip, by shares of the rails."""
        inside = (self.u >= first) & (self.u <= last)
        return FlankError(self.left[inside], self.u[inside], self.v)


@dataclass(frozen=True, eq=False)
class FlankPositions:
    """Positions of a tool along a ruled surface. Lengths mm."""

    tips: FloatArray
    """The tool's tip, (N, 3): its flank begins beside the first rail."""
    axes: FloatArray
    """Unit vectors from the tip up, (N, 3)."""
    contacts: FloatArray
    """Two points of each position at which it was made to touch, (N, 2, 3)."""
    tool: Tool
    method: Method
    _flank: Flank = field(repr=False)
    _strip: _engine.RuledStrip = field(repr=False)
    _beside_rails: FloatArray = field(repr=False)

    @cached_property
    def error(self) -> FlankError:
        """What the tool leaves when it moves from position to position, its tip along a line and its axis turning with it."""
        u, v = np.linspace(0.0, 1.0, ALONG), np.linspace(0.0, 1.0, ACROSS)
        shares = np.ascontiguousarray(np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1).reshape(-1, 2))
        # points of equal height over the tip go along lines
        first = self._beside_rails[:, 0]
        second = first + np.linalg.norm(self._beside_rails[:, 1] - first, axis=1).max() * self.axes
        first, second = np.ascontiguousarray(first), np.ascontiguousarray(second)
        # the first of the points lies higher than the lower end, where the flank is wider
        shape = self._flank.radius / math.cos(self._flank.half_angle) ** 2, self._flank.growth
        return FlankError(self._strip.left(first, second, shape, shares).reshape(ALONG, ACROSS), u, v)

    @property
    def radius(self) -> float:
        """Of the flank, where it begins."""
        return self._flank.radius

    def clearance(self, others: npt.ArrayLike) -> FloatArray:
        """How near the whole tool comes to points (N, 3) of other faces when it moves from position to position, mm (N,).

        Below 0 it enters, by so much: with its end, with its flank, or above it; the shank is taken to be as wide as the flank's
        wide end.
        """
        given = np.ascontiguousarray(points(others, 3, "others"))
        return _engine.clearance_of_tilted(self.tool._engine, self.tips, self.axes, given)

    def turning(self, feed: float) -> AxisTurning:
        """How fast the axis turns when the contacts move at ``feed``, mm/min."""
        if not (math.isfinite(feed) and feed > 0.0):
            raise refused("feed", feed, "mm/min, above 0", GeometryError)
        lengths = np.linalg.norm(np.diff(self.contacts.mean(axis=1), axis=0), axis=1)
        times = 60.0 * lengths / feed
        rates = np.cross(self.axes[:-1], self.axes[1:]) / times[:, None]
        between = 0.5 * (times[1:] + times[:-1])
        changes = np.linalg.norm(np.diff(rates, axis=0), axis=1) / between
        return AxisTurning(np.degrees(np.linalg.norm(rates, axis=1)), np.degrees(changes))


@dataclass(frozen=True, eq=False)
class AxisTurning:
    """How a tool's axis turns along its positions."""

    speed: FloatArray
    """In every move, deg/s (N - 1,)."""
    acceleration: FloatArray
    """From one to the next, deg/s^2 (N - 2,)."""


def flank_positions(
    rail0: RailLike,
    rail1: RailLike,
    tool: ToolLike,
    count: int | None = None,
    *,
    tolerance: float | None = None,
    side: Literal["left", "right"] = "left",
    method: Method = "swept",
) -> FlankPositions:
    """Positions of a tool's flank along the ruled surface between two rails.

    Either ``count`` of them, evenly spread over the rails' parameters, or as few as are needed that straight moves between them
    (the tip along a line, the axis turning with it) leave the continuous movement by no more than ``tolerance``, mm, anywhere
    along the flank's height: denser where it bends.

    The flank begins at the first rail, the tip lies beyond it. ``side`` is the one on which it moves, seen along the rails with
    the second above the first. Of the methods ``"swept"`` leaves least by far: both rails are touched, and the contacts are
    spread along them so that the surface that the movement leaves is nearest to the strip. ``"rails"`` touches both at equal
    parameters, ``"three-points"`` the ruling too, ``"two-points"`` and ``"one-point"`` offset points of the ruling. Any profile
    with an upright end, or a flat one, has a cylinder for a flank; one that ends in a slanting line, a cone. See
    docs/concepts/flank.md.

    Raises:
        GeometryError: both or none of count and tolerance; rails that meet, a cusp, a surface without a normal, a hollow that is
            too tight for the tool, no position.
        ToolError: the tool's flank is neither cylinder nor cone, or too short for the rulings.
    """
    if (count is None) == (tolerance is None):
        given = {"count": count, "tolerance": tolerance}
        raise refused("count", given, "either count or tolerance", GeometryError)
    if count is not None and (isinstance(count, bool) or not isinstance(count, int)):
        raise refused("count", count, "a whole number", GeometryError)
    if tolerance is not None and (isinstance(tolerance, bool) or not isinstance(tolerance, (int, float))):
        raise refused("tolerance", tolerance, "a length, mm", GeometryError)
    cutter = Tool.of(tool)
    flank = Flank.of(cutter)
    strip = _engine.RuledStrip(Rail.of(rail0, "rail0").columns, Rail.of(rail1, "rail1").columns, side)
    if tolerance is None:
        beside, contacts = strip.positions(flank.radius, flank.half_angle, max(count or 0, 0), method)
    else:
        beside, contacts = strip.positions_within(flank.radius, flank.half_angle, float(tolerance), method)
    along = beside[:, 1] - beside[:, 0]
    lengths = np.linalg.norm(along, axis=1)
    needed = cutter._engine.flank_needed(float(lengths.max()))
    if needed > flank.top:
        raise ToolError(
            f"tool: {cutter.description} reaches {flank.top:.3f} mm up from its tip, the rulings {needed:.3f} mm",
            code="short-flank",
            where="tool",
            hint="take a longer tool, or part the surface along its rulings' length",
        )
    axes = along / lengths[:, None]
    return FlankPositions(beside[:, 0] - flank.rise * axes, axes, contacts, cutter, method, flank, strip, beside)
