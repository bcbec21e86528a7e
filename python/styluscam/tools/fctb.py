"""FreeCAD's tool bit files (``.fctb``): our tools in them with exact numbers, and FreeCAD's own bits read as tools.

FreeCAD writes lengths with the decimals that its user chose (3.175 becomes "3.17 mm"). So a stylus carries its whole tool
document as JSON in one property of text, and the lengths that FreeCAD's posts and simulators read stand beside it.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np

from styluscam import _engine
from styluscam.errors import ToolError
from styluscam.tools import toolfile
from styluscam.types import Document

VERSION = 2
"""Of the format, as FreeCAD 1.0 and 1.1 write it."""

EXACT = "Profile"
"""The property of a stylus that holds its document: of the tool, or of the profile alone."""

SHANK_OVER_PROFILE = 40.0
"""Length of the shank over the profile unless it is given, mm."""

UNITS = {
    "": 1.0, "mm": 1.0, "cm": 10.0, "m": 1000.0, "um": 0.001, "µm": 0.001, "μm": 0.001,
    "in": 25.4, '"': 25.4, "ft": 304.8, "'": 304.8, "thou": 0.0254, "mil": 0.0254,
    "°": 1.0, "deg": 1.0, "rad": 180.0 / math.pi,
}  # fmt: skip
"""To mm and degrees."""

NUMBER = re.compile(r"\s*([-+]?[\d.,]+(?:e[-+]?\d+)?)(?:\s+(\d+))?(?:/(\d+))?\s*(\D*?)\s*", re.IGNORECASE)
"""A decimal number, or a fraction such as ``1 1/8``, and a unit."""


def text_of(document: Document, name: str, diameter: float, height: float) -> str:
    """The file's text for the document of a tool file; diameter and height (mm) are the profile's."""
    usual = _usual(document, diameter, height)
    lengths = {
        "Diameter": diameter,
        "CuttingEdgeHeight": height,
        "Length": document.get("length", usual["length"]),
        "ShankDiameter": document.get("shank_diameter", usual["shank_diameter"]),
    }
    parameters = {EXACT: json.dumps(document)} | {name: f"{value!r} mm" for name, value in lengths.items()}
    return toolfile.text_of(
        {
            "version": VERSION,
            "name": name,
            "shape": "stylus.fcstd",
            "shape-type": "Stylus",
            "parameter": parameters,
            "attribute": {},
        }
    )


def read(path: str | Path) -> tuple[Document, list[str]]:
    """The tool document of a file, and what had to be guessed, in sentences.

    Raises:
        ToolError: it is no tool bit, or of a shape that no profile describes.
    """
    bit = toolfile.read_json(path, "a tool bit of FreeCAD")
    where = str(path)
    values: Document = {}
    for key in ("parameter", "attribute"):
        part = bit.get(key, {})
        if not isinstance(part, dict):
            raise ToolError(f"{where}: not a tool bit of FreeCAD: {key} is no object", code="unreadable", where=where)
        values |= part
    document, remarks = _stylus(values, where) if EXACT in values else _native(bit, values, where)
    title = " ".join(str(bit.get("name", "")).split())
    name = toolfile.file_name(Path(path).stem)
    return {"name": name} | ({"title": title} if title else {}) | document, remarks


def document_of(exact: str, where: str) -> Document:
    """The tool document in the text of a stylus' property: of the whole tool, or of its profile alone."""
    try:
        parsed = toolfile.parsed(exact)
    except (ValueError, RecursionError) as error:
        raise ToolError(f"{where}: its {EXACT} is not JSON: {error}", code="unreadable", where=where) from error
    if not isinstance(parsed, dict):
        raise ToolError(f"{where}: its {EXACT} is no JSON object", code="unreadable", where=where)
    if EXACT.lower() not in parsed:
        return {EXACT.lower(): parsed}
    toolfile.check_schema(parsed, where)
    return parsed


def _usual(document: Document, diameter: float, height: float) -> dict[str, float]:
    """What FreeCAD gets for a tool that leaves these open (mm)."""
    base = document.get("base")
    above = base.get("height", 0.0) if isinstance(base, dict) else 0.0
    raised = height + (float(above) if _is_number(above) else 0.0)
    return {"length": raised + SHANK_OVER_PROFILE, "shank_diameter": diameter}


def _size(document: Document) -> tuple[float, float] | None:
    """Diameter and height (mm) of the profile; None where it does not build, which others report."""
    try:
        tool = _engine.Tool(json.dumps({"profile": document["profile"]}))
    except (ToolError, KeyError, TypeError, ValueError):
        return None
    return tool.diameter, float(tool.height_at(np.array([tool.max_slope]))[0])


def _stylus(values: Document, where: str) -> tuple[Document, list[str]]:
    """The exact document; a length that was changed in FreeCAD since counts."""
    document, remarks = document_of(str(values[EXACT]), where), []
    size = _size(document)
    usual = {} if size is None else _usual(document, *size)
    if size is not None and "Diameter" in values and not _shows(values["Diameter"], size[0]):
        shown = number(values["Diameter"], f"{where}: Diameter")
        remarks.append(f"Diameter was changed in FreeCAD to {shown:g} mm: the profile of {size[0]:g} mm counts")
    for key, name in (("length", "Length"), ("shank_diameter", "ShankDiameter")):
        shown = number(values[name], f"{where}: {name}") if name in values else 0.0
        exact = document.get(key, usual.get(key))
        if shown <= 0.0 or (key in document and not _is_number(exact)):
            continue
        if _is_number(exact) and _shows(values[name], float(exact or 0.0)):
            continue
        if key in document:
            remarks.append(f"{name} was changed in FreeCAD from {exact:g} to {shown:g} mm")
        document[key] = shown
    return document, remarks


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _shows(text: object, exact: float) -> bool:
    """Whether FreeCAD's text stands for an exact length (mm): it is that length with as many decimals as it has."""
    found = NUMBER.fullmatch(str(text))
    if found is None or found[3]:
        return number(text, "") == exact
    step = UNITS[found[4].lower()] * 10.0 ** -len(re.split("[.,]", found[1] + ".")[1])
    return abs(number(text, "") - exact) <= 0.5 * step * (1.0 + 1e-6)


