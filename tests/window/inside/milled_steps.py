"""Steps that scenarios of milled parts share."""

from __future__ import annotations

from typing import Any

import driver
import stage
from driver import QtWidgets, until


def pressed(command: str) -> Any:
    """Presses a button of ours as soon as it can be pressed."""
    yield until(lambda: driver.tool_button(f"StylusCAM_{command}").isEnabled(), f"{command} enabled")
    driver.click(driver.tool_button(f"StylusCAM_{command}"))


def scroll_to(widget: Any) -> None:
    """Brings a widget of a panel into view."""
    parent = widget.parentWidget()
    while parent is not None:
        if isinstance(parent, QtWidgets.QScrollArea):
            parent.ensureWidgetVisible(widget)
        parent = parent.parentWidget()


def rows() -> dict[str, list[str]]:
    """Labels of the form's rows that are seen, and their tool tips."""
    labels = driver.visible(QtWidgets.QLabel)
    return {
        label.objectName().removesuffix("_label"): [label.text(), label.toolTip()]
        for label in labels
        if label.objectName().endswith("_label")
    }


def computed(operation: Any) -> bool:
    return "Touched" not in operation.State and "Invalid" not in operation.State and stage.motions(operation) > 0
