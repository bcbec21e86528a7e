"""STL files, text and binary, as shops have them.

No library reads them all: trimesh, meshio and numpy-stl each refuse some of what follows, which CAD systems and slicers
open: keywords in any case, blank and foreign lines, tabs, carriage returns, one long line, names in any alphabet (or
with keywords in them), several solids, no last line, UTF-16, a binary header that begins with "solid", bytes after the
last triangle.
"""

from __future__ import annotations

import re
import warnings
from pathlib import Path

import numpy as np

from styluscam.errors import GeometryError
from styluscam.parts.arrays import Ints
from styluscam.parts.surfaces import Floats

HEADER, RECORD = 84, np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])

# Text worked on together, bytes.
BLOCK = 1 << 24

# The name after "solid": it may hold keywords; where the whole file is one line, the first facet ends it.
NAME = re.compile(rb"solid\b(?:(?!facet\s+normal\s+[-+.\d])[^\r\n])*")
FACET = re.compile(rb"\bfacet\b")
LOOP = re.compile(rb"outer\s+loop((?:\s+vertex(?:\s+[^\s]+){3}){3})\s+endloop\b")
WHOLE_FACET = re.compile(
    rb"\bfacet\b(?:\s+normal(?:\s+\S+){3})?\s+outer\s+loop(?:\s+vertex(?:\s+[-+.\de]+|\s+[-+]?(?:nan|inf)\w*){3}){3}\s+endloop\b"
)


def read_stl(file: Path) -> tuple[Floats, Ints, tuple[str, ...]]:
    """Return the corners (3T,3) in the file's units, the triangles (T,3), and notes on what is odd in the file.

    Raises:
        GeometryError: neither kind of STL, or cut short.
    """
    data = file.read_bytes()
    if data.lstrip()[:12] == b"ISO-10303-21":
        raise _damaged(file, "it is a STEP file", "give it the ending .step")
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        data = data.decode("utf-16", errors="replace").encode("latin-1", errors="replace")
    size = len(data) - HEADER
    count = int.from_bytes(data[80:HEADER], "little") if size >= 0 else -1
    length = count * RECORD.itemsize
    notes: tuple[str, ...]
    if size != length and _is_text(data):
        points, notes = _read_text(file, data)
    elif 0 < length <= size or size == length:
        records = np.frombuffer(data, RECORD, count, HEADER)
        points = records["corners"].reshape(-1, 3).astype(np.float64)
        notes = (
            (f"the file has {size - length} bytes after its last triangle: they were left out",)
            if size > length
            else ()
        )
    elif size < 0:
        raise _damaged(file, "it is neither text nor long enough for a header")
    else:
        raise _damaged(file, f"its header states {count} triangles, the file holds {size // RECORD.itemsize}")
    return points, np.arange(len(points), dtype=np.int64).reshape(-1, 3), notes


def _is_text(data: bytes) -> bool:
    """Whether the beginning reads as an STL file in text: a keyword of it, and no byte that text never has."""
    head = data[:4096]
    return b"\0" not in head and re.search(rb"\b(?:solid|facet)\b", head, re.IGNORECASE) is not None


def _read_text(file: Path, data: bytes) -> tuple[Floats, tuple[str, ...]]:
    """Return the corners (3T,3) of a text file, and notes."""
    blocks, start = [np.zeros((0, 3))], 0
    while start < len(data):
        end = len(data)
        if end - start > BLOCK:
            last = re.search(rb".*endfacet", data[start : start + BLOCK], re.IGNORECASE | re.DOTALL)
            end = start + last.end() if last else end
        blocks.append(_block(file, data, start, end))
        start = end
    is_whole = re.search(rb"endsolid", data[-4096:], re.IGNORECASE) is not None
    notes = () if is_whole else ("the file has no last line (endsolid): it may be cut short",)
    return np.concatenate(blocks), notes


def _block(file: Path, data: bytes, start: int, end: int) -> Floats:
    """Return the corners in a part of the text, which ends behind a facet or with the text."""
    text = NAME.sub(b"", data[start:end].lower())
    loops = LOOP.findall(text)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", DeprecationWarning)  # what older numpy reports for text that is no number
            numbers = np.fromstring(b" ".join(loops).replace(b"vertex", b"").decode("latin-1"), sep=" ")
        points = numbers.reshape(len(loops) * 3, 3)
    except (ValueError, DeprecationWarning) as error:
        raise _bad_facet(file, data, start, end) from error
    if len(loops) != text.count(b"facet") - text.count(b"endfacet"):
        raise _bad_facet(file, data, start, end)
    return points


def _bad_facet(file: Path, data: bytes, start: int, end: int) -> GeometryError:
    """Name the first facet that cannot be read."""
    # names are blanked, not removed: positions in the text stay
    text = NAME.sub(lambda name: b" " * len(name[0]), data[start:end].lower())
    for facet in FACET.finditer(text):
        if WHOLE_FACET.match(text, facet.start()) is None:
            start_of = facet.start()
            line = data.count(b"\n", 0, start + start_of) + 1
            following = FACET.search(text, facet.end())
            body = text[start_of : following.start() if following else len(text)]
            if re.search(rb"\d,\d", body):
                return _damaged(file, f"line {line}: a facet with decimal commas", "export it with decimal points")
            if following is None and b"endloop" not in body:
                return _damaged(file, f"line {line}: the last facet is cut short")
            return _damaged(file, f"line {line}: a facet that has not three corners of three numbers each")
    return _damaged(file, "its facets cannot be distinguished")


def _damaged(file: Path, why: str, cure: str = "export the part again") -> GeometryError:
    return GeometryError(
        f"{file}: not a whole STL file ({why}): {cure}", code="part-damaged", where=str(file), hint=cure
    )
