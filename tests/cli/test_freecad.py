"""`styluscam freecad run` where FreeCAD is not needed: what is refused before it starts, and what it may do instead."""

from __future__ import annotations

import os
import zipfile
from pathlib import Path
from typing import Any

import pytest

from .conftest import CHECKOUT, Ran, run_cli

ADDON = CHECKOUT / "freecad_workbench"
VARIABLE = "STYLUSCAM_FREECADCMD"


@pytest.fixture
def document(tmp_path: Path) -> Path:
    """A file that FreeCAD could open."""
    return packed(tmp_path / "a cup.FCStd", "<Document/>")


def packed(path: Path, document: str) -> Path:
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("Document.xml", document)
        archive.writestr("Shape.brp", "shape " * 1000)
    return path


def refused(ran: Ran, *words: str) -> None:
    assert ran.code == 2 and ran.err.count("\n") == 1 and ran.err.startswith("error: ")
    assert [word for word in words if word not in ran.err] == [], ran.err


def test_without_freecad(document: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    refused(run_cli("freecad", "run", document), "FreeCAD is not found", f"set {VARIABLE} to its freecadcmd")


@pytest.mark.parametrize(("named", "why"), [("/no/such", "there is no such program"), ("'a", "cannot be read")])
def test_a_variable_that_names_nothing(document: Path, monkeypatch: Any, named: str, why: str) -> None:
    monkeypatch.setenv(VARIABLE, named)
    ran = run_cli("freecad", "run", document, "--json")
    assert ran.code == 2 and ran.json["error"]["code"] == "freecad-missing" and why in ran.json["error"]["message"]


def test_a_program_with_spaces_in_its_name(document: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    program = tmp_path / "my FreeCAD"
    program.write_text("#!/bin/sh\necho started in $PWD\nexit 7\n")
    program.chmod(0o755)
    monkeypatch.setenv(VARIABLE, str(program))
    refused(run_cli("freecad", "run", document, "-q"), "ended with exit code 7", "left no report", "started in")


def test_words_of_a_shell(document: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(VARIABLE, "sh -c 'kill -9 $$'")
    ran = run_cli("freecad", "run", document, "--json")
    assert ran.code == 4 and ran.err == "", "a crash is not the document's fault"
    (only,) = ran.json["files"]
    assert only["error"]["code"] == "freecad-crashed" and "by signal 9" in only["error"]["message"]
    assert only["file"] == str(document) and only["written"] == []


def test_what_is_no_document(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv(VARIABLE, "false")
    text = tmp_path / "text.FCStd"
    text.write_text("no archive")
    other = tmp_path / "other.FCStd"
    with zipfile.ZipFile(other, "w") as archive:
        archive.writestr("a", "b")
    half = packed(tmp_path / "half.FCStd", "<Document><Objects>")
    damaged = packed(tmp_path / "damaged.FCStd", "<Document/>")
    content = damaged.read_bytes()
    damaged.write_bytes(content.replace(b"shape shape", b"shape_shape", 1))
    folder = tmp_path / "folder.FCStd"
    folder.mkdir()
    pipe = tmp_path / "pipe.FCStd"
    os.mkfifo(pipe)
    for file, why in {
        pipe: "it is no file",
        text: "it is no FreeCAD document",
        other: "it is no FreeCAD document",
        half: "it is damaged",
        damaged: "it is damaged: Shape.brp in it cannot be read",
        folder: "it is no file",
        tmp_path / "none.FCStd": "cannot be read: No such file or directory",
    }.items():
        refused(run_cli("freecad", "run", file, "-q"), file.name, why)


def test_one_name_for_several_documents(document: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(VARIABLE, "false")
    refused(run_cli("freecad", "run", document, document, "--out", "a.nc"), "--out names one file")


def test_a_folder_that_is_not_the_addons(document: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(VARIABLE, "false")
    refused(run_cli("freecad", "run", document, "--addon", document.parent), "not the addon's folder", "package.xml")
    assert "not the addon's folder" not in run_cli("freecad", "run", document, "--addon", ADDON).err


def test_a_read_only_document_is_not_saved(document: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(VARIABLE, "false")
    document.chmod(0o444)
    refused(run_cli("freecad", "run", document, "--save", "-q"), "it is read-only", "leave --save out")
    assert "it is read-only" not in run_cli("freecad", "run", document, "-q").err


def test_what_fails_does_not_stop_the_others(document: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv(VARIABLE, "false")
    ran = run_cli("freecad", "run", tmp_path / "none.FCStd", document, "--jobs", "2", "--json")
    codes = [each["error"]["code"] for each in ran.json["files"]]
    assert (ran.code, codes) == (2, ["unreadable", "freecad-ended"])
