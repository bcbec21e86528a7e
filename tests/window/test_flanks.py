"""A twisted blade milled with the side of the tool in the window: faces, edges, axes, error map, text, and what is refused."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from window_host import WindowSession

pytestmark = [pytest.mark.world, pytest.mark.freecad]

OWN = {"Rails", "Side", "MaxError", "StockToLeave", "Overreach", "PassDepth", "Extension", "LeadLength"}
"""Fields of this kind alone, but for the advanced ones."""

HEIGHT, EDGE = 30.0, 45.0
"""Of the blade, and of the tool's cutting edge, mm."""


@pytest.fixture(scope="module")
def session(scenarios: Callable[..., WindowSession]) -> WindowSession:
    return scenarios("flanks", timeout=600.0)


@pytest.fixture(scope="module")
def of_a_face(session: WindowSession) -> dict[str, Any]:
    found: dict[str, Any] = session["of a face"]
    return found


def test_the_panel_has_the_fields_of_the_kind(of_a_face: dict[str, Any]) -> None:
    assert of_a_face["base"] == [["Face1"]]
    rows = of_a_face["rows"]
    assert rows.keys() >= OWN and not {"Step", "Boundary", "Links", "Engagement"} & rows.keys()
    assert all(title and tip for title, tip in rows.values())


def test_the_path_states_the_axis(of_a_face: dict[str, Any]) -> None:
    leaning, moves = of_a_face["words"]
    assert of_a_face["state"] == ["Up-to-date"] and leaning == moves > 20


def test_the_axes_stand_along_the_path(of_a_face: dict[str, Any]) -> None:
    axes = of_a_face["axes"]
    assert axes["count"] == 2 * of_a_face["words"][1]
    assert axes["high"][2] > 0.95 * EDGE and axes["low"][2] < 5.0
    title, positions, lean = axes["legend"]
    assert (
        "tool axes" in title
        and f"{of_a_face['words'][1]} positions, 45 mm" in positions
        and lean.startswith("leans by")
    )


def test_the_map_covers_the_face(of_a_face: dict[str, Any]) -> None:
    shown = of_a_face["map"]
    assert shown["count"] == shown["colours"] > 1000 and shown["different"] > 50
    assert shown["low"][2] == pytest.approx(0.0, abs=1e-4) and shown["high"][2] == pytest.approx(HEIGHT, abs=1e-4)
    title, low, middle, high, colours, figures = shown["legend"]
    assert "µm" in title and (low[0], middle, high[0]) == ("-", "0", "+")
    assert "allowed: 20" in colours
    words = figures.replace(",", "").split()
    assert words[0] == "Face1:" and 0.0 <= float(words[3]) <= 20.0 and 0.0 < float(words[6]) <= 20.0


def test_pictures_stay_after_ok_until_their_commands_take_them_away(of_a_face: dict[str, Any]) -> None:
    assert of_a_face["kept"] == [True, True]


def test_the_text_turns_the_rotary_axes(of_a_face: dict[str, Any]) -> None:
    text = of_a_face["post"]["text"]
    assert "judged from this text" in text
    turns = {line.split(" A")[1].split()[0] for line in text.splitlines() if " A" in line and not line.startswith("(")}
    assert len(turns) > 10


def test_two_edges_are_the_rails_and_the_side_is_asked_for(session: WindowSession) -> None:
    seen = session["of two edges"]
    assert seen["shown"] == ", ".join(seen["names"]) and seen["rails"] == f'{{"edges": {list(seen["names"])}}}'.replace(
        "'", '"'
    )
    assert seen["base"] == []
    assert seen["without"] == ["Touched", "Invalid"] or "Invalid" in seen["without"]
    assert "side" in seen["asked"]
    assert seen["state"] == ["Up-to-date"] and "1 pass" in " ".join(seen["notes"])


def test_the_button_wants_two_edges(session: WindowSession) -> None:
    seen = session["of two edges"]
    assert "selected now: 1" in seen["one edge"]
    assert seen["two edges"] == [seen["shown"], seen["rails"]]


def test_three_axes_are_refused_in_the_panel(session: WindowSession) -> None:
    notes = session["on three axes"]["notes"]
    assert "styluscam_linuxcnc" in notes and "no rotary axes" in notes and "choose" in notes


def test_no_scenario_leaves_a_traceback(session: WindowSession, of_a_face: dict[str, Any]) -> None:
    assert "Traceback" not in session.errors
