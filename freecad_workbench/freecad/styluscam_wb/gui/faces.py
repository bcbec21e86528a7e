# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faces that an error names, selected in the view."""

from __future__ import annotations

import re
from typing import Any

import FreeCADGui

from .. import documents, ops


def show(obj: Any) -> list[str]:
    """Selects the faces that an operation's error names, and returns them."""
    named = list(dict.fromkeys(re.findall(r"\bFace\d+\b", ops.failure(obj))))
    model = documents.model_of(obj)
    known = [name for name in named if int(name.removeprefix("Face")) <= len(model.Shape.Faces)]
    if known:
        FreeCADGui.Selection.clearSelection()
        FreeCADGui.Selection.addSelection(model, known)
    return known
