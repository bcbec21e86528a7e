"""Seeded faults of a job's input: the part or the document is spoilt as people spoil it, and the program follows it.

A function takes mesh and document (a copy) and gives the spoilt ones, or nothing where the job has no such thing.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

Mesh: TypeAlias = tuple[NDArray[np.float64], NDArray[np.int64]]
Document: TypeAlias = dict[str, Any]
Spoil: TypeAlias = Callable[[Mesh, Document], "tuple[Mesh, Document] | None"]

FAULTS: dict[str, Spoil] = {}
"""Every fault of the input by its name."""


def fault(function: Spoil) -> Spoil:
    """Registers a fault under its function's name."""
    FAULTS[function.__name__.replace("_", " ")] = function
    return function


def _moved(mesh: Mesh, matrix: NDArray[np.float64]) -> Mesh:
    return mesh[0] @ matrix.T, mesh[1]


def _only_raised(document: Document) -> bool:
    """By the sine law a sheet's faces are one above the other, and a zero point on top of it goes along."""
    setup = document["setup"]
    return setup["sheet"].get("law") == "sine" and not isinstance(setup.get("zero"), list)


@fault
def sheet_side_flipped(mesh: Mesh, document: Document) -> tuple[Mesh, Document] | None:
    face = document["part"].get("model_face")
    if face not in ("tool", "back") or _only_raised(document):
        return None
    document["part"]["model_face"] = "tool" if face == "back" else "back"
    return mesh, document


@fault
def sheet_middle_for_back(mesh: Mesh, document: Document) -> tuple[Mesh, Document] | None:
    if document["part"].get("model_face") != "back" or _only_raised(document):
        return None
    document["part"]["model_face"] = "mid"
    return mesh, document


@fault
def sheet_thickness(mesh: Mesh, document: Document) -> tuple[Mesh, Document] | None:
    """The next sheet of the rack: 0.2 mm thicker."""
    if document["part"].get("model_face") in (None, "tool"):
        return None
    document["setup"]["sheet"]["thickness"] += 0.2
    return mesh, document


@fault
def sheet_law(mesh: Mesh, document: Document) -> tuple[Mesh, Document] | None:
    if document["part"].get("model_face") in (None, "tool"):
        return None
    sheet = document["setup"]["sheet"]
    sheet["law"] = "constant" if sheet.get("law") == "sine" else "sine"
    return mesh, document


@fault
def inches_for_millimetres(mesh: Mesh, document: Document) -> tuple[Mesh, Document] | None:
    """A part in millimetres is read as one in inches."""
    return _moved(mesh, 25.4 * np.eye(3)), _coarser(document, 25.4)


@fault
def millimetres_for_inches(mesh: Mesh, document: Document) -> tuple[Mesh, Document] | None:
    """A part in inches is read as one in millimetres."""
    return _moved(mesh, np.eye(3) / 25.4), _coarser(document, 1 / 25.4)


def _coarser(document: Document, factor: float) -> Document:
    """The same number of levels and rows."""
    for operation in document["operations"]:
        if "step" in operation:
            operation["step"] = {"height": operation["step"]["height"] * factor}
        if "stepover" in operation:
            operation["stepover"] *= factor
    return document


@fault
def turned_twice(mesh: Mesh, document: Document) -> tuple[Mesh, Document] | None:
    turn = math.radians(document["setup"].get("rotation", 0.0))
    if turn == 0.0:
        return None
    return _moved(
        mesh, np.array([[math.cos(turn), -math.sin(turn), 0], [math.sin(turn), math.cos(turn), 0], [0, 0, 1]])
    ), document


@fault
def turned_by_a_right_angle(mesh: Mesh, document: Document) -> tuple[Mesh, Document] | None:
    document["setup"]["rotation"] = document["setup"].get("rotation", 0.0) + 90.0
    return mesh, document


@fault
def mirrored(mesh: Mesh, document: Document) -> tuple[Mesh, Document] | None:
    """The left part for the right one."""
    vertices, triangles = _moved(mesh, np.diag([-1.0, 1.0, 1.0]))
    return (vertices, triangles[:, ::-1]), document


@fault
def die_for_part(mesh: Mesh, document: Document) -> tuple[Mesh, Document] | None:
    """Pits where bumps are."""
    return _moved(mesh, np.diag([1.0, 1.0, -1.0])), document


@fault
def tip_for_centre(mesh: Mesh, document: Document) -> tuple[Mesh, Document] | None:
    tool = document["tools"]["tool"]
    if tool["profile"]["kind"] != "ball" or "tip_flat" in tool["profile"]:
        return None
    tool["reference"] = "tip" if tool.get("reference") == "center" else "center"
    return mesh, document


