"""Stylus tools in FreeCAD's window: made, edited, checked while they are typed, saved."""

from __future__ import annotations

import math
from typing import Any

import pytest

import styluscam as sc
from styluscam.tools import starters

pytestmark = [pytest.mark.world, pytest.mark.freecad]

ODD = 7.12345678912
"""As in the scenarios: more digits than any box shows."""


@pytest.fixture(scope="module")
def session(scenarios: Any) -> Any:
    return scenarios("tool_bits")


def ball(diameter: float, length: float) -> float:
    """Volume (mm3) of a ball-ended bit whose shank has its diameter."""
    radius = diameter / 2.0
    return math.pi * radius**2 * (length - radius) + 2.0 / 3.0 * math.pi * radius**3


def test_the_button_adds_a_tool_to_the_job(session: Any) -> None:
    seen = session["made with the button"]
    assert seen["number"] == [2, 2, 1, 2]
    assert seen["commands"] == ["(TC: Stylus)", "M6"]  # no M3: the spindle stays off
    made = seen["made"]
    assert made["profile"] == {"kind": next(iter(starters.profiles())), "diameter": 7.25}
    assert made["lengths"] == pytest.approx([7.25, 3.625, 43.625, 7.25], abs=1e-12)
    assert made["volume"] == pytest.approx(ball(7.25, 43.625), rel=1e-8)
    assert made["view"] == "ViewProviderStylusBit" and seen["visible"] is False


def test_a_new_tool_is_one_step_to_undo(session: Any) -> None:
    seen = session["made with the button"]
    assert seen["undo names"][0] == "Create Stylus"
    assert seen["undone"] == [1, 0]
    assert seen["redone"] == seen["made"]


def test_every_kind_of_profile_begins_with_a_tool(session: Any) -> None:
    seen = session["every kind"]["seen"]
    kinds = {one["properties"]["kind"]["const"]: one for one in sc.job_schema()["$defs"]["ProfileDocument"]["oneOf"]}
    assert list(seen) == list(kinds)
    for kind, one in kinds.items():
        tool = sc.Tool.from_dict({"profile": starters.profiles()[kind]})
        assert seen[kind]["diameter"] == pytest.approx(tool.diameter), kind
        assert seen[kind]["height"] == pytest.approx(float(tool.height_at(tool.max_slope))), kind
        assert set(seen[kind]["rows"]) == set(one["properties"]) - {"kind"}, kind
        assert seen[kind]["help"] == one["description"] and seen[kind]["tip"], kind
        assert seen[kind]["errors"] == [] and seen[kind]["ok"], kind


def test_cancel_makes_nothing(session: Any) -> None:
    assert session["every kind"]["objects"] == [0, 0]


def test_errors_stand_where_they_belong(session: Any) -> None:
    seen = session["errors in place"]
    texts, ok, _ = seen["negative"]
    assert len(texts) == 1 and texts[0].startswith("diameter = -3: allowed is") and not ok
    assert seen["fits"] and seen["mended"] == []
    texts, ok, _ = seen["hollow"]
    assert len(texts) == 1 and "the profile is hollow here" in texts[0] and not ok
    assert seen["line"] == ["line 2: '1, nothing': 2 numbers are expected, separated by a comma"]
    assert len(seen["missing"][0]) == 1 and "diameter" in seen["missing"][1]
    assert seen["name"] == ["The tool has no name: give it one"]


def test_a_double_click_opens_the_panel_and_cancel_leaves_the_tool(session: Any) -> None:
    seen = session["edited by double click"]
    assert seen["first"]["profile"]["diameter"] == ODD
    assert seen["cancelled"] == seen["first"]


def test_ok_keeps_numbers_that_nobody_changed(session: Any) -> None:
    seen = session["edited by double click"]
    assert seen["document"]["profile"] == {"kind": "ball", "diameter": ODD}
    assert seen["document"]["base"] == {"kind": "tangent", "height": 4.5}
    assert seen["document"]["shank_diameter"] == 10.0
    assert seen["stored"]["label"] == "Yours"
    assert seen["stored"]["volume"] > seen["first"]["volume"]


def test_an_edit_is_one_step_to_undo_and_is_saved(session: Any) -> None:
    seen = session["edited by double click"]
    assert seen["undone"] == seen["first"]
    assert seen["reopened"] == seen["stored"]
    assert seen["same"]


def test_a_spin_box_is_never_one_that_is_gone(session: Any) -> None:
    seen = session["boxes at old addresses"]
    assert seen["FreeCAD's"] > 0
    assert seen["ours"] == 0


def test_nothing_is_thrown_at_freecad(session: Any) -> None:
    assert session["edited by double click"]
    assert "Traceback" not in session.errors
