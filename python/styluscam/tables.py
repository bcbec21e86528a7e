"""Numbers in the columns of text files, as spreadsheets and measuring machines write them.

Columns are separated by semicolons, tabs, commas or blanks; with the first two, and in quotes, a comma may be the decimal
point. Lines that begin with # are comments, lines above the numbers are headings: they may name the columns in another order.
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from styluscam.errors import StylusError

NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?", re.IGNORECASE)

HEADING = re.compile(r"[^\W\d_]|^\D*$")
"""A line with a letter, or without a digit."""


@dataclass(frozen=True)
class Layout:
    """What the lines of a file hold, and what is raised where they do not."""

    columns: Mapping[str, int]
    """Which column a heading's first word stands for; a column may have several words."""
    content: str
    """What a line states: "a radius and a height"."""
    example: str
    """What to write instead of a file without numbers."""
    cure: str
    """How to write the columns."""
    largest: int
    """Bytes that are read at most."""
    too_large: str
    """Why a longer file is none of these, and what to do."""
    failure: type[StylusError]

    @property
    def width(self) -> int:
        """How many columns there are."""
        return max(self.columns.values()) + 1


def read_table(path: Path, layout: Layout) -> list[list[float]]:
    """The numbers of each line, in the layout's order.

    Raises:
        StylusError: the layout's, where the file cannot be read, or a line is not such numbers; the line is named.
    """
    lines = _text(path, layout).splitlines()
    kept = [(number, line) for number, line in enumerate(lines, start=1) if line.strip() and line.strip()[0] != "#"]
    separator = _separator([line for _, line in kept])
    found: list[list[float]] = []
    order = list(range(layout.width))
    for number, line in kept:
        fields = _fields(line.partition("#")[0], separator)
        values = [_number(field) for field in fields]
        if not found and HEADING.search(line) and not any(value is not None for value in values):
            order = _order(fields, layout) or order
            continue
        if len(values) != layout.width or None in values:
            raise _wrong(path, number, line, layout)
        found.append([float(values[column] or 0.0) for column in order])
    if not found:
        message = f"{path}: no points: not a line with {layout.content}"
        raise layout.failure(message, code="unreadable", where=str(path), hint=layout.example)
    return found


def _order(fields: list[str], layout: Layout) -> list[int] | None:
    """In which field each column is, where a heading names them all."""
    columns = [layout.columns.get(re.split(r"\W", field.lower())[0], -1) for field in fields]
    if sorted(columns) != list(range(layout.width)):
        return None
    return [columns.index(column) for column in range(layout.width)]


def _text(path: Path, layout: Layout) -> str:
    """As UTF-8 or UTF-16 with its mark; else byte by byte: headings may hold anything, numbers do not."""
    try:
        data = path.read_bytes() if path.stat().st_size <= layout.largest else None
    except (OSError, ValueError) as error:
        message = f"{path}: cannot be read: {getattr(error, 'strerror', None) or error}"
        raise layout.failure(message, code="unreadable", where=str(path), hint="check the path") from error
    if data is None:
        what, _, hint = layout.too_large.partition("; ")
        message = f"{path}: longer than {layout.largest // 1_000_000} MB: {what}"
        raise layout.failure(message, code="unreadable", where=str(path), hint=hint)
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


def _wrong(path: Path, number: int, line: str, layout: Layout) -> StylusError:
    shown = line.strip() if len(line.strip()) <= 40 else line.strip()[:37] + "..."
    return layout.failure(
        f"{path}: line {number}: {shown!r}: {layout.content} are expected",
        code="document",
        where=f"{path}:{number}",
        hint=f"{layout.cure}; with decimal commas, separate them by semicolons",
    )
