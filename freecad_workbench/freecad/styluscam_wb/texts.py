# SPDX-License-Identifier: LGPL-2.1-or-later
"""Texts in the user's language, with and without a window."""

from __future__ import annotations

import FreeCAD

CONTEXT = "StylusCAM"
"""The context of our texts in files of translations."""


def translated(text: str) -> str:
    """A text in the user's language; itself where there is no translation."""
    return str(FreeCAD.Qt.translate(CONTEXT, text))