@fault
def another_profile(mesh: Mesh, document: Document) -> tuple[Mesh, Document] | None:
    tool = document["tools"]["tool"]
    if tool.get("reference") == "center":
        return None
    kind = "clothoid" if tool["profile"]["kind"] != "clothoid" else "ball"
    tool["profile"] = {"kind": kind, "diameter": tool["profile"]["diameter"]}
    return mesh, document


@fault
def another_diameter(mesh: Mesh, document: Document) -> tuple[Mesh, Document] | None:
    """The next tool of the drawer: 0.2 mm wider."""
    document["tools"]["tool"]["profile"]["diameter"] += 0.2
    return mesh, document


@fault
def tip_flat_forgotten(mesh: Mesh, document: Document) -> tuple[Mesh, Document] | None:
    profile = document["tools"]["tool"]["profile"]
    return (mesh, document) if profile.pop("tip_flat", None) else None


@fault
def wrong_tool_number(mesh: Mesh, document: Document) -> tuple[Mesh, Document] | None:
    for tool in document["tools"].values():
        tool["number"] += 10
    return mesh, document


@fault
def wrong_face(mesh: Mesh, document: Document) -> tuple[Mesh, Document] | None:
    """Half of the faces is chosen; their triangles are the faces of the job that is planned."""
    vertices, triangles = mesh
    middle = vertices[triangles].mean(axis=1)
    kept = triangles[middle[:, 0] >= np.median(middle[:, 0])]
    return (vertices, kept), document


@fault
def old_revision(mesh: Mesh, document: Document) -> tuple[Mesh, Document] | None:
    """The part before its last change: a corner stood 0.1 mm lower."""
    vertices = mesh[0].copy()
    vertices[len(vertices) // 2, 2] -= 0.1
    return (vertices, mesh[1]), document


@fault
def zero_at_another_place(mesh: Mesh, document: Document) -> tuple[Mesh, Document] | None:
    zero = document["setup"].get("zero")
    if not isinstance(zero, list):
        return None
    document["setup"]["zero"] = [zero[0] + 0.1, zero[1], zero[2]]
    return mesh, document


@fault
def zero_on_the_model(mesh: Mesh, document: Document) -> tuple[Mesh, Document] | None:
    """The model's origin for the sheet's top, or the reverse."""
    if isinstance(document["setup"].get("zero"), list):
        document["setup"].pop("zero")
    elif "sheet" in document["setup"]:
        document["setup"]["zero"] = "model"
    else:
        document["setup"]["zero"] = [0.0, 0.0, float(mesh[0][:, 2].max())]
    return mesh, document


@fault
def stops_too_high(mesh: Mesh, document: Document) -> tuple[Mesh, Document] | None:
    """z_bottom in the middle of the part."""
    if document["setup"].get("zero") is not None or "sheet" in document["setup"]:
        return None
    document["operations"][0]["z_bottom"] = float(0.5 * (mesh[0][:, 2].min() + mesh[0][:, 2].max()))
    return mesh, document


@fault
def begins_too_low(mesh: Mesh, document: Document) -> tuple[Mesh, Document] | None:
    """z_top below the first levels."""
    if document["setup"].get("zero") is not None or "sheet" in document["setup"]:
        return None
    document["operations"][0]["z_top"] = float(0.4 * mesh[0][:, 2].min() + 0.6 * mesh[0][:, 2].max())
    return mesh, document


@fault
def steps_too_coarse(mesh: Mesh, document: Document) -> tuple[Mesh, Document] | None:
    """Twice the step or the stepover."""
    return mesh, _coarser(document, 2.0)


@fault
def stock_left(mesh: Mesh, document: Document) -> tuple[Mesh, Document] | None:
    """The roughing tolerance for the finishing one."""
    for operation in document["operations"]:
        operation["tolerance"] = 0.1
    return mesh, document


@fault
def clearance_too_low(mesh: Mesh, document: Document) -> tuple[Mesh, Document] | None:
    document["setup"]["clearance"] = 2.0
    return mesh, document


@fault
def wrong_work_offset(mesh: Mesh, document: Document) -> tuple[Mesh, Document] | None:
    document["setup"]["wcs"] = "G58"
    return mesh, document


@fault
def wrong_feeds(mesh: Mesh, document: Document) -> tuple[Mesh, Document] | None:
    for operation in document["operations"]:
        operation["feeds"] = {"cut": 6000.0, "plunge": 3000.0}
    return mesh, document


@fault
def spindle_off(mesh: Mesh, document: Document) -> tuple[Mesh, Document] | None:
    turned = [operation for operation in document["operations"] if operation.get("spindle", {}).get("mode") == "fixed"]
    for operation in turned:
        operation["spindle"] = {"mode": "off"}
    return (mesh, document) if turned else None