def _native(bit: Document, values: Document, where: str) -> tuple[Document, list[str]]:
    shape = Path(str(bit.get("shape", ""))).stem.lower().replace("-", "")
    kind = str(bit.get("shape-type") or shape).lower().replace("-", "")
    reader = NATIVE.get(kind) or NATIVE.get(shape)
    if reader is None:
        hint = f"known: stylus, {', '.join(NATIVE)}"
        message = f"{where}: no profile is known for a bit of shape {kind or 'unknown'!r}"
        raise ToolError(message, code="unknown-kind", where=where, hint=hint)

    def measure(name: str) -> float:
        if name not in values:
            raise ToolError(f"{where}: a bit of shape {kind} without {name}", code="document", where=where)
        return number(values[name], f"{where}: {name}")

    profile, remark = reader(measure)
    document: Document = {"profile": profile}
    for key, name in (("length", "Length"), ("shank_diameter", "ShankDiameter")):
        if name in values and measure(name) > 0.0:
            document[key] = measure(name)
    if "CuttingEdgeHeight" in values:
        document |= _base(document, measure("CuttingEdgeHeight"))
    return document, [remark, "lengths are as FreeCAD rounded them when it wrote the file"]


def _base(document: Document, edge: float) -> Document:
    """The cylinder from the profile to the end of the cutting edge (mm), below a shank of another diameter."""
    size = _size(document)
    if size is None or document.get("shank_diameter", size[0]) == size[0]:
        return {}
    height = round(edge - size[1], 9)
    return {"base": {"kind": "cylindrical", "height": height}} if height > 0.0 else {}


def number(value: object, where: str) -> float:
    """A length in mm or an angle in degrees from FreeCAD's text: ``5.0000 mm``, ``1/8"``, ``45 °``, or a number."""
    if isinstance(value, int | float) and not isinstance(value, bool):
        return float(value)
    found = NUMBER.fullmatch(str(value))
    unit = found[4].lower() if found else ""
    if found is None or unit not in UNITS:
        raise ToolError(f"{where} = {value!r}: not a length or an angle", code="document", where=where)
    try:
        size = _decimal(found[1])
        if found[3]:
            size = (size + float(found[2]) / float(found[3])) if found[2] else size / float(found[3])
    except (ValueError, ZeroDivisionError) as error:
        raise ToolError(f"{where} = {value!r}: not a number", code="document", where=where) from error
    return size * UNITS[unit]


def _decimal(text: str) -> float:
    """A comma alone is a decimal point; of commas and points, the last one is, and the others group digits."""
    if "." in text and "," in text and text.rfind(",") > text.rfind("."):
        return float(text.replace(".", "").replace(",", "."))
    return float(text.replace(",", "") if "." in text else text.replace(",", "."))


Measure = Callable[[str], float]


def _ball(measure: Measure) -> tuple[Document, str]:
    return {"kind": "ball", "diameter": measure("Diameter")}, "a ball end mill, read as a ball"


def _flat(measure: Measure) -> tuple[Document, str]:
    return {"kind": "flat", "diameter": measure("Diameter")}, "an end mill, read as a flat end with sharp corners"


def _bull_nose(measure: Measure) -> tuple[Document, str]:
    profile = {"kind": "bull-nose", "diameter": measure("Diameter"), "corner_radius": measure("CornerRadius")}
    return profile, "read as a bull nose"


def _v(measure: Measure) -> tuple[Document, str]:
    profile = {
        "kind": "v",
        "tip_diameter": measure("TipDiameter"),
        "angle_deg": measure("CuttingEdgeAngle"),
        "diameter": measure("Diameter"),
    }
    return profile, "read as a V, its cutting edge angle as the included one"


def _tapered_ball(measure: Measure) -> tuple[Document, str]:
    profile = {
        "kind": "tapered-ball",
        "tip_radius": measure("Diameter") / 2.0,
        "half_angle_deg": measure("TaperAngle") / 2.0,
        "diameter": measure("TaperDiameter"),
    }
    return profile, "read as a tapered ball, its taper angle as the included one"


def _drill(measure: Measure) -> tuple[Document, str]:
    profile = {
        "kind": "v", "tip_diameter": 0.0, "angle_deg": measure("TipAngle"), "diameter": measure("Diameter"),
    }  # fmt: skip
    return profile, "a drill, read as a V with its tip angle"


NATIVE: dict[str, Callable[[Measure], tuple[Document, str]]] = {
    "ballend": _ball,
    "endmill": _flat,
    "bullnose": _bull_nose,
    "torus": _bull_nose,
    "vbit": _v,
    "chamfer": _v,
    "taperedballnose": _tapered_ball,
    "drill": _drill,
}
"""Readers of FreeCAD's own shapes: the nearest profile, and what was taken for granted."""
