"""STL files as other programs write them: each reads as the plain one does."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from styluscam.errors import GeometryError
from styluscam.parts.reading import read_part

CORNERS = np.array([(x, y, z) for x in (0, 10) for y in (0, 10) for z in (0, 10)], dtype=float)
TRIANGLES = np.array(
    [
        *[(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1)],
        *[(2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)],
    ]
)


def text(number: str = "%.6e", name: str = "cube", line: str = "\n") -> str:
    facets = []
    for corners in CORNERS[TRIANGLES]:
        vertices = [f"      vertex {' '.join(number % x for x in corner)}{line}" for corner in corners]
        facets.append(
            f"  facet normal 0 0 0{line}    outer loop{line}{''.join(vertices)}    endloop{line}  endfacet{line}"
        )
    return f"solid {name}{line}{''.join(facets)}endsolid {name}{line}"


def binary(header: bytes = b"", after: bytes = b"") -> bytes:
    record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    records = np.zeros(len(TRIANGLES), record)
    records["corners"] = CORNERS[TRIANGLES]
    return header.ljust(80, b" ") + len(records).to_bytes(4, "little") + records.tobytes() + after


READ = {
    "upper case": text().upper().encode(),
    "mixed case": text().title().encode(),
    "blank first lines": b"\n \n\t\n" + text().encode(),
    "a comment first": b"; made by hand\n" + text().encode(),
    "tabs": text().replace("  ", "\t").encode(),
    "carriage returns": text(line="\r").encode(),
    "both line ends": text(line="\r\n").encode(),
    "one line": text(line=" ").encode(),
    "no last line": text().encode()[: text().encode().rfind(b"endsolid")],
    "no name": text(name="").encode(),
    "a name of keywords": text(name="facet vertex endsolid loop").encode(),
    "a name in Latin-1": text(name="Gehäuse").encode("latin-1"),
    "byte order mark": b"\xef\xbb\xbf" + text().encode(),
    "UTF-16": text().encode("utf-16"),
    "plain numbers": text("%g").encode(),
    "exponents": text("%+.3E").encode(),
    "binary": binary(),
    "binary that begins with solid": binary(b"solid made by CAD"),
    "binary with more behind": binary(after=b"\0\0\0"),
}


@pytest.mark.parametrize("name", READ)
def test_reads_as_the_plain_one(name: str, tmp_path: Path) -> None:
    file = tmp_path / "part.stl"
    file.write_bytes(READ[name])
    part = read_part(file, units="mm")
    assert (len(part.vertices), len(part.triangles), part.is_closed) == (8, 12, True)
    assert part.box == ((0, 0, 0), (10, 10, 10))
    odd = {"no last line": "endsolid", "binary with more behind": "3 bytes"}.get(name)
    assert (odd is None and not part.notes) or (odd is not None and odd in part.notes[0])


def test_several_solids_are_one_part(tmp_path: Path) -> None:
    file = tmp_path / "part.stl"
    shifted = "\n".join(
        line if "vertex" not in line else f"vertex {' '.join(str(float(x) + 20.0) for x in line.split()[1:])}"
        for line in text("%g").splitlines()
    )
    file.write_text(text() + "\n" + shifted)
    part = read_part(file, units="mm")
    assert (len(part.triangles), part.is_closed, part.box[1]) == (24, True, (30, 30, 30))


REFUSED = {
    "decimal commas": (text().replace(".", ","), "line 2: a facet with decimal commas"),
    "cut in a number": (text()[: text().rfind("vertex") + 12], "the last facet is cut short"),
    "two corners": (text().replace("vertex", "corner", 1), "line 2: a facet that has not three corners"),
    "a word": (text().replace("0.000000e+00", "zero", 1), "line 2: a facet that has not three corners"),
    "a header's lie": (binary()[:300].decode("latin-1"), "states 12 triangles, the file holds 4"),
    "another format": ("ISO-10303-21;\nHEADER;\n" * 20, "it is a STEP file"),
    "too short": ("\0" * 40, "long enough"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_refused_with_the_position(name: str, tmp_path: Path) -> None:
    content, words = REFUSED[name]
    file = tmp_path / "part.stl"
    file.write_bytes(content.encode("latin-1"))
    with pytest.raises(GeometryError, match=words) as caught:
        read_part(file, units="mm")
    assert caught.value.code == "part-damaged" and caught.value.hint in str(caught.value)


def test_long_text_is_read_in_blocks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("styluscam.parts.stl.BLOCK", 700)
    file = tmp_path / "part.stl"
    file.write_text(text())
    assert len(read_part(file, units="mm").triangles) == 12
