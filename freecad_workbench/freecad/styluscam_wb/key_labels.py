# SPDX-License-Identifier: LGPL-2.1-or-later
"""The engine's texts in the words of the panel: keys of the job document by the labels of the fields that fill them."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable

from .fields import Field

HOST = {
    "z_top": "Start Depth",
    "z_bottom": "Final Depth",
    "feeds.cut": "the horizontal feed of the tool controller",
    "feeds.plunge": "the vertical feed of the tool controller",
}
"""Labels of FreeCAD's own properties, by the keys that they fill."""

KEY = re.compile(r"(?<![\w.\"'])(?:[a-z]+(?= = )|[a-z]+(?:[._][a-z]+)+)(?![\w\"'])")
"""A key in a text: a name to which a value is given, or one of several words, which no sentence has."""


def in_labels(text: str, where: str, fields: Iterable[Field], translated: Callable[[str], str] = str) -> str:
    """A text with labels instead of keys.

    Args:
        text: the engine's message or hint.
        where: the error's path in the job document: of keys of one name that of its section is meant.
        fields: all fields.
        translated: a label in the user's language.
    """
    section = re.sub(r"\[\d+\]", "", where).split(".")[0]
    labels: dict[str, str] = {}
    near = sorted(fields, key=lambda field: not field.is_in(section))
    for field in near:
        labels.setdefault(field.key, translated(field.title))
    labels |= HOST

    return KEY.sub(lambda found: labels.get(found[0], found[0]), text)
