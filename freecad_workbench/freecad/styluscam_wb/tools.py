# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool bits, ours and FreeCAD's own: made, written to files, and as the engine's tool documents."""

from __future__ import annotations

import json
from typing import Any

from . import compat, engine
from .stylus import PROFILE, ToolError, derived_lengths, exact_document, lengths_of, profile_kinds, properties_of

ROUNDED = 0.01
"""Tool files hold lengths with the user's decimals: more than this (mm) is another tool."""


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
    stated = {"length": length, "shank_diameter": shank_diameter}
    lengths = lengths_of({"profile": profile, **{key: value for key, value in stated.items() if value is not None}})
    return compat.make_toolbit(document, label, {PROFILE: json.dumps(profile), **lengths})


def is_supported(bit: Any) -> bool:
    """Whether there is a profile for a bit: a stylus, or a shape of FreeCAD's that the engine knows."""
    return hasattr(bit, PROFILE) or _kind(bit) in _native()


def _kind(bit: Any) -> str:
    return compat.tool_kind(bit).replace("-", "")


def _native() -> Any:
    """Readers of FreeCAD's own shapes, by the shape's name."""
    engine.styluscam()
    from styluscam.tools.fctb import NATIVE

    return NATIVE


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
    known = _native()
    reader = known.get(_kind(bit))
    profile = reader(lambda name: _millimetres(bit, name))[0] if reader else {"kind": ""}
    if profile["kind"] not in profile_kinds():
        raise ToolError(
            f"tool {bit.Label}: no profile is known for a bit of shape {compat.tool_kind(bit) or 'unknown'!r}: "
            f"choose a stylus or {', '.join(known)}"
        )
    return profile


def write_toolbit(bit: Any, path: str) -> None:
    """Writes a stylus, or a bit that there is a profile for, as FreeCAD's `.fctb` with exact numbers.

    Raises:
        ToolError, styluscam.StylusError: there is no profile for it, or the file cannot be written.
    """
    tool = engine.styluscam().Tool.from_dict({"title": bit.Label, **tool_document(bit)})
    tool.write(path)


def read_tool_file(document: Any, path: str) -> Any:
    """The tool of a file in the document: a tool bit of FreeCAD (`.fctb`), or a tool file of StylusCAM's (`.json`).

    Raises:
        ToolError, styluscam.ToolError: it is none.
    """
    tool = engine.styluscam().Tool.read(path)
    if not path.lower().endswith(".json"):
        return compat.load_toolbit(document, path)
    return compat.make_toolbit(document, tool.title or tool.name or "Stylus", properties_of(tool.to_dict()))


def _millimetres(bit: Any, name: str) -> float:
    value = getattr(bit, name, 0.0)
    return float(getattr(value, "Value", value))
