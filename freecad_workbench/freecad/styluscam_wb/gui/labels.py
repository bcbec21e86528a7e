# SPDX-License-Identifier: LGPL-2.1-or-later
"""Labels of new objects."""

from __future__ import annotations

from typing import Any


def unique(label: str, document: Any, own: Any = None) -> str:
    """The label, with a number where another object of the document than `own` has it."""
    taken = {obj.Label for obj in document.Objects if obj != own}
    numbered = (f"{label} {number}" for number in range(2, len(taken) + 2))
    return next(name for name in (label, *numbered) if name not in taken)
