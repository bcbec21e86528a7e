# SPDX-License-Identifier: LGPL-2.1-or-later
"""The stylus as shape and tool bit classes of FreeCAD 1.1's tool assets; importing this registers them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import FreeCAD
from Path.Tool.shape import ToolBitShape
from Path.Tool.toolbit import ToolBit
from Path.Tool.toolbit.mixins import RotaryToolBitMixin

from . import post_list, stylus, views

post_list.register()


class ToolBitShapeStylus(ToolBitShape):
    """The shape: parameters, and the solid made from them. FreeCAD finds direct subclasses only."""

    name: str = "Stylus"
    aliases = ("stylus",)

    @classmethod
    def schema(cls) -> Mapping[str, tuple[str, str]]:
        """Description and property type of each parameter."""
        return {name: (text, kind) for name, (kind, text) in stylus.SHAPE_PROPERTIES.items()}

    @property
    def label(self) -> str:
        """The name that users see."""
        return "Stylus"

    def make_body(self, doc: Any) -> Any:
        """An object that holds the solid; a group of its own, as FreeCAD expects to take it apart again."""
        body = doc.addObject("Part::FeaturePython", "StylusBody")
        body.addExtension("App::GroupExtensionPython")
        values = {name: getattr(value, "Value", value) for name, value in self.get_parameters().items()}
        body.Shape = stylus.solid_of(values)
        body.purgeTouched()
        return body


class ToolBitStylus(ToolBit, RotaryToolBitMixin):
    """The tool bit."""

    SHAPE_CLASS = ToolBitShapeStylus

    @property
    def summary(self) -> str:
        """What it is, in a line."""
        return f"{self.get_property_str('Diameter', '?', precision=3)} stylus"

    def can_rotate(self) -> bool:
        """A stylus slides: the spindle stays off."""
        return False

    def attach_to_obj(self, tool_doc_obj: Any, label: str | None = None) -> None:
        """Makes an object of a document the bit, and shows it."""
        super().attach_to_obj(tool_doc_obj, label)
        views.attach(tool_doc_obj, views.BIT)

    def onDocumentRestored(self, obj: Any) -> None:
        """Puts the bit and its view in working order after loading."""
        super().onDocumentRestored(obj)
        views.attach(obj, views.BIT)

    def change(self, obj: Any, parameters: dict[str, Any]) -> None:
        """Sets properties (of `stylus.SHAPE_PROPERTIES`, lengths in mm) together, and the solid once."""
        self._suppress_visual_update = True
        try:
            for name, value in quantities(parameters).items():
                setattr(obj, name, value)
                self._tool_bit_shape.set_parameter(name, value)
        finally:
            self._suppress_visual_update = False
        self._update_visual_representation()

    def onChanged(self, obj: Any, prop: str) -> None:
        """The lengths that follow from the profile follow it."""
        if stylus.is_replayed(obj):
            return
        updating = getattr(self, "_suppress_visual_update", False) or getattr(self, "_in_update", False)
        if prop == stylus.PROFILE and not updating:
            lengths = stylus.following_lengths(obj)
            if not lengths:
                return
            for name, value in quantities(lengths).items():
                setattr(obj, name, value)
        super().onChanged(obj, prop)

    def _update_visual_representation(self) -> None:
        """The solid is the bit's own: a body beside it, as FreeCAD's shapes have one, is not needed."""
        if not hasattr(self.obj, "Document"):
            return  # not in a document yet
        self._removeBitBody()
        values = {name: getattr(self.obj, name) for name in stylus.SHAPE_PROPERTIES}
        self.obj.Shape = stylus.solid_of({name: getattr(value, "Value", value) for name, value in values.items()})
        self.obj.purgeTouched()

    def _update_tool_properties(self) -> None:
        """What follows from the profile is not typed beside it; neither is the profile."""
        super()._update_tool_properties()
        for name in stylus.FOLLOWING:
            self.obj.setEditorMode(name, 1)


def quantities(parameters: dict[str, Any]) -> dict[str, Any]:
    """Lengths (mm) as FreeCAD's quantities; the profile stays a text."""
    length = FreeCAD.Units.Length
    return {
        name: FreeCAD.Units.Quantity(value, length) if name != stylus.PROFILE else value
        for name, value in parameters.items()
    }


def create(document: Any, label: str, parameters: dict[str, Any]) -> Any:
    """A stylus in the document."""
    return ToolBitStylus(ToolBitShapeStylus("stylus", **quantities(parameters))).attach_to_doc(document, label)
