"""Operations in FreeCAD's window: made, changed, taken back and computed by what a person does there."""

from __future__ import annotations

from typing import Any

import pytest

import styluscam as sc

pytestmark = [pytest.mark.world, pytest.mark.freecad]

ENDED = 0.5
"""Seconds after which a cancelled computation must have ended on a machine that is busy with other tests."""


@pytest.fixture
def session(scenarios: Any) -> Any:
    return scenarios("operations")


def test_faces_button_number_ok(session: Any) -> None:
    made = session["made with the button"]
    assert made["selected"] == [["Clone", ["Face3"]]] or made["selected"] == [["Model", ["Face3"]]]
    assert made["base"] == [["Face3"]] and not made["whole"]
    assert made["state"] == ["Up-to-date"] and made["motions"] > 1000
    assert made["visible"] and made["view"] == "ViewProviderStylus" and not made["edit"]
    assert made["label"] == "Z level"
    assert made["values"] == [5.0, 0.005, 0.001]  # nothing but what was typed, whatever places FreeCAD shows


def test_every_kind_of_the_engine_works_on_the_first_click(session: Any) -> None:
    kinds = sc.job_schema()["$defs"]["OperationSection"]["oneOf"]
    made = session["every kind"]
    unlike = {"chamfer", "contour", "drill", "flank", "helix-bore", "meridian", "pencil", "pocket"}
    named = {kind["properties"]["kind"]["const"] for kind in kinds} - unlike
    assert len(made) == len(named)
    assert {seen["strategy"] for seen in made.values()} == named
    for name, seen in made.items():
        assert seen["state"] == ["Up-to-date"] and seen["motions"] > 1000, name


def test_cancel_leaves_nothing_of_a_new_operation(session: Any) -> None:
    seen = session["cancelled new"]
    assert seen["after"] == seen["before"]
    assert "Traceback" not in seen["report"] and "deleted object" not in seen["report"]


def test_cancel_restores_every_value(session: Any) -> None:
    seen = session["cancelled edit"]
    assert seen["changed"] == ["Direction", "SheetThickness", "Step", "Tolerance"]
    assert seen["restored"] == []
    assert seen["same path"] and seen["state"] == ["Up-to-date"] and seen["operations"] == 1


def test_undo_and_redo(session: Any) -> None:
    seen = session["undone"]
    assert len(seen["made"]) == len(seen["before"]) + 1
    assert seen["undone"] == seen["before"]
    assert seen["redone"] == seen["made"]
    assert seen["motions"][0] == seen["motions"][1] > 1000


def test_the_panel_keeps_expressions(session: Any) -> None:
    seen = session["expression"]
    assert (seen["shown"], seen["step"]) == (4.0, 6.0)
    assert ["Step", "SheetThickness * 4"] in seen["kept"]
    assert seen["state"] == ["Up-to-date"]


def test_a_copy_has_the_same_path_and_a_disabled_operation_none(session: Any) -> None:
    seen = session["copied and disabled"]
    assert seen["same"] and seen["view"] == "ViewProviderStylus"
    assert seen["disabled"] == 0
    text = seen["post"]["text"]
    assert text.count("(operation ") == 1 and "judged from this text" in text


def test_a_dressup_is_posted_and_begins_where_the_path_does(session: Any) -> None:
    seen = session["dressed up"]
    assert seen["state"] == ["Up-to-date"] and seen["motions"] > 1000
    assert "not judged" in seen["post"]["text"]
    assert seen["first feed"] == "G1 F16.666667 Z1.000000"  # straight down, where the first level begins


def test_the_path_follows_the_model(session: Any) -> None:
    seen = session["changed model"]
    assert seen["deep"] == pytest.approx(4.0, abs=0.005) and seen["shallow"] == pytest.approx(7.0, abs=0.005)
    assert "judged from this text" in seen["post"]["text"]


def test_a_long_computation_shows_its_phase_and_is_cancelled(session: Any) -> None:
    seen = session["progress"]
    assert seen["text"].startswith("Levels: ")
    assert seen["longest gap"] < ENDED and seen["ended after"] < ENDED
    cancelled = seen["cancelled"]
    assert cancelled["motions"] == 0 and "Invalid" in cancelled["state"]
    assert cancelled["first"] == "(cancelled)" and cancelled["notes"] == []
    assert seen["again"]["state"] == ["Up-to-date"] and seen["again"]["motions"] > 1000


def test_a_mistake_is_a_sentence_in_panel_and_report_view(session: Any) -> None:
    seen = session["failed"]
    assert "Invalid" in seen["state"] and seen["motions"] == 0
    assert "step is missing" in seen["notes"]
    assert "step is missing" in seen["report"]
    assert seen["row"]


def test_no_traceback(session: Any) -> None:
    assert "Traceback" not in session.errors
