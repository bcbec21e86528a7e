# SPDX-License-Identifier: LGPL-2.1-or-later
"""The stylus as a tool bit of FreeCAD 1.0: its own class of bits, with the solid made here and not by a shape file."""

from __future__ import annotations

from pathlib import Path as FilePath
from typing import Any

import FreeCAD
from Path.Tool.Bit import Factory, ToolBit

from . import post_list, stylus

post_list.register()


class StylusBit(ToolBit):
    """A bit whose properties are set up here; a shape file is neither looked for nor needed."""

    __module__ = f"{__package__}.stylus_bit"  # documents hold this name, and every version of FreeCAD finds it

    def _setupBitShape(self, obj: Any, path: Any = None) -> None:
        for name, (kind, text) in stylus.SHAPE_PROPERTIES.items():
            if not hasattr(obj, name):
                obj.addProperty(kind, name, "Shape", text)
        if not hasattr(obj, "SpindlePower"):
            obj.addProperty("App::PropertyBool", "SpindlePower", "Attributes", "A stylus slides: the spindle stays off")
            obj.SpindlePower = False
        obj.ShapeName = "stylus"
        obj.BitPropertyNames = [*stylus.SHAPE_PROPERTIES, "SpindlePower"]

    def _updateBitShape(self, obj: Any, properties: Any = None) -> None:
        values = {name: getattr(obj, name) for name in stylus.SHAPE_PROPERTIES}
        obj.Shape = stylus.solid_of({name: getattr(value, "Value", value) for name, value in values.items()})

    def loadBitBody(self, obj: Any, force: bool = False) -> None:
        """There is no body beside the bit."""

    def onChanged(self, obj: Any, prop: str) -> None:
        """The lengths that follow from the profile follow it, and the solid all of them."""
        if "Restore" in obj.State or prop not in getattr(obj, "BitPropertyNames", ()) or prop == "SpindlePower":
            return
        if prop == stylus.PROFILE:
            for name, value in stylus.derived_lengths(obj.Profile).items():
                setattr(obj, name, value)
        if all(getattr(obj, name) for name in stylus.SHAPE_PROPERTIES):
            self._updateBitShape(obj)


def create(document: Any, label: str, parameters: dict[str, Any]) -> Any:
    """A stylus in the document."""
    obj = document.addObject("Part::FeaturePython", label)
    proxy = StylusBit(obj, "stylus.fcstd")
    for name, value in parameters.items():
        setattr(obj, name, value)
    obj.Proxy = proxy
    proxy._updateBitShape(obj)
    obj.Label = label
    return obj


def register() -> None:
    """FreeCAD's factory of bits makes ours where a file names the shape `stylus`."""
    theirs = Factory.Create
    if getattr(theirs, "styluscam", False):
        return

    def create_any(name: str = "ToolBit", shapeFile: Any = None, path: Any = None) -> Any:
        if FilePath(str(shapeFile)).stem.lower() != "stylus":
            return theirs(name, shapeFile, path)
        obj = FreeCAD.ActiveDocument.addObject("Part::FeaturePython", name)
        obj.Proxy = StylusBit(obj, "stylus.fcstd", path)
        return obj

    create_any.styluscam = True  # type: ignore[attr-defined]
    Factory.Create = create_any
