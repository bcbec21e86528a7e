# SPDX-License-Identifier: LGPL-2.1-or-later
"""Edges that are selected in the view."""

from __future__ import annotations

from typing import Any

import FreeCADGui

from .. import properties, rails
from . import pictures


def selected(job: Any) -> list[str]:
    """The selected edges of a job's model, in the order in which they were selected; none where anything else is selected too."""
    known = pictures.stands_for(job)
    found: list[str] = []
    for one in FreeCADGui.Selection.getSelectionEx():
        names = [name.rpartition(".")[2] for name in one.SubElementNames]
        if one.Object not in known or not names or not all(name.startswith("Edge") for name in names):
            return []
        found += [name for name in names if name not in found]
    return found


def take(obj: Any, job: Any) -> bool:
    """Makes two selected edges the rails of an operation whose kind takes them; whether it did."""
    field, names = rails.field_of(obj), selected(job)
    if field is None or len(names) != 2:
        return False
    setattr(obj, field.name, rails.of_edges(names))
    properties.show_owned(obj)
    return True
