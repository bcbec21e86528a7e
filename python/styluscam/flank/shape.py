"""The side of a tool: where it is straight, and how far it widens there."""

from __future__ import annotations

import math
from dataclasses import dataclass

from styluscam.errors import ToolError
from styluscam.tools.tool import Tool

UPRIGHT = 1e-9
"""A profile that ends this near to upright goes on as a cylinder, rad."""
STRAIGHT = 1e-6
"""A line that is shorter than this is none, mm across the axis."""


@dataclass(frozen=True)
class Flank:
    """A cylinder, or a cone that widens upwards. Lengths mm, angles rad."""

    radius: float
    """At its lower end."""
    half_angle: float
    height: float
    """Of its lower end over the tip."""
    top: float
    """How high it reaches over the tip; infinite where that is not known."""

    @classmethod
    def of(cls, tool: Tool) -> Flank:
        """The straight part at the end of a profile: a cylinder where that is upright, or where the profile is flat.

        Raises:
            ToolError: the profile ends round and slanting.
        """
        length = tool.to_dict().get("length")
        top = math.inf if length is None else float(length)
        if tool.max_slope == 0.0 or tool.max_slope >= 0.5 * math.pi - UPRIGHT:
            radius = 0.5 * tool.diameter
            return cls(radius, 0.0, float(tool.height_at_radius(radius)), top)
        inner, outer = (float(radius) for radius in tool.radius_range_at(tool.max_slope))
        if outer - inner < STRAIGHT:
            raise ToolError(
                f"tool: {tool.description} has no straight flank: it ends in a curve",
                code="tapered-flank",
                where="tool",
                hint="take a tool whose profile ends upright or in a straight line: flat, ball, cone, v, ...",
            )
        ends = (float(tool.height_at_radius(radius)) for radius in (inner, outer))
        return cls(inner, 0.5 * math.pi - tool.max_slope, *ends)

    @property
    def growth(self) -> float:
        """How much its radius grows for each mm of the axis."""
        return math.tan(self.half_angle)

    @property
    def rise(self) -> float:
        """Height over the tip at which the normals of its lower end meet the axis."""
        return self.height + self.radius * self.growth

    def needed(self, axis: float) -> float:
        """Height over the tip at which it touches the second rail, where the axis between both rails' normals is so long."""
        cosine = math.cos(self.half_angle)
        return self.rise + axis - (self.radius / cosine + axis * math.sin(self.half_angle)) * math.sin(self.half_angle)
