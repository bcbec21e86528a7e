"""Positions of a tool that mills a ruled surface with its flank."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal, TypeAlias

import numpy as np

from styluscam import _engine
from styluscam.arguments import refused
from styluscam.errors import GeometryError, ToolError
from styluscam.flank.rails import Rail, RailLike
from styluscam.tools.tool import Tool, ToolLike
from styluscam.types import FloatArray

Method: TypeAlias = Literal["swept", "rails", "three-points", "two-points", "one-point"]

ALONG, ACROSS = 161, 41
"""Points of the strip at which its error is measured."""
UPRIGHT = 1e-9
"""A profile that ends this near to upright goes on as a cylinder, rad."""


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
        """How deep the tool enters the surface at the worst, mm."""
        return max(0.0, -float(np.nanmin(self.left)))

    @property
    def under(self) -> float:
        """How much is left at the worst, mm."""
        return max(0.0, float(np.nanmax(self.left)))

    def between(self, first: float, last: float) -> FlankError:
        """The same of a part of the strip, by shares of the rails."""
        inside = (self.u >= first) & (self.u <= last)
        return FlankError(self.left[inside], self.u[inside], self.v)


@dataclass(frozen=True, eq=False)
class FlankPositions:
    """Positions of a tool along a ruled surface. Lengths mm."""

    tips: FloatArray
    """The tool's tip, (N, 3): its cylinder begins beside the first rail."""
    axes: FloatArray
    """Unit vectors from the tip up, (N, 3)."""
    contacts: FloatArray
    """Two points of each position at which it was made to touch, (N, 2, 3)."""
    radius: float
    """Of the flank."""
    method: Method
    _strip: _engine.RuledStrip = field(repr=False)
    _beside_rails: FloatArray = field(repr=False)

    @cached_property
    def error(self) -> FlankError:
        """What the tool leaves when it moves from position to position, its axis straight between them."""
        u, v = np.linspace(0.0, 1.0, ALONG), np.linspace(0.0, 1.0, ACROSS)
        shares = np.ascontiguousarray(np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1).reshape(-1, 2))
        first, second = (np.ascontiguousarray(self._beside_rails[:, end]) for end in (0, 1))
        return FlankError(self._strip.left(first, second, self.radius, shares).reshape(ALONG, ACROSS), u, v)


def flank_positions(
    rail0: RailLike,
    rail1: RailLike,
    tool: ToolLike,
    count: int,
    *,
    side: Literal["left", "right"] = "left",
    method: Method = "swept",
) -> FlankPositions:
    """``count`` positions of a cylinder along the ruled surface between two rails, evenly spread over their parameters.

    The tool's tip lies at the first rail's end. ``side`` is the one on which it moves, seen along the rails with the second above
    the first. Of the methods ``"swept"`` leaves least by far: both rails are touched, and the contacts are spread along them so
    that the surface that the movement leaves is nearest to the strip. ``"rails"`` touches both at equal parameters,
    ``"three-points"`` the ruling too, ``"two-points"`` and ``"one-point"`` offset points of the ruling. Any profile with an
    upright end, or a flat one, has a cylinder for a flank. See docs/concepts/flank.md.

    Raises:
        GeometryError: rails that meet, a cusp, a surface without a normal, a hollow that is too tight for the tool, no position.
        ToolError: the tool's flank is no cylinder.
    """
    if isinstance(count, bool) or not isinstance(count, int):
        raise refused("count", count, "a whole number", GeometryError)
    cutter = Tool.of(tool)
    if 0.0 < cutter.max_slope < 0.5 * math.pi - UPRIGHT:
        raise ToolError(
            f"tool: {cutter.description} has a tapered flank, and positions are known of cylinders only",
            code="tapered-flank",
            where="tool",
            hint="take a tool whose profile ends upright: flat, ball, ...",
        )
    radius = 0.5 * cutter.diameter
    strip = _engine.RuledStrip(Rail.of(rail0, "rail0").columns, Rail.of(rail1, "rail1").columns, side)
    beside, contacts = strip.positions(radius, max(count, 0), method)
    along = beside[:, 1] - beside[:, 0]
    axes = along / np.linalg.norm(along, axis=1, keepdims=True)
    tips = beside[:, 0] - float(cutter.height_at_radius(radius)) * axes
    return FlankPositions(tips, axes, contacts, radius, method, strip, beside)
