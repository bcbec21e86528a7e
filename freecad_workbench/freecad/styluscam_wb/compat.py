# SPDX-License-Identifier: LGPL-2.1-or-later
"""Every difference between FreeCAD's versions; no other module tests for a version."""

from __future__ import annotations

import importlib.util
from typing import Any

import FreeCAD


def make_toolbit(document: Any, label: str, parameters: dict[str, Any]) -> Any:
    """A stylus tool bit in the document; `parameters` are the properties of `stylus.SHAPE_PROPERTIES`.

    FreeCAD 1.1 has classes for shapes and bits; 1.0 has one class of bits over shape files.
    """
    if _has_tool_assets():
        from .stylus_asset import create
    else:
        from .stylus_bit_of_1_0 import create
    return create(document, label, parameters)


def toolbit_class() -> Any:
    """The class of a stylus tool bit."""
    if _has_tool_assets():
        from .stylus_asset import ToolBitStylus

        return ToolBitStylus
    from .stylus_bit_of_1_0 import StylusBit

    return StylusBit


def register_toolbits() -> None:
    """Makes FreeCAD know the stylus among its tool bits, so that its own readers of files build ours."""
    if _has_tool_assets():
        from . import stylus_asset  # noqa: F401  (its classes are found once they exist)
    else:
        from . import stylus_bit_of_1_0

        stylus_bit_of_1_0.register()


def load_toolbit(document: Any, path: str) -> Any:
    """The tool bit of a file (`.fctb`) in the document: a stylus, or one of FreeCAD's own."""
    register_toolbits()
    if _has_tool_assets():
        from Path.Tool.toolbit import ToolBit

        return ToolBit.from_file(path).attach_to_doc(document)
    from Path.Tool.Bit import Factory

    FreeCAD.setActiveDocument(document.Name)
    return Factory.CreateFrom(path)


def tool_kind(bit: Any) -> str:
    """The shape of a tool bit in lower case: `stylus`, or FreeCAD's own: `ballend`, `endmill`."""
    for name in ("ShapeType", "ShapeName"):  # 1.1, 1.0
        kind = getattr(bit, name, "")
        if kind:
            return str(kind).lower()
    return ""


def _has_tool_assets() -> bool:
    """Whether tools are assets, as from FreeCAD 1.1 on."""
    return importlib.util.find_spec("Path.Tool.toolbit") is not None
