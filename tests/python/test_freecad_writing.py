"""Programs of FreeCAD documents to files: by FreeCAD's preference, all of a document's or none, each name once."""

from __future__ import annotations

import io
import zipfile
from pathlib import Path
from typing import Any

import pytest

import styluscam as sc
from styluscam.freecad.document import DocumentRun
from styluscam.freecad.views import with_views
from styluscam.freecad.writing import Writer


def made(file: Path, *names: Path, policy: str = "replace") -> DocumentRun:
    """A document's result with a program for each name."""
    programs: list[dict[str, Any]] = [{"file": str(name)} for name in names]
    job = {"label": "Job", "programs": programs, "error": None}
    return DocumentRun(file, {"policy": policy, "jobs": [job]}, [[f"G0 X{n}\n" for n in range(len(names))]])


def test_programs_are_written_and_named(tmp_path: Path) -> None:
    run = made(tmp_path / "a.FCStd", tmp_path / "new folder" / "a.nc", tmp_path / "b.nc")
    Writer([run.file], None, False).write(run)
    assert run.written == [tmp_path / "new folder" / "a.nc", tmp_path / "b.nc"]
    assert [path.read_text() for path in run.written] == ["G0 X0\n", "G0 X1\n"]


@pytest.mark.parametrize(
    ("policy", "force", "expected"),
    [("replace", False, "a.nc"), ("unique", False, "a-1-1.nc"), ("ask", True, "a.nc"), ("ask", False, None)],
)
def test_what_is_there_is_treated_as_freecad_is_set(
    tmp_path: Path, policy: str, force: bool, expected: str | None
) -> None:
    for name in ("a.nc", "a-1.nc"):
        (tmp_path / name).write_text("old")
    run = made(tmp_path / "a.FCStd", tmp_path / "a.nc", policy=policy)
    writer = Writer([run.file], None, force)
    if expected is None:
        with pytest.raises(sc.StylusError, match="set to ask before it replaces files") as caught:
            writer.write(run)
        assert "--force" in caught.value.hint and (tmp_path / "a.nc").read_text() == "old"
        return
    writer.write(run)
    assert run.jobs[0]["programs"][0]["file"] == str(tmp_path / expected)
    assert (tmp_path / expected).read_text() == "G0 X0\n" and (tmp_path / "a-1.nc").read_text() == "old"


def test_two_documents_do_not_share_a_file(tmp_path: Path) -> None:
    writer = Writer([], None, False)
    one, other = (made(tmp_path / name, tmp_path / "x" / ".." / "out.nc") for name in ("a.FCStd", "b.FCStd"))
    writer.write(one)
    with pytest.raises(sc.StylusError, match=r"of .*a\.FCStd, Job and of .*b\.FCStd, Job"):
        writer.write(other)
    assert other.written == []


def test_a_document_is_not_replaced_by_a_program(tmp_path: Path) -> None:
    file = tmp_path / "a.FCStd"
    file.write_bytes(b"document")
    with pytest.raises(sc.StylusError, match="is read by this very job"):
        Writer([file], None, False).write(made(file, tmp_path / "b.nc", file))
    assert file.read_bytes() == b"document" and not (tmp_path / "b.nc").exists()


def test_one_name_takes_one_program(tmp_path: Path) -> None:
    out = tmp_path / "out.nc"
    with pytest.raises(sc.StylusError, match="makes 2 programs"):
        Writer([], out, False).write(made(tmp_path / "a.FCStd", tmp_path / "a.nc", tmp_path / "b.nc"))
    Writer([], out, False).write(made(tmp_path / "a.FCStd", tmp_path / "a.nc"))
    assert out.read_text() == "G0 X0\n" and not (tmp_path / "a.nc").exists()
    with pytest.raises(sc.StylusError, match="the file exists"):
        Writer([], out, False).write(made(tmp_path / "a.FCStd", tmp_path / "a.nc"))
    Writer([], out, True).write(made(tmp_path / "a.FCStd", tmp_path / "a.nc"))


def test_a_document_with_an_error_writes_nothing(tmp_path: Path) -> None:
    run = made(tmp_path / "a.FCStd", tmp_path / "a.nc")
    run.report["jobs"][0]["error"] = {"exit_code": 1}
    Writer([], None, False).write(run)
    assert run.written == [] and not (tmp_path / "a.nc").exists()


def test_views_that_collide_are_not_mixed_up(tmp_path: Path) -> None:
    old = tmp_path / "a.FCStd"
    with zipfile.ZipFile(old, "w") as archive:
        archive.writestr("GuiDocument.xml", '<Document><Property file="Colours"/></Document>')
        archive.writestr("Colours", "red")
    new = io.BytesIO()
    with zipfile.ZipFile(new, "w") as archive:
        archive.writestr("Document.xml", "<Document/>")
    with zipfile.ZipFile(io.BytesIO(with_views(old, new.getvalue()))) as both:
        assert sorted(both.namelist()) == ["Colours", "Document.xml", "GuiDocument.xml"]
    with zipfile.ZipFile(new, "a") as archive:
        archive.writestr("Colours", "a shape")
    with pytest.raises(sc.StylusError, match="they name Colours"):
        with_views(old, new.getvalue())
