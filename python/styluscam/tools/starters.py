"""A profile of each kind with sensible numbers: what ``styluscam tool new`` begins with."""

from __future__ import annotations

import difflib
import json

from styluscam import _engine
from styluscam.errors import ToolError
from styluscam.tools import toolfile
from styluscam.types import Document

LENGTH = 50.0
"""From the tip to the holder, mm."""


def profiles() -> dict[str, Document]:
    """The engine's profile documents by kind; lengths in mm."""
    documents: list[Document] = [json.loads(text) for text in _engine.profile_starters()]
    return {document["kind"]: document for document in documents}


def starter(kind: str, name: str = "") -> Document:
    """A tool file's document of a kind, ready to be edited.

    Raises:
        ToolError: there is no such kind.
    """
    known = profiles()
    if kind not in known:
        near = difflib.get_close_matches(kind, known, n=1)
        hint = f"did you mean {near[0]!r}?" if near else f"known: {', '.join(known)}"
        raise ToolError(f"unknown kind {kind!r}", code="unknown-kind", where="kind", hint=hint)
    return _file(known[kind], name)


def measured(points: list[list[float]], fit_tolerance: float, name: str = "") -> Document:
    """A tool file's document with a profile through points: radii and heights, mm."""
    return _file({"kind": "points", "points": points, "fit_tolerance": fit_tolerance}, name)


def _file(profile: Document, name: str) -> Document:
    names = {"name": name} if name else {}
    return {"schema": toolfile.SCHEMA, **names, "profile": profile, "length": LENGTH}
