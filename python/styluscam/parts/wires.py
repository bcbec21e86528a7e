"""Closed polylines in plan from a DXF file: the wires that bound an operation's passes.

Group codes: AutoCAD DXF Reference, "ENTITIES section" (LINE, ARC, CIRCLE, LWPOLYLINE with bulges in code 42) and "HEADER section"
(``$INSUNITS``).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

from styluscam.errors import GeometryError
from styluscam.parts.reading import check_readable
from styluscam.types import Document
from styluscam.words import shortened

Position = tuple[float, float]
Pair = tuple[int, str]
Line = list[Position]

DEVIATION = 0.001
"""Curves become chords no farther off than this, mm."""

JOINED = 1e-3
"""Ends of lines no farther apart than this are one, mm."""

UNITS = {0: 1.0, 1: 25.4, 2: 304.8, 4: 1.0, 5: 10.0, 6: 1000.0}
"""Millimetres by ``$INSUNITS``; a file without units is taken to be in mm."""

NUMBERS = (10, 20, 11, 21, 40, 42, 50, 51, 70, 230)
"""Group codes whose values are read as numbers."""

NEEDED = {"LINE": (10, 20, 11, 21), "CIRCLE": (10, 20, 40), "ARC": (10, 20, 40, 50, 51), "LWPOLYLINE": (10, 20)}
"""Group codes without which an entity has no shape."""

IGNORED = {"POINT", "TEXT", "MTEXT", "DIMENSION", "HATCH", "VIEWPORT", "ENDSEC", "SECTION", "EOF"}
"""What bounds nothing."""


def read_wires(file: Path) -> list[Line]:
    """The closed polylines of a DXF file, mm, in work coordinates; curves within 0.001 mm.

    Raises:
        GeometryError: it cannot be read, holds other curves than lines, arcs, circles and light polylines, or lines
            that do not close.
    """
    if file.suffix.lower() != ".dxf":
        raise _error(file, "no DXF file", "export the outline as DXF, or write its corners as boundary.wire")
    check_readable(file)
    pairs = list(_pairs(file))
    scale = UNITS.get(_unit(pairs))
    if scale is None:
        raise _error(file, f"its unit, $INSUNITS = {_unit(pairs)}, is not known here", "save it in mm or inches")
    lines = [[(scale * x, scale * y) for x, y in line] for line in _lines(file, pairs, DEVIATION / scale)]
    if not lines:
        raise _error(file, "it holds no line, arc, circle or polyline", "export the closed outline")
    return _closed(file, lines)


def with_wires(document: Document, folder: Path) -> list[Path]:
    """Puts the polylines of files instead of their names into a job's operations; the files."""
    files = []
    for operation in document["operations"]:
        boundary = operation.get("boundary") or {}
        if "file" in boundary:
            file = folder / boundary.pop("file")
            boundary["wire"] = [*boundary.get("wire", []), *read_wires(file)]
            files.append(file)
    return files


def _pairs(file: Path) -> Iterator[Pair]:
    """Group codes and their values; those that are used and numbers are checked."""
    lines = file.read_text(encoding="utf-8", errors="replace").splitlines()
    if not any(line.strip() == "ENTITIES" for line in lines):
        raise _error(file, "it has no section ENTITIES", "save it as ASCII DXF")
    for number, (code, value) in enumerate(zip(lines[::2], lines[1::2], strict=False), 1):
        try:
            pair = int(code), value.strip()
            if pair[0] in NUMBERS and not math.isfinite(float(value)):
                raise ValueError(value)
        except ValueError as error:
            what = f"line {2 * number}: {shortened(value)} is no number, or the line before it no group code"
            raise _error(file, what, "save it as ASCII DXF") from error
        yield pair


def _unit(pairs: list[Pair]) -> int:
    for (_, name), (code, value) in pairwise(pairs):
        if name == "$INSUNITS" and code == 70:
            return int(float(value))
    return 0


def _entities(pairs: list[Pair]) -> Iterator[tuple[str, list[Pair]]]:
    """The entities of the section of that name, each with its group codes."""
    starts = [i for i, pair in enumerate(pairs) if pair == (2, "ENTITIES")]
    begin = starts[0] + 1 if starts else len(pairs)
    heads = [i for i in range(begin, len(pairs)) if pairs[i][0] == 0]
    for head, after in zip(heads, [*heads[1:], len(pairs)], strict=True):
        if pairs[head][1] == "ENDSEC":
            return
        yield pairs[head][1], pairs[head + 1 : after]


