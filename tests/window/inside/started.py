"""What a person sees after the start."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parent))

import driver
from driver import until


def start() -> Any:
    """The window with CAM in front."""
    import FreeCADGui

    yield until(lambda: FreeCADGui.activeWorkbench().name() == "CAMWorkbench", "CAM in front")
    yield driver.settled()
    return {"shot": driver.shot("start"), "bars": [b.windowTitle() for b in driver.visible(driver.QtWidgets.QToolBar)]}


driver.run({"start": start})
