"""A profile of each kind with sensible numbers: what ``styluscam tool new`` begins with."""

from __future__ import annotations

import copy
import difflib

from styluscam.errors import ToolError
from styluscam.tools import toolfile
from styluscam.types import Document

PROFILES: dict[str, Document] = {
    "ball": {"kind": "ball", "diameter": 10.0},
    "flat": {"kind": "flat", "diameter": 10.0},
    "cycloid": {"kind": "cycloid", "diameter": 12.0},
    "clothoid": {"kind": "clothoid", "diameter": 12.0},
    "parabola": {"kind": "parabola", "apex_radius": 6.0, "diameter": 14.0},
    "ellipse": {"kind": "ellipse", "radial": 6.0, "axial": 4.0},
    "power": {"kind": "power", "coefficient": 0.02, "exponent": 3.0, "diameter": 12.0},
    "rounded-rectangle": {"kind": "rounded-rectangle", "diameter": 12.0, "corner_radius": 3.0},
    "bull-nose": {"kind": "bull-nose", "diameter": 10.0, "corner_radius": 1.0},
    "barrel": {"kind": "barrel", "diameter": 10.0, "radius": 40.0, "tip_radius": 2.0},
    "cone": {"kind": "cone", "tip_radius": 0.5, "half_angle_deg": 30.0, "diameter": 10.0},
    "tapered-ball": {"kind": "tapered-ball", "tip_radius": 1.5, "half_angle_deg": 5.0, "diameter": 6.0},
    "v": {"kind": "v", "tip_diameter": 0.2, "angle_deg": 90.0, "diameter": 10.0},
    "points": {
        "kind": "points",
        "points": [[0.0, 0.0], [1.0, 0.05], [2.0, 0.21], [3.0, 0.5], [4.0, 1.0], [5.0, 2.0]],
        "fit_tolerance": 0.01,
    },
    "formula": {
        "kind": "formula",
        "r": "a * sin(t)",
        "z": "b * (1 - cos(t))",
        "t": [0.0, 1.5707963267948966],
        "parameters": {"a": 6.0, "b": 4.0},
    },
}
"""By kind; lengths in mm."""

LENGTH = 50.0
"""From the tip to the holder, mm."""


def starter(kind: str, name: str = "") -> Document:
    """A tool file's document of a kind, ready to be edited.

    Raises:
        ToolError: there is no such kind.
    """
    if kind not in PROFILES:
        near = difflib.get_close_matches(kind, PROFILES, n=1)
        hint = f"did you mean {near[0]!r}?" if near else f"known: {', '.join(PROFILES)}"
        raise ToolError(f"unknown kind {kind!r}", code="unknown-kind", where="kind", hint=hint)
    return _file(copy.deepcopy(PROFILES[kind]), name)


def measured(points: list[list[float]], fit_tolerance: float, name: str = "") -> Document:
    """A tool file's document with a profile through points: radii and heights, mm."""
    return _file({"kind": "points", "points": points, "fit_tolerance": fit_tolerance}, name)


def _file(profile: Document, name: str) -> Document:
    names = {"name": name} if name else {}
    return {"schema": toolfile.SCHEMA, **names, "profile": profile, "length": LENGTH}
