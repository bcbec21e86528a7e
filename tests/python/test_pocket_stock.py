"""Stock that a pocket leaves on the part, and the passes that take it: what the verifier finds where that is not so."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from test_pocket_operation import FLOOR, SIZE, TOP, WALL, job, text_of

import styluscam as sc

LEFT = {"radial_stock_to_leave": 0.3, "axial_stock_to_leave": 0.2}
SMALL: dict[str, Any] = {"z_bottom": 4.0}
"""One level, for what does not need the floor."""


@pytest.fixture(scope="module")
def texts() -> dict[str, str]:
    """Texts by what is left, and whether it is taken."""
    asked = {"none": {}, "left": LEFT, "taken": LEFT | {"finish": True}}
    return {name: text_of(job(**keys)) for name, keys in asked.items()}


def kinds(text: str, asked: sc.Job) -> set[str]:
    found = sc.verify(text, asked).to_dict()["findings"]
    return {finding["kind"] for finding in found if finding["severity"] == "error"}


def cutting(text: str) -> np.ndarray[Any, np.dtype[np.float64]]:
    ends = sc.read_gcode(text, "linuxcnc").moves["end"]
    return ends[ends[:, 2] < TOP - 1e-6]


def test_stock_stays_on_walls_and_floor_by_as_much_as_is_asked(texts: dict[str, str]) -> None:
    assert kinds(texts["left"], job(**LEFT)) == set()
    ends = cutting(texts["left"])
    assert 0.0 < ends[:, 2].min() - FLOOR - 0.2 < 0.02
    for axis in (0, 1):
        wall = WALL + 2.0 + 0.3
        assert 0.0 < ends[:, axis].min() - wall < 0.01 and 0.0 < SIZE[axis] - wall - ends[:, axis].max() < 0.01


def test_a_finish_takes_it_within_the_same_bound(texts: dict[str, str]) -> None:
    assert kinds(texts["taken"], job(**LEFT, finish=True)) == set()
    ends = cutting(texts["taken"])
    heights, counts = np.unique(np.round(ends[:, 2], 3), return_counts=True)
    # one layer more, over the floor
    assert np.allclose(heights[counts > 20] - FLOOR, [0.0, 0.2, 2.0], atol=0.005)
    for axis in (0, 1):
        assert 0.0 < ends[:, axis].min() - WALL - 2.0 < 0.01


def test_the_last_pass_goes_once_around_the_walls_on_each_level(texts: dict[str, str]) -> None:
    moves = sc.read_gcode(texts["taken"], "linuxcnc").moves
    # on level 4, the sides of the pocket where the tool touches them
    ends = moves["end"][np.abs(moves["end"][:, 2] - 4.0) < 1e-6]
    at_wall = np.flatnonzero(ends[:, 0] < WALL + 2.01)
    assert at_wall.size and at_wall.min() > 0.5 * len(ends)


@pytest.mark.parametrize(
    ("text", "asked", "found"),
    [
        ("none", {"radial_stock_to_leave": 0.3}, {"stock-to-leave"}),
        ("none", {"axial_stock_to_leave": 0.2}, {"stock-to-leave", "missing-level"}),
        ("left", {"radial_stock_to_leave": 0.1, "axial_stock_to_leave": 0.2}, {"uncleared"}),
        ("left", {"radial_stock_to_leave": 0.35, "axial_stock_to_leave": 0.2}, {"stock-to-leave"}),
        ("left", {"radial_stock_to_leave": 0.3}, {"missing-level"}),
        ("left", LEFT | {"finish": True}, {"uncleared", "missing-level"}),
        ("taken", LEFT, {"stock-to-leave"}),
        ("taken", {"radial_stock_to_leave": 0.3, "axial_stock_to_leave": 0.1, "finish": True}, {"missing-level"}),
    ],
)
def test_what_is_left_too_thick_or_too_thin_is_found(
    texts: dict[str, str], text: str, asked: dict[str, Any], found: set[str]
) -> None:
    assert found <= kinds(texts[text], job(**asked))


def test_a_finish_without_stock_is_refused() -> None:
    with pytest.raises(sc.JobError) as refused:
        job(finish=True)
    assert refused.value.where == "operations[0].finish" and "radial_stock_to_leave" in str(refused.value.hint)


def test_chords_on_another_controller_are_finished_as_soundly() -> None:
    asked = job("grbl", **SMALL, radial_stock_to_leave=0.2, finish=True, fit="lines", direction="conventional")
    assert kinds(text_of(asked), asked) <= {"missing-level"}
