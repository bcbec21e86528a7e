# SPDX-License-Identifier: LGPL-2.1-or-later
"""How long work is run: in the window with a dialog that cancels it, elsewhere at once."""

from __future__ import annotations

import threading
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from typing import Any

import FreeCAD

Run = Callable[[Callable[[Any], Any]], Any]
"""Calls a function with a callback for progress (None where nobody looks) and returns its result."""


def long_work(title: str) -> AbstractContextManager[Run]:
    """A context in which functions are run; those that are given must not touch a document."""
    if not FreeCAD.GuiUp or threading.current_thread() is not threading.main_thread():
        return nullcontext(_at_once)
    from .gui.progress import LongWork

    return LongWork(title)


def _at_once(work: Callable[[Any], Any]) -> Any:
    return work(None)
