"""A milled part's pockets in the window: faces, panel, engagement map, verification, posted text, and what is refused."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from window_host import WindowSession

DEAD = {"CheckFaces", "CheckClearance", "Boundary", "Edges", "MaxCorner", "Links", "LinkMargin", "Lead", "LeadRadius"}
DEAD |= {"LeadAngle", "StepScallop"}
"""Fields that mean nothing to a pocket."""

BOUND = 70.0


@pytest.fixture(scope="module")
def session(scenarios: Callable[..., WindowSession]) -> WindowSession:
    return scenarios("pockets", timeout=900.0)  # two levels are planned, measured three times and verified


@pytest.fixture(scope="module")
def designed(session: WindowSession) -> dict[str, Any]:
    found: dict[str, Any] = session["designed"]
    return found


def test_the_panel_has_the_fields_of_a_pocket_and_no_dead_ones(designed: dict[str, Any]) -> None:
    rows = designed["rows"]
    assert {"Engagement", "Growth", "Step", "EntryAngle", "EntryHole", "Finish", "SmoothingRadius"} <= rows.keys()
    assert not DEAD & rows.keys()
    assert not [name for name in rows if name.startswith("Sheet")]
    assert all(title and tip for title, tip in rows.values())
    assert designed["risks"] == ["bridged", "unreached"]
    assert designed["step"] == 2.0
    assert [len(names) for names in designed["base"]] == [2]


def test_the_preview_colours_the_path_from_0_to_the_bound(designed: dict[str, Any]) -> None:
    for name in ("preview", "map"):
        seen = designed[name]
        points, colours = seen["count"]
        assert points == colours > 1000
        assert len(seen["different"]) > 100
        assert seen["low"][2] == pytest.approx(3.0, abs=0.02)
        assert seen["low"][0] < 8.5 + 4.0 and seen["high"][0] > 44.0  # over the open side
        title, *marks, free, entry, largest = seen["legend"]
        assert "deg" in title and marks == ["0", "35", "70"]
        assert free == "engages nothing" and entry == "entry: not bounded"
        angle = float(largest.split()[1])
        assert BOUND - 8.0 < angle <= BOUND + 0.5
        assert seen["path legend"] is None  # the path itself is not drawn meanwhile


def test_the_map_is_taken_away_and_the_path_is_back(designed: dict[str, Any]) -> None:
    engagement, path = designed["off"]
    assert engagement is None and path[0] == "Path"


def test_the_text_is_what_was_verified(designed: dict[str, Any]) -> None:
    assert designed["path"]["motions"] > 500
    text = designed["post"]["text"]
    assert "judged from this text" in text
    assert "(role ramp)" in text and "(role cut)" in text
    assert designed["findings"][0] == "Nothing was found"


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("no_face", ["no face is selected", "select"]),
        ("large_tool", ["tool", "Start Depth", "Final Depth"]),
        ("no_room_for_the_hole", ["hole", "remove Entry hole"]),
    ],
)
def test_a_refusal_states_why_and_what_to_do(session: WindowSession, name: str, words: list[str]) -> None:
    notes = session["refusals"][name]["notes"]
    assert all(word in notes for word in words), notes


def test_the_command_wants_a_pocket(session: WindowSession) -> None:
    assert "select one" in session["not a pocket"]


def test_no_scenario_leaves_a_traceback(session: WindowSession, designed: dict[str, Any]) -> None:
    assert "Traceback" not in session.errors
