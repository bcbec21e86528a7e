# SPDX-License-Identifier: LGPL-2.1-or-later
"""Two edges of the model as the rails between which a ruled surface is milled."""

from __future__ import annotations

import json
import re
from typing import Any

from . import engine, properties
from .fields import Field

KEY = "rails"
"""Of an operation; its property holds JSON."""

EDGES = "edges"

TWO = re.compile(r"\s*(Edge\d+)\s*[,;]?\s+(Edge\d+)\s*|\s*(Edge\d+)\s*[,;]\s*(Edge\d+)\s*")
"""Two edges as a person writes them: `Edge3, Edge7`."""


def field_of(obj: Any) -> Field | None:
    """The field of an operation that takes two edges; None where its kind has none."""
    if not (engine.is_there() and properties.are_complete(obj)):
        return None
    return next((field for field in properties.fields() if field.key == KEY and properties.is_shown(obj, field)), None)


def of_edges(names: list[str]) -> str:
    """The property's text for two edges."""
    return json.dumps({EDGES: names})


def shown(text: str) -> str:
    """A property's text as a person reads it: edges by their names, all else as JSON."""
    try:
        value = json.loads(text) if text else None
    except ValueError:
        return text
    names = value.get(EDGES) if isinstance(value, dict) and len(value) == 1 else None
    is_plain = isinstance(names, list) and TWO.fullmatch(", ".join(map(str, names)))
    return ", ".join(names) if is_plain else text


def stored(text: str) -> str:
    """The property's text for what a person wrote."""
    found = TWO.fullmatch(text)
    return of_edges([name for name in found.groups() if name]) if found else text.strip()
