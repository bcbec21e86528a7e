"""Measured profiles in text files: radius and height in two columns, as spreadsheets and measuring machines write them.

A points profile may name such a file instead of its list, ``"points": "measured.csv"``, relative to the document's
folder; the engine sees the list. Columns are separated by semicolons, tabs, commas or blanks; with the first two, and in
quotes, a comma may be the decimal point. Lines that begin with # are comments, lines above the numbers are headings.
"""

from __future__ import annotations

import csv
import math
import re
from pathlib import Path

from styluscam.errors import ToolError
from styluscam.types import Document

LARGEST = 20_000_000
"""Bytes: 100 000 points, the most that make a profile, take a fifth of it."""

NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?", re.IGNORECASE)

HEADING = re.compile(r"[^\W\d_]|^\D*$")
"""A line with a letter, or without a digit."""

ORDERS = {"r": 0, "radius": 0, "z": 1, "height": 1}
"""Which column a heading's first word stands for."""


def read_points(path: str | Path) -> list[list[float]]:
    """Radii and heights (mm) from a file.

    Raises:
        ToolError: it cannot be read, or a line is not two numbers; the line is named.
    """
    lines = _text(Path(path)).splitlines()
    kept = [(number, line) for number, line in enumerate(lines, start=1) if line.strip() and line.strip()[0] != "#"]
    separator = _separator([line for _, line in kept])
    found: list[list[float]] = []
    order = [0, 1]
    for number, line in kept:
        fields = _fields(line.partition("#")[0], separator)
        values = [_number(field) for field in fields]
        if not found and HEADING.search(line) and not any(value is not None for value in values):
            columns = [ORDERS.get(re.split(r"\W", field.lower())[0], -1) for field in fields]
            order = [1, 0] if columns == [1, 0] else order
            continue
        if len(values) != 2 or None in values:
            raise _wrong(path, number, line)
        found.append([float(values[column] or 0.0) for column in order])
    if not found:
        message = f"{path}: no points: not a line with two numbers"
        raise ToolError(message, code="unreadable", where=str(path), hint="write radius and height, as in 1.5, 0.12")
    return found


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


def _text(path: Path) -> str:
    """As UTF-8 or UTF-16 with its mark; else byte by byte: headings may hold anything, numbers do not."""
    try:
        data = path.read_bytes() if path.stat().st_size <= LARGEST else None
    except (OSError, ValueError) as error:
        message = f"{path}: cannot be read: {getattr(error, 'strerror', None) or error}"
        raise ToolError(message, code="unreadable", where=str(path), hint="check the path") from error
    if data is None:
        message = f"{path}: longer than {LARGEST // 1_000_000} MB: not the points of a profile"
        raise ToolError(message, code="unreadable", where=str(path), hint="100000 points make a profile at most")
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return data.decode("utf-16", errors="replace")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def _separator(lines: list[str]) -> str | None:
    """What stands between the columns: the first of these that is used at all; blanks are None."""
    return next((mark for mark in ";\t," if any(mark in line for line in lines)), None)


def _fields(line: str, separator: str | None) -> list[str]:
    """The fields of a line; empty ones at its end are none."""
    fields = line.split() if separator is None else next(csv.reader([line], delimiter=separator), [])
    fields = [field.strip() for field in fields]
    while fields and not fields[-1]:
        fields.pop()
    return fields


def _number(field: str) -> float | None:
    """None where it is no finite number; a single comma is a decimal point."""
    text = field.replace(",", ".") if field.count(",") == 1 and "." not in field else field
    value = float(text) if NUMBER.fullmatch(text) else math.nan
    return value if math.isfinite(value) else None


def _wrong(path: str | Path, number: int, line: str) -> ToolError:
    shown = line.strip() if len(line.strip()) <= 40 else line.strip()[:37] + "..."
    return ToolError(
        f"{path}: line {number}: {shown!r}: a radius and a height are expected",
        code="document",
        where=f"{path}:{number}",
        hint="two columns in mm; with decimal commas, separate them by semicolons",
    )
