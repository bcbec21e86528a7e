"""Moves of a program: their pose, feed and role, in documents, arrays, posts and pages."""

from __future__ import annotations

import json
import re
from typing import Any

import numpy as np
import pytest

import styluscam as sc
from styluscam.programs.program import ROLES
from styluscam.report.page import report_page
from styluscam.report.subject import Subject

SETUP = {
    "title": "tilted",
    "wcs": "G54",
    "zero": "",
    "part_min": [0.0, 0.0, 0.0],
    "part_max": [9.0, 9.0, 0.0],
    "clearance": 10.0,
    "notes": [],
}
TOOL = {
    "name": "ball",
    "number": 1,
    "length_offset": 1,
    "description": "ball D6",
    "reference": "tip",
    "reference_height": 0.0,
    "diameter": 6.0,
}
TILTED = [0.6, 0.0, 0.8]


def document(last: dict[str, Any], **more: Any) -> str:
    """A program of a rapid, a plunge and a cut; `last` is added to the cut."""
    moves = [
        {"kind": "rapid", "end": [0.0, 0.0, 10.0], "feed": 0.0, "operation": 0},
        {"kind": "feed", "end": [0.0, 0.0, -1.0], "feed": 100.0, "operation": 0},
        {"kind": "feed", "end": [9.0, 0.0, -1.0], "feed": 500.0, "operation": 0} | last,
    ]
    whole = {
        "schema": 1,
        "setup": SETUP,
        "tools": [TOOL],
        "operations": [{"id": "a", "kind": "flank", "tool": 0}],
        "moves": moves,
        "events": [{"before": 0, "kind": "tool-change", "tool": 0}],
    }
    return json.dumps(whole | more)


def upright() -> dict[str, Any]:
    """A program document in the engine's own form."""
    text = sc.Program.from_json(document({})).engine.to_json()
    return dict(json.loads(text))


def test_moves_have_an_axis_a_feed_mode_a_role_and_a_tool() -> None:
    more = {"axis": TILTED, "feed_mode": "per-revolution", "role": "ramp"}
    moves = sc.Program.from_json(document(more)).moves
    assert moves["axis"].tolist() == [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], TILTED]
    assert moves["feed_mode"].tolist() == [94, 94, 95]
    assert [ROLES[role] for role in moves["role"]] == [None, None, "ramp"]
    assert moves["tool"].tolist() == [0, 0, 0]


def test_what_is_usual_is_not_written() -> None:
    for move in upright()["moves"]:
        assert sorted(move) == ["end", "feed", "kind", "operation"]


def test_axes_beside_the_moves_are_read_into_them() -> None:
    old = sc.Program.from_json(document({}, axes=[[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], TILTED]))
    assert old == sc.Program.from_json(document({"axis": TILTED}))
    with pytest.raises(sc.JobError, match="1 axes for 3 moves"):
        sc.Program.from_json(document({}, axes=[TILTED]))


def test_a_machine_of_three_axes_refuses_a_tilted_tool() -> None:
    program = sc.Program.from_json(document({"axis": TILTED}))
    with pytest.raises(sc.StylusError, match="leans in move 2") as caught:
        sc.post(program, "linuxcnc")
    assert (caught.value.code, caught.value.where) == ("post-tool-axis", "moves[2]")


def test_a_page_has_the_axes_of_a_tilted_tool() -> None:
    def axes(more: dict[str, object]) -> object:
        subject = Subject("tilted", "tilted.ngc", sc.Program.from_json(document(more)), sc.Machine.of("linuxcnc"))
        found = re.search(r'"axes":(null|\{.*?\})', report_page(subject))
        assert found is not None
        return json.loads(found[1])

    assert axes({}) is None
    tilted = axes({"axis": TILTED})
    assert isinstance(tilted, dict)
    assert (tilted["count"], tilted["columns"]) == (3, 3)


def test_a_feed_per_revolution_takes_its_time() -> None:
    turning = [{"before": 0, "kind": "spindle-on", "rpm": 1000.0, "direction": "clockwise"}]
    more = {"feed": 0.5, "feed_mode": "per-revolution"}
    times = sc.Program.from_json(document(more, events=turning)).times("linuxcnc")
    same = sc.Program.from_json(document({"feed": 500.0}, events=turning)).times("linuxcnc")
    assert np.array_equal(times, same)