def _lines(file: Path, pairs: list[Pair], deviation: float) -> Iterator[Line]:
    for kind, codes in _entities(pairs):
        number = {code: float(value) for code, value in codes if code in NUMBERS}
        if number.get(230, 1.0) < 0.0:
            raise _error(file, f"a {kind} is drawn from behind (extrusion -Z)", "export it drawn from above")
        missing = [code for code in NEEDED.get(kind, ()) if code not in number]
        if missing:
            raise _error(file, f"a {kind} has no group code {missing[0]}: the file is cut off", "export it again")
        if kind in ("ARC", "CIRCLE") and number[40] <= 0.0:
            raise _error(file, f"a {kind} has the radius {number[40]:g}", "correct it: radii are above 0")
        if kind == "LINE":
            yield [(number[10], number[20]), (number[11], number[21])]
        elif kind in ("ARC", "CIRCLE"):
            first, last = (number[50], number[51]) if kind == "ARC" else (0.0, 360.0)
            sweep = math.radians((last - first) % 360.0 or 360.0)
            yield _arc((number[10], number[20]), number[40], math.radians(first), sweep, deviation)
        elif kind == "LWPOLYLINE":
            yield _polyline(codes, deviation)
        elif kind not in IGNORED:
            raise _error(file, f"it holds a {kind}", "export lines, arcs, circles and light polylines (LWPOLYLINE)")


def _arc(middle: Position, radius: float, first: float, sweep: float, deviation: float) -> Line:
    """Points of an arc whose chords lie no farther off: the sagitta of an angle a is r (1 - cos(a / 2))."""
    widest = 2.0 * math.acos(max(1.0 - deviation / radius, 0.0)) if radius > 0.0 else math.pi
    count = max(3, math.ceil(abs(sweep) / widest))
    angles = [first + sweep * i / count for i in range(count + 1)]
    return [(middle[0] + radius * math.cos(a), middle[1] + radius * math.sin(a)) for a in angles]


def _polyline(codes: list[Pair], deviation: float) -> Line:
    corners: list[list[float]] = []
    is_closed = False
    for code, value in codes:
        if code == 10:
            corners.append([float(value), 0.0, 0.0])
        elif code in (20, 42) and corners:
            corners[-1][1 if code == 20 else 2] = float(value)
        elif code == 70:
            is_closed = bool(int(float(value)) & 1)
    ends = [*corners[1:], corners[0]] if is_closed else corners[1:]
    line = [(corners[0][0], corners[0][1])]
    for (ax, ay, bulge), (bx, by, _) in zip(corners, ends, strict=False):
        if bulge != 0.0:
            aside = (1.0 - bulge * bulge) / (4.0 * bulge)
            middle = (0.5 * (ax + bx) - aside * (by - ay), 0.5 * (ay + by) + aside * (bx - ax))
            radius, first = math.dist(middle, (ax, ay)), math.atan2(ay - middle[1], ax - middle[0])
            line += _arc(middle, radius, first, 4.0 * math.atan(bulge), deviation)[1:-1]
        line.append((bx, by))
    return line


def _closed(file: Path, lines: list[Line]) -> list[Line]:
    """Lines joined at their ends to loops, each without its first corner again at its end."""
    loops, open_lines = [], list(lines)
    while open_lines:
        loop = open_lines.pop()
        while math.dist(loop[0], loop[-1]) > JOINED:
            ahead = [one for one in open_lines if min(math.dist(loop[-1], one[i]) for i in (0, -1)) <= JOINED]
            if not ahead:
                x, y = loop[-1]
                raise _error(file, f"its lines do not close: one ends at X{x:.3f} Y{y:.3f}", "close the outline")
            open_lines.remove(ahead[0])
            is_turned = math.dist(loop[-1], ahead[0][-1]) <= JOINED
            loop = loop + (ahead[0][::-1] if is_turned else ahead[0])[1:]
        loops.append(loop[:-1])
    return loops


def _error(file: Path, what: str, hint: str) -> GeometryError:
    return GeometryError(f"{file}: {what}", code="wire-file", where=str(file), hint=hint)
