# SPDX-License-Identifier: LGPL-2.1-or-later
"""The stylus as shape and tool bit classes of FreeCAD 1.1's tool assets; importing this registers them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import FreeCAD
from Path.Tool.shape import ToolBitShape
from Path.Tool.toolbit import ToolBit
from Path.Tool.toolbit.mixins import RotaryToolBitMixin

from . import post_list, stylus

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

    def onChanged(self, obj: Any, prop: str) -> None:
        """The lengths that follow from the profile follow it."""
        updating = getattr(self, "_suppress_visual_update", False) or getattr(self, "_in_update", False)
        if prop == stylus.PROFILE and not updating and "Restore" not in obj.State:
            for name, value in stylus.derived_lengths(obj.Profile).items():
                setattr(obj, name, FreeCAD.Units.Quantity(value, FreeCAD.Units.Length))
        super().onChanged(obj, prop)


def create(document: Any, label: str, parameters: dict[str, Any]) -> Any:
    """A stylus in the document."""
    lengths = {
        name: FreeCAD.Units.Quantity(value, FreeCAD.Units.Length) if name != stylus.PROFILE else value
        for name, value in parameters.items()
    }
    return ToolBitStylus(ToolBitShapeStylus("stylus", **lengths)).attach_to_doc(document, label)
