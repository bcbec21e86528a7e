# SPDX-License-Identifier: LGPL-2.1-or-later
"""A stylus as properties of a bit: the exact profile as JSON in one, the lengths that FreeCAD reads, the solid it shows."""

from __future__ import annotations

import itertools
import json
import math
from typing import Any

from . import engine

PROFILE = "Profile"

NAMING = ("schema", "name", "title")
"""Keys of a tool file around the tool: a job's tool has none of them."""

SHAPE_PROPERTIES = {
    PROFILE: ("App::PropertyString", "The exact profile, or the whole tool document, as JSON"),
    "Diameter": ("App::PropertyLength", "Diameter of the profile's base; follows from the profile"),
    "CuttingEdgeHeight": ("App::PropertyLength", "Height of the profile; follows from the profile"),
    "Length": ("App::PropertyLength", "Length from the tip to the holder"),
    "ShankDiameter": ("App::PropertyLength", "Diameter of the shank"),
}
"""Properties of a stylus bit: type and description by name."""

PROFILE_POINTS = 33
"""Points of the meridian that the shown solid goes through."""


class ToolError(ValueError):
    """A tool bit that no path can be planned for; the message states why."""


def derived_lengths(profile: str) -> dict[str, float]:
    """Diameter and height (mm) of a profile, or a tool document, given as JSON."""
    tool = engine.styluscam().Tool.from_dict(exact_document(profile))
    return {"Diameter": tool.diameter, "CuttingEdgeHeight": float(tool.height_at(tool.max_slope))}


def exact_document(profile: str) -> dict[str, Any]:
    """The tool document in the text of the property `Profile`, which holds one, or a profile alone.

    Raises:
        ToolError: it is neither.
    """
    parsed = _parsed(profile)
    if "profile" not in parsed:
        return {"profile": parsed}
    return {key: value for key, value in parsed.items() if key not in NAMING}


def _parsed(profile: str) -> dict[str, Any]:
    try:
        parsed = json.loads(profile)
    except ValueError as error:
        raise ToolError(f"the tool's profile is not JSON ({error}); an example: {_example()}") from error
    if not isinstance(parsed, dict):
        raise ToolError(f"the tool's profile is not a JSON object; an example: {_example()}")
    return parsed


def _example() -> str:
    return json.dumps({"kind": profile_kinds()[0], "diameter": 10.0})


def profile_kinds() -> list[str]:
    """The kinds of profiles that the engine has."""
    kinds = engine.styluscam().job_schema()["$defs"]["ProfileDocument"]["oneOf"]
    return [str(kind["properties"]["kind"]["const"]) for kind in kinds]


def solid_of(parameters: dict[str, Any]) -> Any:
    """The revolved solid of a stylus (Part.Shape), its tip at the origin; `parameters` as in `SHAPE_PROPERTIES`."""
    import Part
    from FreeCAD import Vector

    document = exact_document(parameters[PROFILE])
    tool = engine.styluscam().Tool.from_dict(document)
    from styluscam.tools.outline import pieces, transition

    shank, top = float(parameters["ShankDiameter"]) / 2.0, float(parameters["Length"])
    edges, rim = [], Vector()
    for piece in pieces(tool, PROFILE_POINTS):
        points = [Vector(float(r), 0.0, float(z)) for r, z in piece.points]
        edges.append(Part.makeLine(*points) if piece.straight else _curve(points))
        rim = points[-1]
    above = transition(document.get("base"), (rim.x, rim.z), shank)[1:]
    base = [Vector(float(r), 0.0, float(z)) for r, z in above]
    corners = [rim, *base, Vector(shank, 0.0, top), Vector(0.0, 0.0, top), Vector()]
    for a, b in itertools.pairwise(corners):
        if a.distanceToPoint(b) > 1e-7:
            edges.append(Part.makeLine(a, b))
    turned = Part.Face(Part.Wire(edges)).revolve(Vector(), Vector(0.0, 0.0, 1.0), 360.0)
    return turned if math.isfinite(turned.Volume) and turned.Volume > 0.0 else turned.reversed()


def _curve(points: list[Any]) -> Any:
    """An edge through points."""
    import Part

    curve = Part.BSplineCurve()
    curve.interpolate(points)
    return curve.toShape()
