"""Texts of the addon in another language."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import pytest

import qt_files
import roots
import translations

GERMAN = "de"


def bracketed(folder: Path, addon: Path) -> Path:
    """The addon with a German translation in which every text of the template stands in brackets."""
    copy = folder / "StylusCAM"
    shutil.copytree(addon, copy)
    target = copy / translations.TRANSLATIONS.relative_to(translations.ADDON)
    texts = {message: f"[[{message[1]}]]" for message in qt_files.read_ts(target / translations.TEMPLATE.name)}
    (target / f"StylusCAM_{GERMAN}.qm").write_bytes(qt_files.qm_bytes(texts))
    return copy


@pytest.fixture
def session(scenarios: Any, addon: Path, tmp_path: Path) -> Any:
    general = {**roots.PREFERENCES["General"], "Language": "German"}
    preferences = {**roots.PREFERENCES, "General": general}
    return scenarios("translated", addon=bracketed(tmp_path, addon), preferences=preferences)


@pytest.mark.world
@pytest.mark.freecad
def test_bars_menus_and_commands_are_translated(session: Any) -> None:
    seen = session["bars and menus"]
    assert len(seen["bars"]) >= 3 and len(seen["commands"]) > 4
    assert seen["plain"] == []
    assert seen["workbench"].startswith("[[")


@pytest.mark.world
@pytest.mark.freecad
def test_panels_of_operations_are_translated(session: Any) -> None:
    seen = session["operation"]
    assert len(seen) >= 2
    assert [line for panel in seen.values() for line in panel["plain"]] == []


@pytest.mark.world
@pytest.mark.freecad
def test_the_panel_of_tools_is_translated(session: Any) -> None:
    seen = session["tool"]
    assert len(seen["kinds"]) > 10
    assert seen["plain"] == []


@pytest.mark.world
@pytest.mark.freecad
def test_the_page_of_preferences_is_translated(session: Any) -> None:
    seen = session["preferences"]
    assert seen["plain"] == []
    assert seen["first"] == "[[not stated]]"
    assert "Traceback" not in session.errors


def test_the_template_is_up_to_date() -> None:
    expected = qt_files.ts_text(translations.messages(), {})
    assert translations.TEMPLATE.read_text(encoding="utf-8") == expected, "run `make translations`"


def test_a_ts_file_is_read_as_it_was_written(tmp_path: Path) -> None:
    texts = {("A", "one & <two>"): "eins & <zwei>", ("A", "open"): "", ("B", "one\ntwo"): "ä"}
    path = tmp_path / "x_de.ts"
    path.write_text(qt_files.ts_text(texts, texts, GERMAN), encoding="utf-8")
    assert qt_files.read_ts(path) == texts
    assert path.read_text(encoding="utf-8").count('type="unfinished"') == 1


def test_a_language_keeps_what_remains(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    kept, gone = ("StylusCAM", "Path"), ("StylusCAM", "gone")
    path = tmp_path / "StylusCAM_de.ts"
    path.write_text(qt_files.ts_text([kept, gone], {kept: "Weg", gone: "fort"}, GERMAN), encoding="utf-8")
    monkeypatch.setattr(translations, "TRANSLATIONS", tmp_path)
    monkeypatch.setattr(translations, "TEMPLATE", tmp_path / "StylusCAM.ts")
    written = [file.name for file in translations.write()]
    assert written == ["StylusCAM.ts", "StylusCAM_de.ts", "StylusCAM_de.qm"]
    found = qt_files.read_ts(path)
    assert found[kept] == "Weg" and gone not in found and len(found) > 100
    assert "Weg".encode("utf-16-be") in path.with_suffix(".qm").read_bytes()
