# SPDX-License-Identifier: LGPL-2.1-or-later
"""Start-up with a window: workbench, preferences, our commands inside CAM's own bars. Heavy modules are imported later."""

from __future__ import annotations

from typing import Any

import FreeCADGui

from . import views
from .gui import manipulator, messages, preferences, workbench


def _attach_view(obj: Any) -> None:
    from .gui import operation_view

    operation_view.attach(obj)


def _attach_view_of_bit(bit: Any) -> None:
    from .gui import tool_view

    tool_view.attach(bit)


views.attach_with(_attach_view)
views.attach_with(_attach_view_of_bit, views.BIT)
messages.load_translations()
FreeCADGui.addWorkbench(workbench.StylusCamWorkbench)
FreeCADGui.addWorkbenchManipulator(manipulator.CamManipulator())
preferences.register()
