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

FOLLOWING = (PROFILE, "Diameter", "CuttingEdgeHeight")
"""Properties that are not typed: the profile, which the panel edits, and what follows from it."""

SHANK_OVER_PROFILE = 40.0
"""Length of the shank over profile and base unless it is given, mm."""


class ToolError(ValueError):
    """A tool bit that no path can be planned for; the message states why."""


def derived_lengths(profile: str) -> dict[str, float]:
    """Diameter and height (mm) of a profile, or a tool document, given as JSON."""
    lengths = lengths_of(exact_document(profile))
    return {name: lengths[name] for name in ("Diameter", "CuttingEdgeHeight")}


def lengths_of(document: dict[str, Any]) -> dict[str, float]:
    """All lengths (mm) of a tool document, by property; with usual ones where it states none.

    Raises:
        styluscam.ToolError: the engine refuses it.
    """
    tool = engine.styluscam().Tool.from_dict(document)
    height = float(tool.height_at(tool.max_slope))
    above = float((document.get("base") or {}).get("height", 0.0)) + SHANK_OVER_PROFILE
    return {
        "Diameter": tool.diameter,
        "CuttingEdgeHeight": height,
        "Length": float(document.get("length") or height + above),
        "ShankDiameter": float(document.get("shank_diameter") or tool.diameter),
    }


def properties_of(document: dict[str, Any]) -> dict[str, Any]:
    """The values of `SHAPE_PROPERTIES` for a tool document.

    Raises:
        styluscam.ToolError: the engine refuses it.
    """
    return {PROFILE: json.dumps(document), **lengths_of(document)}


def is_replayed(obj: Any) -> bool:
    """Whether FreeCAD sets the bit's properties back, all of them: nothing follows from one then."""
    return "Restore" in obj.State or bool(obj.Document.Transacting)


def following_lengths(bit: Any) -> dict[str, float]:
    """The lengths (mm) that follow from a bit's edited profile; none, and a sentence in the report view, where it is wrong.

    FreeCAD would print the trace of an error that is raised while a property changes.
    """
    try:
        return derived_lengths(bit.Profile)
    except Exception as error:
        if not (isinstance(error, (ToolError, engine.EngineMissingError)) or hasattr(error, "hint")):
            raise
        import FreeCAD

        FreeCAD.Console.PrintError(f"{bit.Label}: {error}\n")
        return {}


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
    from styluscam.tools.outline import transition
    from styluscam.tools.spans import spans

    shank, top = float(parameters["ShankDiameter"]) / 2.0, float(parameters["Length"])
    found = spans(tool)
    edges, rim = [_edge(span) for span in found], _vector(found[-1].end)
    above = [_vector(point) for point in transition(document.get("base"), found[-1].end, shank)]
    if len(above) > CORNERS:
        edges.append(_upright_curve(above))
        rim, above = above[-1], above[-1:]
    corners = [rim, *above[1:], Vector(shank, 0.0, top), Vector(0.0, 0.0, top), Vector()]
    for a, b in itertools.pairwise(corners):
        if a.distanceToPoint(b) > 1e-7:
            edges.append(Part.makeLine(a, b))
    turned = Part.Face(Part.Wire(edges)).revolve(Vector(), Vector(0.0, 0.0, 1.0), 360.0)
    return turned if math.isfinite(turned.Volume) and turned.Volume > 0.0 else turned.reversed()


ON_AXIS = 1e-9
"""A centre nearer to the axis (mm) makes a sphere."""

CORNERS = 3
"""Points of the longest transition to the shank that has corners; a smooth one has more."""


def _vector(point: Any) -> Any:
    from FreeCAD import Vector

    return Vector(float(point[0]), 0.0, float(point[1]))


def _edge(span: Any) -> Any:
    """A line, an arc about the axis, or a conic as a rational curve of Bezier, exact as well.

    OpenCASCADE's boxes around a part of a torus are too wide; those around a revolved curve are not.
    """
    import Part

    start, end = _vector(span.start), _vector(span.end)
    if span.control is None:
        return Part.makeLine(start, end)
    if span.middle is not None:
        through = start, _vector(span.middle), end
        if abs(Part.Circle(*through).Center.x) < ON_AXIS:
            return Part.Arc(*through).toShape()
    curve = Part.BezierCurve()
    curve.setPoles([start, _vector(span.control), end])
    curve.setWeight(2, span.weight)
    return curve.toShape()


def _upright_curve(points: list[Any]) -> Any:
    """A smooth edge through points, upright at both ends."""
    import Part
    from FreeCAD import Vector

    curve = Part.BSplineCurve()
    curve.interpolate(Points=points, InitialTangent=Vector(0.0, 0.0, 1.0), FinalTangent=Vector(0.0, 0.0, 1.0))
    return curve.toShape()
