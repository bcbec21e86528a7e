# SPDX-License-Identifier: LGPL-2.1-or-later
"""A position of a finding in the 3-D view: a marker, the face there selected, and the view centred on it."""

from __future__ import annotations

from typing import Any

import FreeCAD
import FreeCADGui

from .. import contacts
from ..verification import Verified
from . import pictures, scene

KEY = "finding"


def mark(verified: Verified, position: list[float], line: int) -> int | None:
    """Marks a position of the tool's tip on a line of the text; the number of the face under it, if there is one."""
    job = verified.draft.job
    document = job.Document.Name
    node = scene.separator("StylusCAM_Finding", scene.marker(position))
    pictures.show(pictures.Picture(document, KEY, node))
    face = contacts.face_under(verified, position, line)
    FreeCADGui.Selection.clearSelection()
    seen = next((obj for obj in pictures.stands_for(job) if obj.ViewObject.Visibility), None)
    if face is not None and seen is not None:
        FreeCADGui.Selection.addSelection(document, seen.Name, f"Face{face}")
    for view in pictures.views_of(document):
        centre(view, FreeCAD.Vector(*position))
    return face


def clear(document: str) -> None:
    """Takes the marker away."""
    pictures.remove(document, KEY)


def centre(view: Any, point: FreeCAD.Vector) -> None:
    """Moves the camera so that it looks at a point in its direction and from its distance."""
    camera = view.getCameraNode()
    position = point - view.getViewDirection() * camera.focalDistance.getValue()
    camera.position.setValue(position.x, position.y, position.z)
