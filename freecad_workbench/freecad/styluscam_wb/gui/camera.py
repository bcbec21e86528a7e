# SPDX-License-Identifier: LGPL-2.1-or-later
"""The camera of the 3-D view in front."""

from __future__ import annotations

import FreeCADGui


def show_all(*, isometric: bool = False) -> None:
    """Moves the camera at once to where it sees all of the document, isometrically or in its present direction.

    FreeCAD's own movement waits in an event loop of its own: a document that is closed meanwhile, as quick hands and scripts do,
    ends FreeCAD 1.0 by a segmentation fault in `View3DInventorViewer::animatedViewAll`.
    """
    view = FreeCADGui.activeDocument().activeView()
    animated = view.isAnimationEnabled()
    view.setAnimationEnabled(False)
    try:
        if isometric:
            view.viewIsometric()
        FreeCADGui.SendMsgToActiveView("ViewFit")
    finally:
        view.setAnimationEnabled(animated)
