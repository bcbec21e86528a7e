"""The side of a tool: where it is straight, and how far it widens there."""

from __future__ import annotations

import math
from dataclasses import dataclass

from styluscam.tools.tool import Tool


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
        return cls(*tool._engine.flank())

    @property
    def growth(self) -> float:
        """How much its radius grows for each mm of the axis."""
        return math.tan(self.half_angle)

    @property
    def rise(self) -> float:
        """Height over the tip at which the normals of its lower end meet the axis."""
        return self.height + self.radius * self.growth
