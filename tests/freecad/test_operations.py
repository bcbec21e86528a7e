"""The operation's properties mean what FreeCAD's own mean."""

from __future__ import annotations

import re
from typing import Any

import pytest

pytestmark = [pytest.mark.world, pytest.mark.freecad]


def test_depths_are_heights_of_the_tip(session: Any) -> None:
    """The model is 25 deep from Z 0, the sheet 1 thick on it; the first level is a step (5) below the start."""
    seen = session["depths"]
    assert seen["automatic"] == pytest.approx([1.0, -24.0], abs=1e-6)
    assert seen["highest"] == pytest.approx(-10.0)
    assert seen["lowest"] == pytest.approx(-15.0)


def test_the_first_of_two_tools_is_taken(session: Any) -> None:
    assert session["first of two tools"]["tool"] == "TC: Stylus"


def test_a_shape_is_tessellated_once(session: Any) -> None:
    assert session["once"]["calls"] == 1


def test_a_saved_document_keeps_its_path(session: Any) -> None:
    seen = session["saved"]
    assert_same_path(seen["before"], seen["after"])
    assert "Invalid" not in seen["state"]
    assert seen["bit"][0] == '{"kind": "clothoid", "diameter": 10.0}'
    assert seen["bit"][1] > 1000.0


def test_its_path_is_the_same_when_it_is_opened_and_computed_again(session: Any) -> None:
    computed, opened, again = session["saved"]["texts"]
    assert computed == opened == again
    assert computed.splitlines()[0] == "(cup [1] of München)"


def test_its_path_is_written_as_freecad_writes_numbers(session: Any) -> None:
    """FreeCAD keeps the sign of what it rounds to zero until a document is opened again; here there is none."""
    seen = session["saved"]
    _, _, *moves, _ = seen["texts"][0].splitlines()  # without the comment, the rapid up, and FreeCAD's last retract
    assert moves == re.sub(r"-(0\.0+\b)", r"\1", seen["as_commands"]).splitlines()


def test_a_restored_operation_computes(session: Any) -> None:
    seen = session["saved"]
    assert seen["recomputed"] == ["Up-to-date"]
    assert 100 < seen["commands"] < len(seen["before"])


def test_without_the_engine_a_document_keeps_its_path(session: Any, bare_session: Any) -> None:
    seen = bare_session["opened"]
    assert_same_path(session["saved"]["before"], seen["commands"])
    assert "Invalid" not in seen["state"]
    assert seen["volume"] > 1000.0
    opening = (bare_session.done.stdout + bare_session.done.stderr).partition("OPENED")[0]
    assert "Traceback" not in opening


def test_without_the_engine_computing_reports_what_to_do(bare_session: Any) -> None:
    seen = bare_session["computed"]
    assert "Invalid" in seen["state"]
    assert len(seen["names"]) == 1
    assert "pip install --target" in seen["names"][0]


def test_without_the_engine_nothing_is_created(bare_session: Any) -> None:
    seen = bare_session["created"]
    assert "pip install --target" in seen["message"]
    assert seen["objects"][0] == seen["objects"][1]


def assert_same_path(before: list[Any], after: list[Any]) -> None:
    assert len(before) == len(after) > 100
    for (name, words), (name_again, words_again) in zip(before, after, strict=True):
        assert name == name_again
        assert words == pytest.approx(words_again, abs=1e-6)
