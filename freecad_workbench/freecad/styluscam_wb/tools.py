# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stylus tool bits: the exact profile as JSON in one property, the lengths that FreeCAD reads, and the solid it shows."""

from __future__ import annotations

import itertools
import json
import math
from typing import Any

from . import compat, engine

PROFILE = "Profile"

SHAPE_PROPERTIES = {
    PROFILE: ("App::PropertyString", "The exact profile, as the tool document's JSON"),
    "Diameter": ("App::PropertyLength", "Diameter of the profile's base; follows from the profile"),
    "CuttingEdgeHeight": ("App::PropertyLength", "Height of the profile; follows from the profile"),
    "Length": ("App::PropertyLength", "Length from the tip to the holder"),
    "ShankDiameter": ("App::PropertyLength", "Diameter of the shank"),
}
"""Properties of a stylus bit: type and description by name."""

DERIVED = ("Diameter", "CuttingEdgeHeight")
"""Those that follow from the profile."""

NATIVE = {"ballend": "ball"}
"""Profile kinds of FreeCAD's own tool bits that a diameter describes."""

SHANK_OVER_PROFILE = 40.0
"""Length of the shank over the profile unless it is given, mm."""

ROUNDED = 0.01
"""Tool files hold lengths with the user's decimals: more than this (mm) is another tool."""

PROFILE_POINTS = 33
"""Points of the meridian that the shown solid goes through."""


class ToolError(ValueError):
    """A tool bit that no path can be planned for; the message says why."""


def create_stylus(
    document: Any,
    label: str,
    profile: dict[str, Any],
    *,
    length: float | None = None,
    shank_diameter: float | None = None,
) -> Any:
    """A stylus tool bit of this profile (`{"kind": "clothoid", "diameter": 10.0}`; lengths mm).

    Raises:
        EngineMissingError, styluscam.ToolError: there is no engine, or it refuses the profile.
    """
    lengths = derived_lengths(json.dumps(profile))
    lengths["Length"] = lengths["CuttingEdgeHeight"] + SHANK_OVER_PROFILE if length is None else length
    lengths["ShankDiameter"] = lengths["Diameter"] if shank_diameter is None else shank_diameter
    return compat.make_toolbit(document, label, {PROFILE: json.dumps(profile), **lengths})


def derived_lengths(profile: str) -> dict[str, float]:
    """Diameter and height (mm) of a profile given as JSON."""
    tool = engine.styluscam().Tool.from_dict({"profile": _parsed(profile)})
    return {"Diameter": tool.diameter, "CuttingEdgeHeight": float(tool.height_at(tool.max_slope))}


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


def tool_document(bit: Any) -> dict[str, Any]:
    """The engine's document of a tool bit: a stylus, or one of FreeCAD's own that the engine has a profile for.

    Raises:
        ToolError: another kind of bit, or lengths that are not those of the profile.
    """
    diameter = _millimetres(bit, "Diameter")
    if hasattr(bit, PROFILE):
        profile = _parsed(bit.Profile)
        true = derived_lengths(bit.Profile)["Diameter"]
        if abs(true - diameter) > ROUNDED:
            raise ToolError(
                f"tool {bit.Label}: its Diameter is {diameter:g} mm, its profile's {true:g} mm: change the profile"
            )
    else:
        profile = {"kind": _native_kind(bit), "diameter": diameter}
    document: dict[str, Any] = {"profile": profile}
    for key, name in (("length", "Length"), ("shank_diameter", "ShankDiameter")):
        value = _millimetres(bit, name)
        if value > 0.0:
            document[key] = value
    return document


def _native_kind(bit: Any) -> str:
    kind = NATIVE.get(compat.tool_kind(bit))
    if kind is None or kind not in profile_kinds():
        raise ToolError(
            f"tool {bit.Label}: no profile is known for a bit of shape {compat.tool_kind(bit) or 'unknown'!r}: "
            f"choose a stylus or {', '.join(NATIVE)}"
        )
    return kind


def _millimetres(bit: Any, name: str) -> float:
    value = getattr(bit, name, 0.0)
    return float(getattr(value, "Value", value))


def solid_of(parameters: dict[str, Any]) -> Any:
    """The revolved solid of a stylus (Part.Shape), its tip at the origin; `parameters` as in `SHAPE_PROPERTIES`."""
    import Part
    from FreeCAD import Vector

    profile = _parsed(parameters[PROFILE])
    tool = engine.styluscam().Tool.from_dict({"profile": profile})
    slopes = [tool.max_slope * i / (PROFILE_POINTS - 1) for i in range(PROFILE_POINTS)]
    meridian = [Vector(float(tool.radius_at(s)), 0.0, float(tool.height_at(s))) for s in slopes]
    shank, top = float(parameters["ShankDiameter"]) / 2.0, float(parameters["Length"])
    curve = Part.BSplineCurve()
    curve.interpolate(meridian)
    foot, rim = meridian[0], meridian[-1]
    corners = [rim, Vector(shank, 0.0, rim.z), Vector(shank, 0.0, top), Vector(0.0, 0.0, top), Vector(), foot]
    edges = [curve.toShape()]
    for a, b in itertools.pairwise(corners):
        if a.distanceToPoint(b) > 1e-7:
            edges.append(Part.makeLine(a, b))
    turned = Part.Face(Part.Wire(edges)).revolve(Vector(), Vector(0.0, 0.0, 1.0), 360.0)
    return turned if math.isfinite(turned.Volume) and turned.Volume > 0.0 else turned.reversed()
