"""Whole CAM jobs through FreeCAD's post mechanism."""

from __future__ import annotations

from typing import Any

import pytest

pytestmark = [pytest.mark.world, pytest.mark.freecad]


def test_posts_are_listed_and_cost_no_start(bare_session: Any) -> None:
    seen = bare_session["started"]
    assert not seen["early"], "starting FreeCAD must not import CAM"
    assert {"styluscam_linuxcnc", "styluscam_grbl"} <= set(seen["posts"])


def test_two_tools_are_changed_in_order(session: Any, linuxcnc: Any) -> None:
    text = session["two tools"]["post"]["text"]
    assert [line for line in text.splitlines() if "M6" in line] == ["T1 M6", "T2 M6"]
    assert "judged from this text" in text
    linuxcnc(text)


def test_operations_of_two_sheets_are_no_program(session: Any) -> None:
    assert "differ in SheetThickness" in session["two tools"]["differ"]["refused"]


def test_a_straight_native_operation_is_posted_and_said_not_to_be_judged(session: Any, linuxcnc: Any) -> None:
    text = session["native straight"]["post"]["text"]
    assert "not judged" in text
    assert "X1 Y2" in text
    linuxcnc(text)


@pytest.mark.parametrize(
    ("name", "lines"),
    [
        ("native arc", ["G2 X1 Y1 I1 J0 F600"]),
        ("native cycle", ["G98 G81 X0 Y0 Z-1 R2 F300", "X5 Y0", "G80", "M10"]),
        ("native probe", ["G38.2 Z-5 F120"]),
    ],
)
def test_native_commands_are_posted_as_they_are(session: Any, name: str, lines: list[str]) -> None:
    text = session[name]["post"]["text"].splitlines()
    assert "not judged" in "\n".join(text)
    assert [line for line in text if line in lines] == lines


def test_a_fourth_axis_is_refused_and_its_operation_named(session: Any) -> None:
    refused = session["native axis"]["post"]["refused"]
    assert refused.startswith("Own lines: line") and "three axes" in refused


def test_work_offsets_go_to_files_of_their_own(session: Any, linuxcnc: Any) -> None:
    seen = session["two fixtures"]
    assert "the work offset changes between moves" in seen["together"]["refused"]
    assert sorted(seen["apart"]) == ["G54", "G55"]
    for offset, text in seen["apart"].items():
        assert offset in text.splitlines()
        assert "T1 M6" in text.splitlines()
        linuxcnc(text)
