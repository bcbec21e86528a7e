# SPDX-License-Identifier: LGPL-2.1-or-later
"""A document, and the objects in it by what a person calls them."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable, Sequence
from typing import Any

import FreeCAD

from .failures import RunError


def open_document(file: str) -> Any:
    """The document of a file, made the active one: FreeCAD's rules for output names look at that.

    Raises:
        RunError: FreeCAD cannot open it.
    """
    try:
        document = FreeCAD.openDocument(file, hidden=True)
    except Exception as error:
        raise RunError(f"FreeCAD cannot open the document: {one_line(error)}") from error
    FreeCAD.setActiveDocument(document.Name)
    return document


def version_note(document: Any) -> list[str]:
    """A sentence where a later FreeCAD has saved the document."""
    here = ".".join(FreeCAD.Version()[:2])
    saved = re.match(r"(\d+)\.(\d+)", str(document.getProgramVersion()))
    if saved is None or (int(saved[1]), int(saved[2])) <= tuple(int(part) for part in here.split(".")):
        return []
    return [
        f"the document was saved by FreeCAD {saved[0]}, which is later than this one ({here}): "
        "what only the later one knows is lost"
    ]


def find(document: Any, name: str) -> Any:
    """The object with this label, else with this name.

    Raises:
        RunError: none, or several with that label.
    """
    labelled = [obj for obj in document.Objects if obj.Label == name]
    if len(labelled) > 1:
        names = ", ".join(obj.Name for obj in labelled)
        raise RunError(f"several objects are labelled {name!r}: name one of them, {names}")
    found = labelled[0] if labelled else document.getObject(name)
    if found is None:
        known = [word for obj in document.Objects for word in (obj.Label, obj.Name)]
        raise RunError(f"the document has no object {name!r}: {near(name, known)}")
    return found


def near(word: str, known: Iterable[str], shown: int = 8) -> str:
    """What might have been meant."""
    words = list(dict.fromkeys(known))
    lower = {each.lower(): each for each in reversed(words)}
    alike = difflib.get_close_matches(word.lower(), lower, n=1)
    if alike:
        return f"did you mean {lower[alike[0]]!r}?"
    return f"there are {listed(words, shown)}" if words else "there are none"


def listed(words: Sequence[str], shown: int = 8) -> str:
    """Words with commas, those that are too many counted."""
    more = len(words) - shown
    return ", ".join(words[:shown]) + (f" and {more} more" if more > 0 else "")


def one_line(error: BaseException) -> str:
    """A foreign error's words on one line; its class where it has none."""
    return " ".join(str(error).split()) or type(error).__name__
