# SPDX-License-Identifier: LGPL-2.1-or-later
"""How a stylus appears in the window: its icon, and its panel on a double click."""

from __future__ import annotations

from typing import Any

import FreeCADGui

from .. import compat
from . import messages, tool_panel
from .command import ICONS

ICON = ICONS / "tool.svg"

Base: Any = compat.toolbit_view_class()


class ViewProviderStylusBit(Base):
    """CAM's view provider of tool bits with our icon and our panel."""

    def getIcon(self) -> str:
        """Our icon."""
        return str(ICON)

    def doubleClicked(self, vobj: Any) -> bool:
        """Opens the panel."""
        FreeCADGui.ActiveDocument.setEdit(vobj, 0)
        return True

    def setEdit(self, vobj: Any, mode: int = 0) -> bool:
        """Opens the panel; what keeps it from opening is shown. Other modes move objects, and a bit stands at the origin."""
        if mode != 0:
            return False
        with messages.shown("Stylus tool"):
            tool_panel.open_for(tool_panel.ExistingBit(vobj.Object))
            return True
        return False

    def unsetEdit(self, vobj: Any, mode: int = 0) -> bool:
        """Closes the panel."""
        FreeCADGui.Control.closeDialog()
        return True

    def setCreate(self, vobj: Any) -> None:
        """What CAM calls for a bit that it has just made."""
        self.doubleClicked(vobj)

    def setupContextMenu(self, vobj: Any, menu: Any) -> None:
        """Edit."""
        menu.addAction(messages.translated("Edit")).triggered.connect(lambda: self.doubleClicked(vobj))


def attach(bit: Any) -> None:
    """Gives a bit its view."""
    view = bit.ViewObject
    if not isinstance(view.Proxy, ViewProviderStylusBit):
        ViewProviderStylusBit(view, "ToolBit")
