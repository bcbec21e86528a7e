# SPDX-License-Identifier: LGPL-2.1-or-later
"""Documents that were saved where the addon was missing: FreeCAD keeps a tool's properties there and forgets its class."""

from __future__ import annotations

from typing import Any

import FreeCAD

from .stylus import PROFILE


class Observer:
    """FreeCAD calls it for documents that are made, opened and brought to the front, which ends their opening."""

    def __init__(self) -> None:
        self._new: set[str] = set()

    def slotCreatedDocument(self, document: Any) -> None:
        """It is looked at once it is read."""
        self._new.add(document.Name)

    def slotActivateDocument(self, document: Any) -> None:
        """Gives tools of ours their class back."""
        if document.Restoring or document.Name not in self._new:
            return
        self._new.discard(document.Name)
        from . import compat

        for obj in document.Objects:
            if compat.tool_kind(obj) == compat.STYLUS and hasattr(obj, PROFILE):
                compat.adopt_toolbit(obj)


def watch() -> None:
    """From now on."""
    FreeCAD.addDocumentObserver(Observer())
