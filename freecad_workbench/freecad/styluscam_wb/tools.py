# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stylus tool bits: the exact profile as JSON in one property, the lengths that FreeCAD reads, and the solid it shows."""

from __future__ import annotations

import itertools
import json
import math
from typing import Any

from . import compat, engine

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

DERIVED = ("Diameter", "CuttingEdgeHeight")
"""Those that follow from the profile."""

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


def tool_document(bit: Any) -> dict[str, Any]:
    """The engine's document of a tool bit: a stylus, or one of FreeCAD's own that the engine has a profile for.

    Raises:
        ToolError: another kind of bit, or lengths that are not those of the profile.
    """
    document = _stylus_document(bit) if hasattr(bit, PROFILE) else {"profile": _native_profile(bit)}
    for key, name in (("length", "Length"), ("shank_diameter", "ShankDiameter")):
        value = _millimetres(bit, name)
        if value > 0.0 and abs(value - document.get(key, 0.0)) > ROUNDED:
            document[key] = value
    return document


def _stylus_document(bit: Any) -> dict[str, Any]:
    diameter, true = _millimetres(bit, "Diameter"), derived_lengths(bit.Profile)["Diameter"]
    if abs(true - diameter) > ROUNDED:
        raise ToolError(
            f"tool {bit.Label}: its Diameter is {diameter:g} mm, its profile's {true:g} mm: change the profile"
        )
    return exact_document(bit.Profile)


def _native_profile(bit: Any) -> dict[str, Any]:
    """The nearest profile of one of FreeCAD's own bits."""
    engine.styluscam()
    from styluscam.tools.fctb import NATIVE

    kind = compat.tool_kind(bit)
    reader = NATIVE.get(kind.replace("-", ""))
    profile = reader(lambda name: _millimetres(bit, name))[0] if reader else {"kind": ""}
    if profile["kind"] not in profile_kinds():
        raise ToolError(
            f"tool {bit.Label}: no profile is known for a bit of shape {kind or 'unknown'!r}: "
            f"choose a stylus or {', '.join(NATIVE)}"
        )
    return profile


def write_toolbit(bit: Any, path: str) -> None:
    """Writes a stylus, or a bit that there is a profile for, as FreeCAD's `.fctb` with exact numbers.

    Raises:
        ToolError, styluscam.StylusError: there is no profile for it, or the file cannot be written.
    """
    tool = engine.styluscam().Tool.from_dict({"title": bit.Label, **tool_document(bit)})
    tool.write(path)


def _millimetres(bit: Any, name: str) -> float:
    value = getattr(bit, name, 0.0)
    return float(getattr(value, "Value", value))


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
