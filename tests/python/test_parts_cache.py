"""Parts that are read a second time: the same arrays, without the CAD kernel; a bad entry is no harm."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import numpy as np
import pytest

from styluscam.parts import cache
from styluscam.parts.arrays import PartArrays
from styluscam.parts.reading import read_part

pytest.importorskip("OCP.STEPControl", reason="needs the step extra")
from test_parts_step import all_kinds, box, write_step

FIXTURES = Path(__file__).parents[2] / "fixtures"


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("STYLUSCAM_CACHE", str(tmp_path / "cache"))
    return tmp_path / "cache" / "parts"


def entries(folder: Path) -> list[Path]:
    return sorted(folder.iterdir()) if folder.exists() else []


def assert_same(one: PartArrays, other: PartArrays) -> None:
    for name in cache.ARRAYS:
        a, b = getattr(one, name), getattr(other, name)
        assert a.dtype == b.dtype and np.array_equal(a, b) and not b.flags.writeable
    assert all(getattr(one, name) == getattr(other, name) for name in (*cache.PLAIN, "faces", "source"))
    points = one.vertices[one.triangles].mean(axis=1)[::7] + 0.01
    assert np.array_equal(
        one.surface_distance(points, one.face_ids[::7]), other.surface_distance(points, other.face_ids[::7])
    )


def test_the_second_reading_is_the_first_without_the_kernel(
    tmp_path: Path, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = write_step(all_kinds(), tmp_path / "kinds.step")
    first = read_part(file, 0.01)
    assert len(entries(folder)) == 1
    monkeypatch.setitem(sys.modules, "OCP.STEPControl", None)
    assert_same(first, read_part(file, 0.01))
    copy = tmp_path / "copy.step"
    copy.write_bytes(file.read_bytes())
    assert read_part(copy, 0.01).source == str(copy)


def test_another_tolerance_or_file_is_another_part(tmp_path: Path, folder: Path) -> None:
    file = write_step(box(), tmp_path / "box.step")
    read_part(file, 0.01)
    read_part(file, 0.02)
    file.write_bytes(file.read_bytes().replace(b"'Open CASCADE", b"'open CASCADE"))
    read_part(file, 0.01)
    assert len(entries(folder)) == 3


@pytest.mark.parametrize("damage", ["cut", "empty", "junk", "flipped"])
def test_a_damaged_entry_is_thrown_away(damage: str, tmp_path: Path, folder: Path) -> None:
    file = write_step(box(), tmp_path / "box.step")
    first = read_part(file)
    (entry,) = entries(folder)
    whole = entry.read_bytes()
    assert len(whole) > 1000
    flipped = bytearray(whole)
    flipped[250] ^= 0xFF  # in the first array's numbers
    entry.write_bytes({"cut": whole[: len(whole) // 2], "empty": b"", "junk": b"junk" * 99, "flipped": flipped}[damage])
    assert_same(first, read_part(file))
    assert entry.read_bytes() == whole


def test_a_folder_that_cannot_be_written_to_is_no_harm(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("STYLUSCAM_CACHE", str(tmp_path / "file"))
    assert len(read_part(write_step(box(), tmp_path / "box.step")).triangles) == 12


def test_the_folder_is_bounded(tmp_path: Path, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    sides = (10.0, 11.0, 12.0, 13.0)
    files = [write_step(box(side), tmp_path / f"{side}.step") for side in sides]
    read_part(files[0])
    size = entries(folder)[0].stat().st_size
    monkeypatch.setattr(cache, "MOST", int(4.5 * size))
    monkeypatch.setattr(cache, "MOST_OF_ONE", int(1.5 * size))
    for i, file in enumerate(files):
        read_part(file)
        newest = max(entries(folder), key=lambda path: path.stat().st_mtime_ns)
        os.utime(newest, (i, i))
    assert 2 <= len(entries(folder)) <= 4
    monkeypatch.setattr(cache, "MOST_OF_ONE", 10)
    before = len(entries(folder))
    read_part(write_step(box(20.0), tmp_path / "20.step"))
    assert len(entries(folder)) <= before
