# SPDX-License-Identifier: LGPL-2.1-or-later
"""How objects of ours get a view: the window's part of the addon states it, where there is a window."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

OPERATION, BIT = "operation", "tool bit"
"""What is shown."""

_attachers: dict[str, Callable[[Any], None]] = {}


def attach_with(attacher: Callable[[Any], None], what: str = OPERATION) -> None:
    """Makes everything of a sort that is created or restored get its view from this."""
    _attachers[what] = attacher


def attach(obj: Any, what: str = OPERATION) -> None:
    """Gives an object its view, where there is a window."""
    if what in _attachers and getattr(obj, "ViewObject", None) is not None:
        _attachers[what](obj)
