"""Outputs appear whole or not at all, with the permissions that a user expects, and are on the disk."""

from __future__ import annotations

import errno
import os
import stat
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

import styluscam as sc
from styluscam import extras
from styluscam.files import all_drawn_whole, drawn_whole, write_all_whole, write_whole


@pytest.fixture
def umask() -> Iterator[None]:
    before = os.umask(0o027)
    yield
    os.umask(before)


def mode(path: Path) -> int:
    return stat.S_IMODE(path.stat().st_mode)


def test_new_files_have_the_permissions_of_the_umask(tmp_path: Path, umask: None) -> None:
    write_whole(tmp_path / "text", "a\n")
    with drawn_whole(tmp_path / "drawn") as temporary:
        temporary.write_bytes(b"b")
    assert mode(tmp_path / "text") == mode(tmp_path / "drawn") == 0o640


def test_files_that_are_replaced_keep_theirs(tmp_path: Path, umask: None) -> None:
    file = tmp_path / "out.ngc"
    for kept in (0o600, 0o664, 0o444):
        file.write_text("old") if not file.exists() else None
        file.chmod(kept)
        write_whole(file, f"new {kept}")
        assert mode(file) == kept and file.read_text() == f"new {kept}"


def test_texts_and_bytes_are_written_as_they_are(tmp_path: Path) -> None:
    write_all_whole({tmp_path / "deep" / "a": "ä\r\n", tmp_path / "b": memoryview(b"\x00\xff")})
    assert (tmp_path / "deep" / "a").read_bytes() == b"\xc3\xa4\r\n"
    assert (tmp_path / "b").read_bytes() == b"\x00\xff"


def test_contents_and_names_are_on_the_disk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The content before the name, the folder after it."""
    seen = []
    fsync, replace = os.fsync, Path.replace

    def synced(handle: int) -> None:
        kind = "folder" if stat.S_ISDIR(os.fstat(handle).st_mode) else "file"
        seen.append(kind)
        fsync(handle)

    def replaced(self: Path, target: Path) -> Path:
        seen.append("rename")
        return replace(self, target)

    monkeypatch.setattr(os, "fsync", synced)
    monkeypatch.setattr(Path, "replace", replaced)
    write_all_whole({tmp_path / "a": "1", tmp_path / "b": "2"})
    assert seen == ["file", "file", "rename", "rename", "folder"]


def test_nothing_is_left_where_writing_fails(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "a").write_text("old")

    def full(self: Path, data: bytes) -> int:
        if self.name.startswith(".b"):
            raise OSError(errno.ENOSPC, "No space left on device")
        return len(data)

    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(sc.StylusError, match=r"b: cannot be written: No space left on device") as caught:
        write_all_whole({tmp_path / "a": "new", tmp_path / "b": "new"})
    assert caught.value.code == "unwritable" and caught.value.where == str(tmp_path / "b")
    assert {path.name for path in tmp_path.iterdir()} == {"a"} and (tmp_path / "a").read_text() == "old"


def test_nothing_is_left_where_the_block_fails(tmp_path: Path) -> None:
    with pytest.raises(KeyError), all_drawn_whole([tmp_path / "a", tmp_path / "b"]) as temporaries:
        temporaries[0].write_text("half")
        raise KeyError
    assert list(tmp_path.iterdir()) == []


def test_a_refused_renaming_leaves_whole_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    replace = Path.replace

    def refused(self: Path, target: Path) -> Path:
        if target.name == "b":
            raise PermissionError(errno.EACCES, "Permission denied")
        return replace(self, target)

    monkeypatch.setattr(Path, "replace", refused)
    with pytest.raises(sc.StylusError, match="b: cannot be written: Permission denied"):
        write_all_whole({tmp_path / "a": "1", tmp_path / "b": "2", tmp_path / "c": "3"})
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == {"a": "1"}


@pytest.mark.parametrize("extra", extras.EXTRAS)
def test_a_missing_extra_is_named_with_its_cure(extra: str, monkeypatch: pytest.MonkeyPatch) -> None:
    module, index = list(extras.EXTRAS[extra].items())[-1]
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(sc.GeometryError, match=rf"^this needs {index}: pip install 'styluscam\[{extra}\]'$") as caught:
        extras.require(extra, "this", failure=sc.GeometryError, where="here")
    assert (caught.value.code, caught.value.where) == (f"extra-{extra}", "here")
    assert caught.value.hint == f"pip install 'styluscam[{extra}]'"


def test_extras_bring_what_the_project_file_lists() -> None:
    tomllib = pytest.importorskip("tomllib")
    project = tomllib.loads((Path(__file__).resolve().parents[2] / "pyproject.toml").read_text())["project"]
    listed = {
        extra: {line.partition(">")[0] for line in lines} for extra, lines in project["optional-dependencies"].items()
    }
    assert {extra: set(modules.values()) for extra, modules in extras.EXTRAS.items()} == listed
