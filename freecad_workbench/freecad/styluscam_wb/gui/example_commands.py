# SPDX-License-Identifier: LGPL-2.1-or-later
"""Commands that open an example in a document of its own."""

from __future__ import annotations

import FreeCAD

from .. import examples
from . import camera
from .command import Command
from .messages import translated


class OpenExample(Command):
    """Makes an example's document, computes it and shows all of it."""

    icon = "examples"

    def __init__(self, example: examples.Example) -> None:
        self._example = example
        self.name = f"Example_{example.name}"
        self.menu_text = example.title
        self.tool_tip = example.tool_tip

    def GetResources(self) -> dict[str, str]:
        """Icon and words; the menu names it an example."""
        found = super().GetResources()
        return {**found, "MenuText": f"{translated('Example')}: {found['MenuText']}"}

    def IsActive(self) -> bool:
        """Always."""
        return True

    def run(self) -> None:
        """Opens it."""
        import FreeCADGui

        job = self._example.make()
        FreeCAD.ActiveDocument.recompute()
        camera.show_all(isometric=True)
        FreeCADGui.Selection.clearSelection()
        FreeCADGui.Selection.addSelection(job)


def commands() -> list[Command]:
    """One for each example."""
    return [OpenExample(example) for example in examples.EXAMPLES]
