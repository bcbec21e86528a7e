# SPDX-License-Identifier: LGPL-2.1-or-later
"""The stylus as a tool bit of FreeCAD 1.0: its own class of bits, with the solid made here and not by a shape file."""

from __future__ import annotations

from pathlib import Path as FilePath
from typing import Any

import FreeCAD
from Path.Tool.Bit import ToolBit, ToolBitFactory

from . import post_list, stylus, views

post_list.register()


class StylusBit(ToolBit):
    """A bit whose properties are set up here; a shape file is neither looked for nor needed."""

    __module__ = f"{__package__}.stylus_bit"  # documents hold this name, and every version of FreeCAD finds it

    _is_quiet = False
    """Whether properties are being set together."""

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
        views.attach(obj, views.BIT)

    def onDocumentRestored(self, obj: Any) -> None:
        """Puts the bit and its view in working order after loading."""
        super().onDocumentRestored(obj)
        for name in stylus.SHAPE_PROPERTIES:
            obj.setEditorMode(name, 1 if name in stylus.FOLLOWING else 0)
        views.attach(obj, views.BIT)

    def change(self, obj: Any, parameters: dict[str, Any]) -> None:
        """Sets properties (of `stylus.SHAPE_PROPERTIES`, lengths in mm) together, and the solid once."""
        self._is_quiet = True
        try:
            for name, value in parameters.items():
                setattr(obj, name, value)
        finally:
            self._is_quiet = False
        self._updateBitShape(obj)

    def loadBitBody(self, obj: Any, force: bool = False) -> None:
        """There is no body beside the bit."""

    def onChanged(self, obj: Any, prop: str) -> None:
        """The lengths that follow from the profile follow it, and the solid all of them."""
        if self._is_quiet or stylus.is_replayed(obj) or prop not in stylus.SHAPE_PROPERTIES:
            return
        if not all(getattr(obj, name, None) for name in stylus.SHAPE_PROPERTIES):
            if prop == stylus.PROFILE and obj.Profile and hasattr(obj, "ShankDiameter"):
                self._set_following(obj)
            return
        if prop != stylus.PROFILE or self._set_following(obj):
            self._updateBitShape(obj)

    def _set_following(self, obj: Any) -> bool:
        """Whether the profile is one, and its lengths are set."""
        lengths = stylus.following_lengths(obj)
        self._is_quiet = True
        try:
            for name, value in lengths.items():
                setattr(obj, name, value)
        finally:
            self._is_quiet = False
        return bool(lengths)


def create(document: Any, label: str, parameters: dict[str, Any]) -> Any:
    """A stylus in the document."""
    obj = document.addObject("Part::FeaturePython", label)
    obj.Proxy = StylusBit(obj, "stylus.fcstd")
    obj.Proxy.change(obj, parameters)
    obj.Label = label
    return obj


def register() -> None:
    """FreeCAD's factories of bits, with and without a window, make ours where a file names the shape `stylus`."""
    theirs = ToolBitFactory.Create
    if getattr(theirs, "styluscam", False):
        return

    def create_any(factory: Any, name: str = "ToolBit", shapeFile: Any = None, path: Any = None) -> Any:
        if FilePath(str(shapeFile)).stem.lower() != "stylus":
            return theirs(factory, name, shapeFile, path)
        obj = FreeCAD.ActiveDocument.addObject("Part::FeaturePython", name)
        obj.Proxy = StylusBit(obj, "stylus.fcstd", path)
        return obj

    create_any.styluscam = True  # type: ignore[attr-defined]
    ToolBitFactory.Create = create_any
