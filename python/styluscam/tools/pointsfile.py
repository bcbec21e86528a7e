"""Measured profiles in text files: radius and height in two columns, as spreadsheets and measuring machines write them.

A points profile may name such a file instead of its list, ``"points": "measured.csv"``, relative to the document's
folder; the engine sees the list.
"""

from __future__ import annotations

from pathlib import Path

from styluscam.errors import ToolError
from styluscam.tables import Layout, read_table
from styluscam.types import Document

LAYOUT = Layout(
    columns={"r": 0, "radius": 0, "z": 1, "height": 1},
    content="a radius and a height",
    example="write radius and height, as in 1.5, 0.12",
    cure="two columns in mm",
    largest=20_000_000,  # 100 000 points, the most that make a profile, take a fifth of it
    too_large="not the points of a profile; 100000 points make a profile at most",
    failure=ToolError,
)


def read_points(path: str | Path) -> list[list[float]]:
    """Radii and heights (mm) from a file.

    Raises:
        ToolError: it cannot be read, or a line is not two numbers; the line is named.
    """
    return read_table(Path(path), LAYOUT)


def resolved(document: Document, folder: str | Path) -> tuple[Document, list[Path]]:
    """A tool's document with its points instead of the file that it names, and that file.

    Raises:
        ToolError: as :func:`read_points`.
    """
    profile = document.get("profile")
    if not isinstance(profile, dict) or not isinstance(profile.get("points"), str):
        return document, []
    file = Path(folder) / profile["points"]
    return {**document, "profile": {**profile, "points": read_points(file)}}, [file]


def with_folder(document: Document, folder: str | Path) -> Document:
    """A tool's document with its points' file named from anywhere."""
    profile = document.get("profile")
    if not isinstance(profile, dict) or not isinstance(profile.get("points"), str):
        return document
    return {**document, "profile": {**profile, "points": str(Path(folder).resolve() / profile["points"])}}
